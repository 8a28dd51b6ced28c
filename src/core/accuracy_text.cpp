#include <cmath>
#include <sstream>

#include "rigid_body_sim/accuracy.hpp"

namespace rigid_body_sim {
namespace {

constexpr std::size_t kMostNames = 4;

std::string namesOf(const std::vector<Eigen::Index>& bodies, const Scene& scene) {
  std::string names;
  for (std::size_t k = 0; k < bodies.size() && k < kMostNames; ++k)
    names += (k == 0 ? "" : ", ") + scene.bodies[bodies[k]].name;
  if (bodies.size() > kMostNames)
    names += " and " + std::to_string(bodies.size() - kMostNames) + " more";
  return names;
}

/// What is measured and what the reference is in doubt by go together.
std::string toText(const Offer& offer, const Deviation& doubt) {
  std::ostringstream text;
  text.precision(2);
  text << toText(offer.method) << " leaves at most "
       << offer.error.attitude_rad + doubt.attitude_rad << " rad, "
       << offer.error.position_m + doubt.position_m << " m, at ";
  text.precision(3);
  text << offer.cost << " semi_implicit steps a tick";
  return text.str();
}

/// Another offer beside the chosen one.
std::string comparison(const std::optional<Offer>& offer, const ClassBill& one,
                       const std::string& none) {
  if (!offer) return none;
  const Offer& chosen = one.chosen;
  std::ostringstream text;
  text.precision(3);
  if (offer->method == chosen.method)
    text << "the same";
  else
    text << toText(*offer, one.doubt) << ", " << offer->cost / chosen.cost << " times the price";
  return text.str();
}

}  // namespace

std::string summary(const ClassBill& one, const Scene& scene) {
  return toText(one.chosen.method) + ": " + namesOf(one.bodies, scene);
}

std::string toText(const LocalError& sample, const Scene& scene) {
  std::ostringstream text;
  text.precision(2);
  text << scene.bodies[sample.body].name << ": " << sample.error.attitude_rad << " rad and "
       << sample.error.position_m << " m in tick " << sample.tick << ", so "
       << sample.predicted.attitude_rad << " rad and " << sample.predicted.position_m
       << " m over the span";
  return text.str();
}

std::string toText(const SpentError& spent, const Scene& scene) {
  std::ostringstream text;
  text.precision(2);
  text << scene.bodies[spent.body].name << ": " << spent.error.attitude_rad << " rad and "
       << spent.error.position_m << " m off at tick " << spent.tick << ", by inputs since tick "
       << spent.since;
  return text.str();
}

std::string toText(const Bill& bill, const Scene& scene) {
  std::ostringstream text;
  text.precision(3);
  text << "accuracy: " << summary(bill.budget) << ", from tick " << bill.tick << "\n";
  for (const ClassBill& one : bill.classes) {
    text << "  " << namesOf(one.bodies, scene) << ": " << toText(one.chosen, one.doubt)
         << (one.keeps_budget ? "" : "; THIS BREAKS THE BUDGET, and there is nothing better")
         << "\n";
    if (one.bodies.size() > 1)
      text << "    (the figures are those of " << scene.bodies[one.hardest].name << "; "
           << one.flown << " of " << one.bodies.size() << " were flown)\n";
    text << "    runner-up: " << comparison(one.runner_up, one, "none found") << "\n"
         << "    one digit less: " << comparison(one.digit_less, one, "cannot be had")
         << "\n    one digit more: " << comparison(one.digit_more, one, "cannot be had")
         << "\n    reference: " << one.reference << ", in doubt by " << one.doubt.attitude_rad
         << " rad, " << one.doubt.position_m << " m\n";
  }
  const double flown_s = static_cast<double>(bill.ticks_flown) * scene.step_s();
  text << "  found by flying " << bill.body_steps << " steps";
  if (flown_s < bill.budget.over_s)
    text << " over the first " << flown_s
         << " s; errors over the rest are extrapolated as they grew, which chaos may belie";
  text << "\n";
  return text.str();
}

}  // namespace rigid_body_sim

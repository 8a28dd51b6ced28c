#include <cmath>
#include <sstream>

#include "core/accuracy_plan.hpp"
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

/// What the budget is of: `3e-05 rad, 2e-06 m`, or one of these.
std::string toText(const Deviation& deviation, const Budget& budget) {
  std::ostringstream text;
  text.precision(2);
  const bool has_attitude = std::isfinite(budget.attitude_rad);
  if (has_attitude) text << deviation.attitude_rad << " rad";
  if (std::isfinite(budget.position_m))
    text << (has_attitude ? ", " : "") << deviation.position_m << " m";
  return text.str();
}

/// What is measured and what the reference is in doubt by go together.
std::string leftBy(const Offer& offer, const Deviation& doubt, const Budget& budget) {
  return "leaves at most " + toText({offer.error.attitude_rad + doubt.attitude_rad,
                                     offer.error.position_m + doubt.position_m},
                                    budget);
}

std::string toText(const Offer& offer, const Deviation& doubt, const Budget& budget) {
  std::ostringstream text;
  text.precision(3);
  text << toText(offer.method) << " " << leftBy(offer, doubt, budget) << ", at " << offer.cost
       << " semi_implicit steps a tick";
  return text.str();
}

/// What else there is to know of the choice.
std::string remark(const ClassBill& one) {
  if (!one.keeps_budget) return "; THIS BREAKS THE BUDGET, and there is nothing better";
  if (!one.runner_up || one.runner_up->cost >= one.chosen.cost) return {};
  return "; dearer than the runner-up, but it leaves less for at most a quarter more";
}

/// Another offer beside the chosen one.
std::string comparison(const std::optional<Offer>& offer, const ClassBill& one,
                       const Budget& budget, const std::string& none) {
  if (!offer) return none;
  const Offer& chosen = one.chosen;
  std::ostringstream text;
  text.precision(3);
  if (offer->method == chosen.method)
    text << "the same";
  else
    text << toText(*offer, one.doubt, budget) << ", " << offer->cost / chosen.cost
         << " times the price";
  return text.str();
}

/// What the errors were extrapolated from; empty if the whole span was flown.
std::string onlyFrom(const Bill& bill, const Scene& scene) {
  const double flown_s = static_cast<double>(bill.ticks_flown) * scene.step_s();
  if (flown_s >= bill.budget.over_s) return {};
  std::ostringstream text;
  text.precision(3);
  text << ", extrapolated from the first " << flown_s
       << " s, as many bodies or steps leave time for no more";
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

std::string refusal(const Bill& bill, const ClassBill& one, const Scene& scene) {
  // What exact leaves is the rounding of its start: steps have no part in it.
  const bool helps_step = one.chosen.method.integrator != "exact";
  return "accuracy: " + summary(bill.budget) + " cannot be kept for body '" +
         scene.bodies[one.hardest].name + "'; the best there is, " + toText(one.chosen.method) +
         ", " + leftBy(one.chosen, one.doubt, bill.budget) + onlyFrom(bill, scene) +
         (helps_step ? "; ask for less, for a shorter span, or take a smaller step_s"
                     : "; ask for less, or for a shorter span");
}

std::string refusal(const Budget& budget, const Unplannable& why, const Scene& scene) {
  return "accuracy: " + summary(budget) + " cannot be planned for body '" +
         scene.bodies[static_cast<std::size_t>(why.body())].name + "': " + why.what() +
         "; take a smaller step_s, or name an integrator instead of `accuracy`";
}

std::string toText(const Bill& bill, const Scene& scene) {
  std::ostringstream text;
  text.precision(3);
  text << "accuracy: " << summary(bill.budget) << ", from tick " << bill.tick << "\n";
  for (const ClassBill& one : bill.classes) {
    text << "  " << namesOf(one.bodies, scene) << ": " << toText(one.chosen, one.doubt, bill.budget)
         << remark(one) << "\n";
    if (one.bodies.size() > 1)
      text << "    (the figures are those of " << scene.bodies[one.hardest].name << "; "
           << one.flown << " of " << one.bodies.size() << " were flown)\n";
    text << "    runner-up: " << comparison(one.runner_up, one, bill.budget, "none found") << "\n"
         << "    one digit less: " << comparison(one.digit_less, one, bill.budget, "cannot be had")
         << "\n    one digit more: "
         << comparison(one.digit_more, one, bill.budget, "cannot be had")
         << "\n    reference: " << one.reference << ", in doubt by "
         << toText(one.doubt, bill.budget) << "\n";
  }
  const double flown_s = static_cast<double>(bill.ticks_flown) * scene.step_s();
  text << "  found by flying " << bill.body_steps << " steps, compared at "
       << (bill.every == 1 ? "every tick" : "one in " + std::to_string(bill.every) + " ticks");
  if (flown_s < bill.budget.over_s)
    text << " over the first " << flown_s
         << " s; errors over the rest are extrapolated as they grew, which chaos may belie";
  text << "\n";
  return text.str();
}

}  // namespace rigid_body_sim

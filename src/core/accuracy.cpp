#include "rigid_body_sim/accuracy.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <set>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "core/accuracy_plan.hpp"
#include "core/suitability.hpp"
#include "core/trials.hpp"
#include "rigid_body_sim/simulator.hpp"

namespace rigid_body_sim {
namespace {

constexpr std::size_t kMostFlown = 256;
constexpr double kMostTicks = 600'000;
constexpr double kMostSteps = 6e7;
constexpr double kMostStepsPerTick = 1000;
constexpr double kStiffSteps = 4e6;  // of all bodies: some seconds
constexpr double kMostSamples = 10'000;
constexpr Tick kFewestTicks = 50;  // of a flight that is shorter than the span

Budget scaled(Budget budget, double factor) {
  budget.attitude_rad *= factor;
  budget.position_m *= factor;
  return budget;
}

/// @param ticks of the budget
void setFlown(Allowance& allowance, double flown, double ticks) {
  allowance.every = static_cast<Tick>(std::ceil(flown / kMostSamples));
  allowance.ticks = static_cast<Tick>(std::ceil(flown / allowance.every)) * allowance.every;
  allowance.span = std::max(1.0, ticks / static_cast<double>(allowance.ticks));
}

Allowance allowanceOf(const Budget& budget, double tick_s, std::size_t parts, Eigen::Index bodies) {
  const double ticks = std::max(1.0, std::ceil(budget.over_s / tick_s));
  const double all = static_cast<double>(parts) * static_cast<double>(bodies);
  const double flown = std::min(ticks, std::max(1.0, std::floor(kMostTicks / all)));
  Allowance allowance;
  allowance.steps = std::min(kMostSteps / static_cast<double>(parts),
                             kMostStepsPerTick * flown * static_cast<double>(bodies));
  allowance.stiff_steps = std::max(kStiffSteps / static_cast<double>(parts), allowance.steps / 2);
  setFlown(allowance, flown, ticks);
  return allowance;
}

/// A quarter of the flight, with as many steps.
Allowance shorter(Allowance allowance) {
  const double flown = static_cast<double>(allowance.ticks);
  setFlown(allowance, std::max<double>(kFewestTicks, std::ceil(flown / 4)), flown * allowance.span);
  return allowance;
}

/// What decides a body's price, coarsely: bodies of one kind are taken for alike.
struct Kind {
  std::vector<std::string> effects;
  std::vector<int> scales;  // of rate, shape and what the effects do at the start; powers of two

  bool operator<(const Kind& other) const {
    return std::tie(effects, scales) < std::tie(other.effects, other.scales);
  }
};

/// What a body has in common with those of its kind.
struct Features {
  std::vector<std::string> effects;
  std::vector<double> sizes;
};

Features featuresOf(const Part& part) {
  Features features;
  ActiveEffects active;
  for (const auto& effect : part.effects) {
    features.effects.push_back(effect->name());
    active.add(effect.get());
  }
  const Vector3d I = part.bodies.moments(0);
  const bool is_symmetric = (I(1) - I(0)) / I(0) < 0x1p-20;
  features.sizes = {fastestOf(part.bodies).rate, I(2) / I(0), is_symmetric ? 0.0 : 1.0};
  if (active.empty()) return features;
  const Wrenches& wrenches =
      active.evaluate(part.bodies, static_cast<double>(part.tick) * part.tick_s);
  features.sizes.push_back(wrenches.t_Bcm_W.row(0).norm());
  features.sizes.push_back(wrenches.f_W.row(0).norm() / part.bodies.mass(0));
  return features;
}

/// @param octaves that sizes of one kind may differ by
Kind kindOf(const Features& features, int octaves) {
  Kind kind = {features.effects, {}};
  for (const double size : features.sizes)
    kind.scales.push_back(size > 0 && std::isfinite(size)
                              ? static_cast<int>(std::floor(std::ilogb(size) / double(octaves)))
                              : std::numeric_limits<int>::min());
  return kind;
}

std::vector<Part> partsOf(const Situation& now) {
  std::vector<Part> parts;
  for (Eigen::Index i = 0; i < now.bodies.count(); ++i) {
    auto part = partOf(now, {i});
    if (!part) return {wholeOf(now)};
    parts.push_back(std::move(*part));
  }
  return parts;
}

/// The octaves that bodies of one kind may differ by, so that there are no more kinds than bodies
/// to fly.
int octavesOfKinds(const std::vector<Features>& bodies) {
  constexpr int kAll = 4096;  // more than a double has
  for (int octaves = 1; octaves < kAll; octaves *= 2) {
    std::set<Kind> kinds;
    for (const Features& body : bodies) kinds.insert(kindOf(body, octaves));
    if (kinds.size() <= kMostFlown) return octaves;
  }
  return kAll;
}

/// Those to fly of parts that are too many, by kind: the fastest ones first.
std::map<Kind, std::vector<Part>> byKind(std::vector<Part> parts) {
  std::vector<Features> features;
  for (const Part& part : parts) features.push_back(featuresOf(part));
  const int octaves = octavesOfKinds(features);
  std::map<Kind, std::vector<Part>> kinds;
  for (std::size_t i = 0; i < parts.size(); ++i)
    kinds[kindOf(features[i], octaves)].push_back(std::move(parts[i]));
  for (auto& [kind, alike] : kinds)
    std::stable_sort(alike.begin(), alike.end(), [](const Part& a, const Part& b) {
      return fastestOf(a.bodies).rate > fastestOf(b.bodies).rate;
    });
  return kinds;
}

/// A bill in the making.
class Choice {
 public:
  Choice(Bill& bill, const Allowance& allowance) : bill_(bill), allowance_(allowance) {
    bill_.ticks_flown = allowance.ticks;
    bill_.every = allowance.every;
  }

  /// Chooses for a part. @returns the class it went to
  /// @throws Unplannable of a body of the scene; TooLong
  std::size_t add(const Part& part) {
    auto trials = trialsOf(part);
    const std::optional<Offer> kept = trials->choose(bill_.budget);
    const Offer offer = kept ? *kept : bestOf(*trials);
    const double share = shareOf(bill_.budget, offer.error, trials->doubt());
    const std::size_t place = placeOf(offer.method, part.effects.empty());
    ClassBill& one = bill_.classes[place];
    const Forecast forecast = trials->forecast(offer);
    for (const Eigen::Index body : part.indices) {
      one.bodies.push_back(body);
      bill_.forecasts[body] = forecast;
    }
    one.flown += part.indices.size();
    bill_.body_steps += trials->bodySteps();
    if (share < shares_[place]) return place;
    shares_[place] = share;
    one.hardest = part.indices.front();
    one.keeps_budget = kept.has_value();
    one.chosen = offer;
    one.doubt = trials->doubt();
    one.reference = trials->reference();
    hardest_[place] = std::move(trials);
    return place;
  }

  /// A body that is like those of a class.
  void addUnflown(Eigen::Index body, std::size_t place) {
    ClassBill& one = bill_.classes[place];
    one.bodies.push_back(body);
    bill_.forecasts[body] = bill_.forecasts[one.hardest];
  }

  double costOf(std::size_t place) const { return bill_.classes[place].chosen.cost; }

  /// Looks for what else there was, for the hardest body of each class.
  void finish() {
    for (std::size_t i = 0; i < hardest_.size(); ++i) {
      if (!hardest_[i]) continue;  // of an earlier bill
      ClassBill& one = bill_.classes[i];
      Trials& trials = *hardest_[i];
      const double before = trials.bodySteps();
      one.runner_up = trials.choose(bill_.budget, one.chosen.method.integrator);
      one.digit_less = trials.choose(scaled(bill_.budget, 10));
      one.digit_more = trials.choose(scaled(bill_.budget, 0.1));
      bill_.body_steps += trials.bodySteps() - before;
    }
    for (ClassBill& one : bill_.classes) std::sort(one.bodies.begin(), one.bodies.end());
  }

 private:
  std::unique_ptr<Trials> trialsOf(const Part& part) const {
    const auto inScene = [&](Eigen::Index body) {
      return part.indices[static_cast<std::size_t>(body)];
    };
    try {
      return std::make_unique<Trials>(part, allowance_);
    } catch (const TooLong& why) {
      throw TooLong(why.what(), inScene(why.body()));
    } catch (const Unplannable& why) {
      throw Unplannable(why.what(), inScene(why.body()));
    }
  }

  Offer bestOf(const Trials& trials) const {
    if (auto best = trials.best(bill_.budget)) return *best;
    throw Unplannable(
        "what acts on it or its spin is too fast for every integrator, in as many substeps as "
        "trials may fly",
        trials.part().indices.front());
  }

  std::size_t placeOf(const Method& method, bool is_free) {
    std::size_t place = 0;
    const auto fits = [&](const ClassBill& one) {
      return one.chosen.method == method && one.is_free == is_free;
    };
    while (place < bill_.classes.size() && !fits(bill_.classes[place])) ++place;
    if (place == bill_.classes.size()) {
      bill_.classes.emplace_back();
      bill_.classes.back().chosen.method = method;
      bill_.classes.back().is_free = is_free;
    }
    hardest_.resize(bill_.classes.size());
    while (shares_.size() < bill_.classes.size()) {
      const ClassBill& one = bill_.classes[shares_.size()];
      shares_.push_back(shareOf(bill_.budget, one.chosen.error, one.doubt));
    }
    return place;
  }

  Bill& bill_;
  Allowance allowance_;
  std::vector<std::unique_ptr<Trials>> hardest_;  // of each class; null: flown for an earlier bill
  std::vector<double> shares_;
};

/// @throws std::invalid_argument naming the body, the best there is and what it leaves, if the bill
/// does not keep its budget
void requireKept(const Bill& bill, const Scene& scene) {
  for (const ClassBill& one : bill.classes)
    if (!one.keeps_budget) throw std::invalid_argument(refusal(bill, one, scene));
}

}  // namespace

double shareOf(const Budget& budget, const Deviation& error, const Deviation& doubt) {
  const auto share = [](double error, double limit) {
    return std::isinf(limit) ? 0 : error / limit;
  };
  return std::max(share(error.attitude_rad + doubt.attitude_rad, budget.attitude_rad),
                  share(error.position_m + doubt.position_m, budget.position_m)) /
         kShareOfBudget;
}

namespace {

/// As planFrom(). @throws Unplannable, TooLong
Bill planWithin(const Allowance& allowance, std::vector<Part> parts, const Situation& now,
                const Budget& budget, WithoutAMethod otherwise) {
  Bill bill;
  bill.budget = budget;
  bill.tick = now.tick;
  bill.forecasts.resize(static_cast<std::size_t>(now.bodies.count()));
  Choice choice(bill, allowance);
  const auto add = [&](const Part& part) {
    const std::size_t place = choice.add(part);
    if (otherwise == WithoutAMethod::kRefuse) requireKept(bill, now.scene);
    return place;
  };
  if (parts.size() <= kMostFlown) {
    for (const Part& part : parts) add(part);
  } else {
    const auto kinds = byKind(std::move(parts));
    const std::size_t of_each = std::max<std::size_t>(1, kMostFlown / kinds.size());
    for (const auto& [kind, alike] : kinds) {
      std::size_t dearest = add(alike[0]);
      for (std::size_t i = 1; i < alike.size(); ++i) {
        if (i >= of_each) {
          choice.addUnflown(alike[i].indices[0], dearest);
          continue;
        }
        const std::size_t place = add(alike[i]);
        if (choice.costOf(place) > choice.costOf(dearest)) dearest = place;
      }
    }
  }
  choice.finish();
  return bill;
}

/// As a simulator at its start: else every method would seem to be bad.
void requireFinite(const Situation& now) {
  const double time_s = static_cast<double>(now.tick) * now.scene.step_s();
  const auto wrong = notFinite(now.scene.effects, Instant(now.bodies, time_s));
  if (!wrong) return;
  const std::string& name = now.scene.bodies[static_cast<std::size_t>(wrong->body)].name;
  throw std::invalid_argument("body '" + name + "': " + wrong->why);
}

/// What `plan` makes of the longest flights that do not take too many steps.
template <class Plan>
Bill planOfFlights(Allowance allowance, const Plan& plan) {
  while (true) {
    try {
      return plan(allowance);
    } catch (const TooLong&) {
      if (allowance.ticks <= kFewestTicks) throw;
      allowance = shorter(allowance);
    }
  }
}

}  // namespace

Bill planFrom(const Situation& now, const Budget& budget, WithoutAMethod otherwise) {
  if (otherwise == WithoutAMethod::kRefuse) requireFinite(now);
  const std::vector<Part> parts = partsOf(now);
  const std::size_t flown = std::min(parts.size(), kMostFlown);
  const Allowance allowance =
      allowanceOf(budget, now.scene.step_s(), flown, parts[0].bodies.count());
  try {
    return planOfFlights(allowance, [&](const Allowance& one) {
      return planWithin(one, parts, now, budget, otherwise);
    });
  } catch (const Unplannable& why) {
    throw Unplannable(refusal(budget, why, now.scene), why.body());
  }
}

namespace {

Bill planAgainFor(Eigen::Index body, const Bill& bill, const Situation& now) {
  const auto part = partOf(now, {body});
  Bill next = bill;
  next.tick = now.tick;
  next.body_steps = 0;
  for (auto one = next.classes.begin(); one != next.classes.end();) {
    one->bodies.erase(std::remove(one->bodies.begin(), one->bodies.end(), body), one->bodies.end());
    one = one->bodies.empty() ? next.classes.erase(one) : one + 1;
  }
  return planOfFlights(allowanceOf(bill.budget, now.scene.step_s(), 1, 1),
                       [&](const Allowance& allowance) {
                         Bill one = next;
                         Choice choice(one, allowance);
                         choice.add(*part);
                         choice.finish();
                         return one;
                       });
}

}  // namespace

Bill planAgain(const Bill& bill, const Situation& now, Eigen::Index body) {
  try {
    if (areCoupled(now.scene.effects, now.bodies.count()))
      return planFrom(now, bill.budget, WithoutAMethod::kTakeTheBest);
    return planAgainFor(body, bill, now);
  } catch (const Unplannable&) {
    return bill;  // nothing better is known
  }
}

Bill plan(const Scene& scene, const Budget& budget) {
  Scene bare = scene;
  bare.accuracy.reset();
  bare.methods = {};
  // What is refused last, and takes no step here.
  bare.integrator = "adaptive";
  bare.substeps = kMostSubsteps;
  const Simulator simulator(bare);
  return planFrom({simulator.scene(), simulator.bodies(), {}, 0}, budget, WithoutAMethod::kRefuse);
}

std::vector<MethodOfBodies> methodsOf(const Bill& bill) {
  std::vector<MethodOfBodies> methods;
  for (const ClassBill& one : bill.classes) methods.push_back({one.bodies, one.chosen.method});
  return methods;
}

}  // namespace rigid_body_sim

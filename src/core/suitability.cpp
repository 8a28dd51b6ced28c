#include "core/suitability.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "core/stiffness_sum.hpp"

namespace rigid_body_sim {
namespace {

/// If the bodies have methods of their own.
void requireEachBodyOnce(const Scene& scene) {
  if (scene.methods.empty()) return;
  std::vector<int> counts(scene.bodies.size(), 0);
  for (const MethodOfBodies& part : scene.methods) {
    if (part.bodies.empty()) throw std::invalid_argument("a method for no body");
    for (const Eigen::Index body : part.bodies) {
      if (body < 0 || body >= static_cast<Eigen::Index>(counts.size()))
        throw std::invalid_argument("a method for the body " + std::to_string(body) +
                                    ", which is not there");
      ++counts[body];
    }
  }
  for (std::size_t i = 0; i < counts.size(); ++i)
    if (counts[i] != 1)
      throw std::invalid_argument("body '" + scene.bodies[i].name + "' has " +
                                  std::to_string(counts[i]) + " methods; it takes one");
}

/// Of effects that are wrong for bodies without the gyroscopic term.
void requireGyroscopicTerm(const Scene& scene) {
  for (const auto& effect : scene.effects) {
    if (!effect->needsGyroscopicTerm()) continue;
    const std::vector<Eigen::Index> off = ungyroscopicBodies(scene);
    if (!off.empty())
      throw std::invalid_argument("'" + effect->name() + "' needs the gyroscopic term, and body '" +
                                  scene.bodies[off.front()].name + "' has none");
  }
}

}  // namespace

std::vector<MethodOfBodies> methodsOf(const Scene& scene) {
  if (scene.methods.empty()) return {{{}, methodOf(scene)}};
  if (scene.methods.size() == 1) return {{{}, scene.methods[0].method}};
  return scene.methods;
}

EffectList effectsOn(const MethodOfBodies& part, const Scene& scene) {
  if (part.bodies.empty()) return scene.effects;
  auto effects = restrictedTo(scene.effects, part.bodies);
  if (!effects)
    throw std::invalid_argument(
        "an effect couples the bodies of the scene: they all take the same method");
  return *effects;
}

std::string toText(const Method& method) {
  if (method.substeps == 1) return method.integrator;
  return method.integrator + " x " + std::to_string(method.substeps);
}

std::optional<EffectList> restrictedTo(const EffectList& effects,
                                       const std::vector<Eigen::Index>& bodies) {
  EffectList restricted;
  for (const auto& effect : effects) {
    auto part = effect->restrictedTo(bodies);
    if (!part) return std::nullopt;
    if (part->bodyCount() > 0) restricted.push_back(std::move(part));
  }
  return restricted;
}

int orderUnder(const IntegratorRow& row, const Effect& effect) {
  if (row.has_drifts && effect.flowOrder() > 0) {
    const bool goes_back = row.order_under_drag == 0 && row.order > 0;
    if (goes_back && !effect.hasReversibleFlow()) return 0;
    return std::min(row.order, effect.flowOrder());
  }
  return effect.dependsOnVelocity() ? row.order_under_drag : row.order;
}

bool areCoupled(const EffectList& effects, Eigen::Index count) {
  for (Eigen::Index i = 0; i < count; ++i)
    if (!restrictedTo(effects, {i})) return true;
  return false;
}

Bodies rowsOf(const Bodies& bodies, const std::vector<Eigen::Index>& indices) {
  Bodies rows(static_cast<Eigen::Index>(indices.size()));
  for (std::size_t k = 0; k < indices.size(); ++k) {
    const auto row = static_cast<Eigen::Index>(k);
    rows.mass(row) = bodies.mass(indices[k]);
    rows.I_BBcm_B.row(row) = bodies.I_BBcm_B.row(indices[k]);
    if (bodies.hasAddedMass()) {
      rows.inverse_mass_B.conservativeResize(rows.count(), 9);
      rows.inverse_mass_B.row(row) = bodies.inverse_mass_B.row(indices[k]);
    }
    rows.setState(row, bodies.state(indices[k]));
  }
  return rows;
}

FastestBody fastestOf(const Bodies& bodies) {
  FastestBody fastest;
  for (Eigen::Index i = 0; i < bodies.count(); ++i) {
    const double rate = angularVelocityInBody(bodies.state(i), bodies.moments(i)).norm();
    if (rate > fastest.rate) fastest = {i, rate};
  }
  return fastest;
}

std::string objection(const Method& method, const EffectList& effects) {
  const IntegratorRow& row = integratorNamed(method.integrator);
  if (method.substeps <= 0 || method.substeps > kMostSubsteps)
    return "the number of substeps must be from 1 to " + std::to_string(kMostSubsteps) + ", not " +
           std::to_string(method.substeps);
  if (!(method.tolerance > 0)) return "the tolerance must be positive";
  for (const auto& effect : effects) {
    const bool is_reversible = effect->flowOrder() > 0 && effect->hasReversibleFlow();
    if (row.order > 0 && row.order_under_drag == 0 && effect->dependsOnVelocity() && !is_reversible)
      return "integrator '" + row.name + "' has steps back in time, in which '" + effect->name() +
             "' would feed energy: it depends on velocities; take rk4 or rk8";
  }
  return {};
}

namespace {

Sum emptySum(const IntegratorRow& row, const EffectList& effects) {
  Sum sum;
  const auto is_friction = [](const auto& effect) { return isFriction(*effect); };
  if (kicksWithinFlows(row) && std::any_of(effects.begin(), effects.end(), is_friction))
    sum.most_swing = kSwingWithinFriction;
  return sum;
}

/// The effects that bound this method's step.
EffectList forcesFor(const IntegratorRow& row, const EffectList& effects) {
  EffectList forces;
  for (const auto& effect : effects)
    if (!(row.has_drifts && effect->hasStableFlow())) forces.push_back(effect);
  return forces;
}

/// Of all bodies at once; an upper bound, as each effect may have another stiffest one.
Sum sumOf(Sum sum, const EffectList& forces, const Instant& now) {
  for (const auto& effect : forces) sum.add(*effect, effect->stiffness(now));
  return sum;
}

}  // namespace

Sum sumOn(Eigen::Index i, Sum sum, const EffectList& forces, const Instant& now) {
  const Bodies own = rowsOf(now.bodies(), {i});
  const Instant alone(own, now.time_s());
  for (const auto& effect : forces) {
    const auto part = effect->restrictedTo({i});
    sum.add(*effect, part ? part->stiffness(alone) : effect->stiffness(now));
  }
  return sum;
}

namespace {

std::string wordsFor(const Sum& sum, const Method& method, double tick_s, bool exact_bears_it) {
  const double longest = sum.longest(integratorNamed(method.integrator));
  std::ostringstream why;
  why << sum.names << (sum.isOfMany() ? " together are too stiff: it " : " is too stiff: it ");
  if (sum.squares > 0) why << "may swing at " << std::sqrt(sum.squares) << " rad/s";
  if (sum.squares > 0 && sum.decays > 0) why << " and ";
  if (sum.decays > 0) why << "slows down at " << sum.decays << " 1/s";
  why << "; with '" << toText(method) << "' the largest stable step is "
      << longest * method.substeps << " s";
  if (const double substeps = std::ceil(tick_s / longest); substeps <= kMostSubsteps)
    why << ", or take " << substeps << " substeps";
  if (exact_bears_it) why << ", or exact, which bears any step";
  return why.str();
}

}  // namespace

std::optional<Fault> oneTooStiff(const Method& method, const EffectList& effects,
                                 const Instant& now, double tick_s) {
  const IntegratorRow& row = integratorNamed(method.integrator);
  for (const auto& effect : forcesFor(row, effects)) {
    const Stiffness stiff = effect->stiffness(now);
    Sum alone = emptySum(row, effects);
    alone.add(*effect, stiff);
    if (tick_s > alone.longest(row) * method.substeps)
      return Fault{stiff.body, wordsFor(alone, method, tick_s, effect->hasStableFlow())};
  }
  return std::nullopt;
}

std::optional<Fault> tooStiff(const Method& method, const EffectList& effects, const Instant& now,
                              double tick_s) {
  if (auto fault = oneTooStiff(method, effects, now, tick_s)) return fault;
  const IntegratorRow& row = integratorNamed(method.integrator);
  const EffectList forces = forcesFor(row, effects);
  const auto isTooLong = [&](const Sum& sum) {
    return tick_s > sum.longest(row) * method.substeps;
  };
  const Sum empty = emptySum(row, effects);
  if (!isTooLong(sumOf(empty, forces, now))) return std::nullopt;
  for (Eigen::Index i = 0; i < now.bodies().count(); ++i) {
    const Sum sum = sumOn(i, empty, forces, now);
    if (isTooLong(sum)) return Fault{i, wordsFor(sum, method, tick_s, false)};
  }
  return std::nullopt;
}

std::optional<Fault> notFinite(const EffectList& effects, const Instant& now) {
  for (const auto& effect : effects) {
    Wrenches wrenches;
    wrenches.setZero(now.bodies().count());
    effect->addWrenches(now, wrenches);
    for (Eigen::Index i = 0; i < now.bodies().count(); ++i)
      if (!wrenches.f_W.row(i).allFinite() || !wrenches.t_Bcm_W.row(i).allFinite())
        return Fault{i, "'" + effect->name() + "' acts on it with a wrench that is not finite"};
    const Stiffness stiff = effect->stiffness(now);
    if (!std::isfinite(stiff.oscillation) || !std::isfinite(stiff.decay) ||
        !std::isfinite(effect->potentialEnergy(now)))
      return Fault{stiff.body, "'" + effect->name() +
                                   "' has an energy or a frequency there that is not finite"};
  }
  return std::nullopt;
}

std::string objection(const Method& method, double rate, double tick_s) {
  const IntegratorRow& row = integratorNamed(method.integrator);
  const double turn = rate * tick_s / method.substeps;
  if (!(turn > row.max_turn)) return {};
  std::ostringstream why;
  why << rate << " rad/s are " << turn << " rad a step, and '" << row.name << "' bears "
      << row.max_turn << "; take " << std::ceil(rate * tick_s / row.max_turn)
      << " substeps or more, or exact";
  return why.str();
}

std::vector<std::string> requireSuitableMethods(const Scene& scene, const Bodies& bodies,
                                                double time_s) {
  requireEachBodyOnce(scene);
  requireGyroscopicTerm(scene);
  std::vector<std::string> cautions;
  for (const MethodOfBodies& part : methodsOf(scene)) {
    const EffectList effects = effectsOn(part, scene);
    std::string why = objection(part.method, effects);
    if (!why.empty()) throw std::invalid_argument(why);
    const Bodies own = part.bodies.empty() ? bodies : rowsOf(bodies, part.bodies);
    const auto nameOf = [&](Eigen::Index own_body) {
      return "body '" + scene.bodies[part.bodies.empty() ? own_body : part.bodies[own_body]].name +
             "': ";
    };
    const Instant now(own, time_s);
    if (const auto wrong = notFinite(effects, now))
      throw std::invalid_argument(nameOf(wrong->body) + wrong->why);
    if (const auto stiff = tooStiff(part.method, effects, now, scene.step_s()))
      throw std::invalid_argument(nameOf(stiff->body) + stiff->why);
    const FastestBody fastest = fastestOf(own);
    why = objection(part.method, fastest.rate, scene.step_s());
    if (!why.empty()) throw std::invalid_argument(nameOf(fastest.body) + why);
    if (scene.accuracy) continue;  // the bill has measured what the methods get wrong
    cautions.push_back(caution(part.method, effects));
    if (cautions.back().empty()) cautions.pop_back();
    if (const std::string turns = turnsTooFar(part.method, effects, now, scene.step_s());
        !turns.empty())
      cautions.push_back(turns);
    if (const auto slow = stoppedAtOnce(part.method, effects, now, scene.step_s()))
      cautions.push_back(nameOf(slow->body) + slow->why);
  }
  return cautions;
}

}  // namespace rigid_body_sim

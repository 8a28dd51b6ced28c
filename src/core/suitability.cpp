#include "core/suitability.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <utility>

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

/// The methods on velocities kick between the flows, and then a swing w h is bounded up to
/// (w h)^2 = 2 (1 + exp(-x)) under a friction of x a step: 2 without, the root of 2 with any.
constexpr double kSwingWithinFriction = 1.41;

bool kicksWithinFlows(const IntegratorRow& row) {
  return row.has_drifts && !row.keeps_angular_momentum;
}

bool isFriction(const Effect& effect) {
  return effect.hasStableFlow() && !effect.hasReversibleFlow();
}

/// What several effects make of a body together: squares of frequencies add, and so do rates of
/// decay.
struct Sum {
  double most_swing = std::numeric_limits<double>::infinity();  // [rad] a step, beside the row's
  double squares = 0;                                           // [1/s^2]
  double decays = 0;                                            // [1/s]
  bool is_linear = true;
  std::string names;

  void add(const Effect& effect, const Stiffness& stiff) {
    if (stiff.oscillation == 0 && stiff.decay == 0) return;
    squares += stiff.oscillation * stiff.oscillation;
    decays += stiff.decay;
    is_linear = is_linear && (stiff.is_linear || stiff.oscillation == 0);
    names += (names.empty() ? "'" : " and '") + effect.name() + "'";
  }
  double longest(const IntegratorRow& row) const {
    const double max_swing = std::min(most_swing, is_linear ? row.max_swing : row.max_large_swing);
    // Both at once bear less than each alone: an ellipse lies within the regions of stability.
    const double decay = decays == 0 ? 0 : decays / row.max_decay;
    return 1 / std::hypot(std::sqrt(squares) / max_swing, decay);
  }
};

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

/// Of body i alone; effects that cannot be divided count with their stiffest body.
Sum sumOn(Eigen::Index i, Sum sum, const EffectList& forces, const Instant& now) {
  const Bodies own = rowsOf(now.bodies(), {i});
  const Instant alone(own, now.time_s());
  for (const auto& effect : forces) {
    const auto part = effect->restrictedTo({i});
    sum.add(*effect, part ? part->stiffness(alone) : effect->stiffness(now));
  }
  return sum;
}

std::string wordsFor(const Sum& sum, const Method& method, double tick_s, bool exact_bears_it) {
  const double longest = sum.longest(integratorNamed(method.integrator));
  const bool are_many = sum.names.find(" and ") != std::string::npos;
  std::ostringstream why;
  why << sum.names << (are_many ? " together are too stiff: it " : " is too stiff: it ");
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

std::string caution(const Method& method, const EffectList& effects) {
  const IntegratorRow& row = integratorNamed(method.integrator);
  for (const auto& effect : effects) {
    const int order = orderUnder(row, *effect);
    if (order >= row.order || order == 0) continue;
    const bool is_flow = effect->flowOrder() > 0;
    return effect->name() + (is_flow ? " is a flow of its own: " : " depends on velocities: ") +
           row.name + " is of order " + std::to_string(order) + " with it, not " +
           std::to_string(row.order) +
           (is_flow ? "" : ", and may gain energy without bound; rk4 and rk8 keep their order");
  }
  return {};
}

std::optional<Fault> stoppedAtOnce(const Method& method, const EffectList& effects,
                                   const Instant& now, double tick_s) {
  const IntegratorRow& row = integratorNamed(method.integrator);
  if (!row.has_drifts) return std::nullopt;
  for (const auto& effect : effects) {
    if (!isFriction(*effect)) continue;
    const Stiffness stiff = effect->stiffness(now);
    const double a_step = stiff.decay * tick_s / method.substeps;
    if (!(a_step > 1)) continue;
    // A steady force f gives f h/2 around each drift, of which exp(-x/2) is left in it; right would
    // be f/c, with x = c h. Nothing as simple holds for friction that grows with the speed, nor
    // where the kick lies within the flows.
    const double share = 0.5 * a_step / std::sinh(0.5 * a_step);
    const bool is_known = stiff.is_linear && !kicksWithinFlows(row);
    std::ostringstream why;
    why << "'" << effect->name() << "' slows it down at " << stiff.decay << " 1/s, " << a_step
        << " times a step: a steady force moves it at ";
    if (is_known)
      why << "as little as " << 100 * share << " % of the right speed then; ";
    else
      why << "a wrong speed then; ";
    if (const double substeps = std::ceil(2 * a_step * method.substeps); substeps <= kMostSubsteps)
      why << "with " << substeps << " substeps at " << (is_known ? "99 %" : "about the right one");
    else
      why << "no number of substeps mends that, but a shorter step_s";
    if (stiff.decay * tick_s <= kMostSubsteps * integratorNamed("rk4").max_decay)
      why << "; rk4, rk8 and adaptive have no such error";
    return Fault{stiff.body, why.str()};
  }
  return std::nullopt;
}

constexpr double kLargeTurn = 0.5;  // [rad]

/// Kicks before and after a drift act along the world's axes as they are then. If these turn by x
/// in between, two halves of a kick make f h cos(x/2), where f h sin(x/2) / (x/2) is right.
std::string turnsTooFar(const Method& method, const EffectList& effects, const Instant& now,
                        double tick_s) {
  if (!integratorNamed(method.integrator).has_drifts) return {};
  for (const auto& effect : effects) {
    if (!effect->hasTurningFlow()) continue;
    const double turn = 0.5 * effect->stiffness(now).oscillation * tick_s / method.substeps;
    if (!(turn > kLargeTurn)) continue;
    std::ostringstream why;
    why << "'" << effect->name() << "' turns by " << turn
        << " rad a step: free flight is exact, but a steady force gives "
        << 100 * (0.5 * turn) / std::tan(0.5 * turn) << " % of the right momentum; ";
    if (const double substeps = std::ceil(turn * method.substeps / 0.34); substeps <= kMostSubsteps)
      why << "with " << substeps << " substeps 99 %";
    else
      why << "a shorter step_s mends that";
    return why.str();
  }
  return {};
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

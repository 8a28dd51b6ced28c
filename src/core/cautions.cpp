// What a method bears, but not without an error that its user should know of.
#include <cmath>
#include <sstream>

#include "core/stiffness_sum.hpp"

namespace rigid_body_sim {

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

namespace {

/// Friction of all effects together on a body: a bound, as one may slow down what another does not.
struct Friction {
  Eigen::Index body = 0;
  Sum sum;
};

/// On the body that has most of it; looked for only if it may be more than `little` [1/s].
Friction mostFriction(const EffectList& effects, const Instant& now, double little) {
  EffectList frictions;
  Friction bound;
  for (const auto& effect : effects) {
    if (!isFriction(*effect)) continue;
    const Stiffness stiff = effect->stiffness(now);
    bound.body = stiff.body;
    bound.sum.add(*effect, stiff);
    frictions.push_back(effect);
  }
  if (frictions.size() < 2 || bound.sum.decays <= little) return bound;
  Friction most;
  for (Eigen::Index i = 0; i < now.bodies().count(); ++i) {
    const Sum sum = sumOn(i, {}, frictions, now);
    if (sum.decays > most.sum.decays) most = {i, sum};
  }
  return most;
}

}  // namespace

constexpr double kNothing = 1e-4;  // of a speed: less is not worth a number

std::optional<Fault> stoppedAtOnce(const Method& method, const EffectList& effects,
                                   const Instant& now, double tick_s) {
  const IntegratorRow& row = integratorNamed(method.integrator);
  if (!row.has_drifts) return std::nullopt;
  const auto [body, sum] = mostFriction(effects, now, method.substeps / tick_s);
  const double a_step = sum.decays * tick_s / method.substeps;
  if (!(a_step > 1)) return std::nullopt;
  // A steady force f gives f h/2 around each drift, of which exp(-x/2) is left in it; right would
  // be f/c, with x = c h. Nothing as simple holds for friction that grows with the speed, nor
  // where the kick lies within the flows, or friction is along a line that turns.
  const double share = 0.5 * a_step / std::sinh(0.5 * a_step);
  const bool is_known = sum.is_decay_linear && !kicksWithinFlows(row);
  std::ostringstream why;
  why << sum.names << (sum.isOfMany() ? " together slow it down at up to " : " slows it down at ")
      << sum.decays << " 1/s, " << a_step << " times a step: a steady force moves it at ";
  if (is_known && share < kNothing)
    why << "less than " << 100 * kNothing << " % of the right speed then; ";
  else if (is_known)
    why << "as little as " << 100 * share << " % of the right speed then; ";
  else
    why << "a wrong speed then; ";
  if (const double substeps = std::ceil(2 * a_step * method.substeps); substeps <= kMostSubsteps)
    why << "with " << substeps << " substeps at " << (is_known ? "99 %" : "about the right one");
  else
    why << "no number of substeps mends that, but a shorter step_s";
  if (sum.decays * tick_s <= kMostSubsteps * integratorNamed("rk4").max_decay)
    why << "; rk4 and rk8 have no such error, in the substeps that they bear it with";
  return Fault{body, why.str()};
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

}  // namespace rigid_body_sim

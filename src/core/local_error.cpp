#include "core/local_error.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/friction.hpp"

namespace rigid_body_sim {
namespace {

/// Enough steps of rk8 that each turns by no more than a tenth of a radian, where its own error is
/// rounding (1e-16 measured at 0.1 rad, 2e-15 at 0.2), and that their order leaves the method
/// behind whose steps are short for a reason that is not the spin. Where friction is so stiff that
/// the most steps are no shorter than half of what it takes to slow down, adaptive ones: of rk8 a
/// step of half leaves 5e-9 of what is slowed down.
Method farBetterThan(const Method& used, const Part& part) {
  if (part.effects.empty()) return {"exact"};
  constexpr double kMostSteps = kMostEvaluations / 12.0;
  const Instant now(part.bodies, static_cast<double>(part.tick) * part.tick_s);
  const double decays = fastestDecay(part.effects, now).rate * part.tick_s;
  if (decays > 0.5 * kMostSteps)
    return {"adaptive", std::min(piecesFor(decays), kMostPieces), 1e-14};
  const double turn = fastestOf(part.bodies).rate * part.tick_s;
  const IntegratorRow& row = integratorNamed(used.integrator);
  const double wanted = std::max({std::ceil(turn / 0.1), std::ceil(decays / 0.5),
                                  std::ceil(2.0 * used.substeps * row.order / 8)});
  return {"rk8", static_cast<int>(std::clamp(wanted, 1.0, kMostSteps))};
}

bool areFinite(const Bodies& bodies) {
  for (Eigen::Index i = 0; i < bodies.count(); ++i)
    if (!isFinite(bodies.state(i))) return false;
  return true;
}

}  // namespace

Bodies flyTickTruly(const Part& before, const Method& used) {
  Method better = farBetterThan(used, before);
  while (true) {
    Flight flight(before, better);
    flight.step();
    // Friction may grow within the tick: from rest there is no drag.
    if (areFinite(flight.bodies()) || !haveFlows(before.effects) || better.substeps >= kMostPieces)
      return flight.bodies();
    better = {"adaptive", 2 * better.substeps, 1e-14};
  }
}

Deviation localError(const Part& before, const Bodies& after, const Method& used) {
  const Bodies truth = flyTickTruly(before, used);
  Deviation error;
  for (Eigen::Index i = 0; i < after.count(); ++i) error = worse(error, deviation(truth, after, i));
  return error;
}

Deviation roundingOfTick(const Bodies& bodies, double tick_s) {
  Deviation rounding;
  for (Eigen::Index i = 0; i < bodies.count(); ++i) {
    const BodyState body = bodies.state(i);
    const double turn = body.L_WBcm_W.norm() / bodies.I_BBcm_B(i, 0) * tick_s;
    const double way = body.P_WB.norm() / bodies.mass(i) * tick_s;
    rounding = worse(rounding, {1 + turn, body.p_WBcm.norm() + way});
  }
  constexpr double k20Ulps = 20 * std::numeric_limits<double>::epsilon();
  return {k20Ulps * rounding.attitude_rad, k20Ulps * rounding.position_m};
}

}  // namespace rigid_body_sim

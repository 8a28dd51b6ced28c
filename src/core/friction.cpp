#include "core/friction.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "rigid_body_sim/integrator.hpp"

namespace rigid_body_sim {
namespace {

constexpr double kStepsOfPiece = 1000;

}  // namespace

bool haveFlows(const EffectList& effects) {
  return std::any_of(effects.begin(), effects.end(), [](const auto& effect) {
    return effect->flowOrder() > 0 && effect->dependsOnVelocity();
  });
}

Decay fastestDecay(const EffectList& effects, const Instant& now) {
  Decay sum;
  double fastest = 0;
  for (const auto& effect : effects) {
    if (!effect->dependsOnVelocity()) continue;
    const Stiffness stiff = effect->stiffness(now);
    if (stiff.decay == 0) continue;
    sum.rate += stiff.decay;
    sum.names += (sum.names.empty() ? "'" : " and '") + effect->name() + "'";
    if (stiff.decay <= fastest) continue;
    fastest = stiff.decay;
    sum.body = stiff.body;
  }
  return sum;
}

int piecesFor(double decays) {
  const double each = kStepsOfPiece * 0.5 * integratorNamed("rk8").max_decay;
  const double pieces = std::ceil(decays / each);
  if (!(pieces < std::numeric_limits<int>::max())) return std::numeric_limits<int>::max();
  return std::max(1, static_cast<int>(pieces));
}

}  // namespace rigid_body_sim

#pragma once

#include <memory>

#include "integrators/drift.hpp"
#include "integrators/kick.hpp"

namespace rigid_body_sim {

/// Half a kick, a whole drift, half a kick: second order under wrenches that depend on time and
/// pose, first order under those that depend on velocities. The parabola of a constant force is
/// exact, x += v h + a h^2/2. `Rotation` as for drift().
template <class Rotation, Gyroscopic gyroscopic>
class KickDriftKick : public Integrator {
 public:
  void step(Bodies& bodies, ActiveEffects& effects, double time_s, double h) override {
    if (!effects.empty()) kick(bodies, effects.evaluate(bodies, time_s), 0.5 * h);
    drift<Rotation, gyroscopic>(bodies, h);
    if (!effects.empty()) kick(bodies, effects.evaluate(bodies, time_s + h), 0.5 * h);
  }
};

template <class Rotation>
std::unique_ptr<Integrator> makeKickDriftKick(const IntegratorOptions& options) {
  if (options.gyroscopic == Gyroscopic::kOn)
    return std::make_unique<KickDriftKick<Rotation, Gyroscopic::kOn>>();
  return std::make_unique<KickDriftKick<Rotation, Gyroscopic::kOff>>();
}

}  // namespace rigid_body_sim

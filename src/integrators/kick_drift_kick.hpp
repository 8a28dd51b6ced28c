#pragma once

#include <memory>

#include "integrators/drift.hpp"
#include "integrators/kick.hpp"

namespace rigid_body_sim {

/// Half a kick, a whole drift, half a kick: second order under wrenches that depend on time and
/// pose and with flows, first order under other wrenches that depend on velocities. The parabola of
/// a constant force is exact, x += v h + a h^2/2. `Rotation` as for drift().
template <class Rotation>
struct KickDriftKick {
  template <Gyroscopic gyroscopic>
  class Method : public Integrator {
   public:
    explicit Method(const IntegratorOptions& options) : ungyroscopic_(options.ungyroscopic) {}

    void step(Bodies& bodies, ActiveEffects& effects, double time_s, double h) override {
      kick(bodies, effects, time_s, 0.5 * h);
      driftWithFlows(bodies, effects, time_s, h,
                     [&] { drift<Rotation>(bodies, h, ungyroscopic_); });
      kick(bodies, effects, time_s + h, 0.5 * h);
    }

   private:
    Ungyroscopic<gyroscopic> ungyroscopic_;
  };
};

template <class Rotation>
std::unique_ptr<Integrator> makeKickDriftKick(const IntegratorOptions& options) {
  return makeFor<KickDriftKick<Rotation>::template Method>(options);
}

}  // namespace rigid_body_sim

#pragma once

#include "integrators/columns.hpp"
#include "rigid_body_sim/active_effects.hpp"

namespace rigid_body_sim {

/// Kick: the momentum that the wrenches give in `step_s` [s], P += f h and L += t h.
inline void kick(Bodies& bodies, const Wrenches& wrenches, double step_s) {
  batch::kernels().kick(columnsOf(bodies), columnsOf(wrenches), step_s, allOf(bodies));
}

/// The kick of all effects at `time_s` that have no flow.
inline void kick(Bodies& bodies, ActiveEffects& effects, double time_s, double step_s) {
  if (effects.hasKicks()) kick(bodies, effects.evaluateKicks(bodies, time_s, step_s), step_s);
}

/// A drift of h [s] from `time_s` with the flows around it.
template <class Drift>
void driftWithFlows(Bodies& bodies, ActiveEffects& effects, double time_s, double h, Drift drift) {
  if (!effects.hasFlows()) return drift();
  effects.beforeDrift(bodies, time_s, h);
  drift();
  effects.afterDrift(bodies, time_s, h);
}

}  // namespace rigid_body_sim

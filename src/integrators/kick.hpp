#pragma once

#include "rigid_body_sim/effect.hpp"

namespace rigid_body_sim {

/// Kick: the momentum that the wrenches give in `step_s` [s], P += f h and L += t h.
inline void kick(Bodies& bodies, const Wrenches& wrenches, double step_s) {
  bodies.P_WB += step_s * wrenches.f_W;
  bodies.L_WBcm_W += step_s * wrenches.t_Bcm_W;
}

}  // namespace rigid_body_sim

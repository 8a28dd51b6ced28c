#pragma once

#include "rigid_body_sim/conventions.hpp"

namespace rigid_body_sim::reference {

/// Attitude and rates of a torque-free body at one moment.
struct Rotation {
  Quaterniond q_WB = Quaterniond::Identity();
  Vector3d w_WB_B = Vector3d::Zero();  ///< [rad/s]
};

/// Exact free rotation for `time_s` [s] of a body two of whose principal moments I_BBcm_B [kg m^2]
/// are equal. The body turns at a constant rate about the fixed angular momentum, and at a constant
/// rate about its own axis of symmetry (Landau and Lifshitz, Mechanics, section 33):
/// q = exp(t L / I_t) q_0 exp(t (1/I_a - 1/I_t) L_a e_a), with I_t the moment that stands twice.
/// Computed in long double; the result is rounded once.
/// @throws std::invalid_argument if no two moments are equal.
Rotation symmetricTop(const Vector3d& I_BBcm_B, const Rotation& start, double time_s);

}  // namespace rigid_body_sim::reference

#pragma once

#include <vector>

#include "reference/flight.hpp"

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

/// Attitudes q_WB of a torque-free body at the times 0, interval_s, ... count * interval_s [s],
/// from the angular momentum L_W [kg m^2/s] in the world: Taylor series of m' = m x w and q' = q
/// w/2 to order 30 in long double, in steps of at most 0.4 radians. The moments ascend. Good to some 1e-19 times what
/// the motion spreads small differences by; fly() adds up some hundred times more rounding.
std::vector<Quaternionr> freeAttitudes(const Vector3d& I_BBcm_B, const Quaterniond& q_WB,
                                       const Vector3d& L_W, double interval_s, int count);

}  // namespace rigid_body_sim::reference

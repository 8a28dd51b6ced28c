#pragma once

/// Notation, frames and units of the whole package.
///
/// Units are SI: m, kg, s, rad, N, N m, kg m^2, N s, N m s.
///
/// Frames
///   W  world: inertial, right-handed, z up (REP 103).
///   L  root link frame of a body, as its URDF gives it; any rigid frame on the body.
///   B  body frame: origin Bcm at the centre of mass, axes along the principal axes of inertia.
///
/// Names are quantity _ from-to _ axes; the axes are omitted when they are those of the from-frame.
///   p_WBcm     position of Bcm from W's origin, in W's axes
///   q_WB, R_WB rotation that takes components in B to components in W: p_W = R_WB p_B
///   X_WL       rigid transform: p_WQ = X_WL p_LQ
///   v_WBcm     velocity of Bcm in W, in W's axes
///   w_WB       angular velocity of B in W, in W's axes; w_WB_B the same in B's axes
///   P_WB       linear momentum;  L_WBcm_W  angular momentum about Bcm, both in W's axes
///   I_BBcm_F   inertia of body B about Bcm, in F's axes
///   f_W, t_Q_W force, and torque about point Q, in W's axes
///
/// Quaternions are Hamilton's, of unit length: p_W = q_WB p_B q_WB^-1.

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>

namespace rigid_body_sim {

using Eigen::Isometry3d;
using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;

/// Steps since the start of a simulation. Time is always tick times an integer number of
/// nanoseconds.
using Tick = std::int64_t;

}  // namespace rigid_body_sim

#pragma once

#include "rigid_body_sim/body_state.hpp"
#include "rigid_body_sim/mass_properties.hpp"

namespace rigid_body_sim {

/// Inertia of the fluid that a body carries along, in a frame F fixed to it: what its mass and its
/// tensor are larger by, along F's axes and about the centre of mass.
struct AddedMass {
  Vector3d linear_F = Vector3d::Zero();   ///< [kg]
  Vector3d angular_F = Vector3d::Zero();  ///< [kg m^2]

  bool isZero() const { return linear_F.isZero(0) && angular_F.isZero(0); }
};

/// The body frame B (centre of mass, principal axes) in the root link frame L, with the body's mass
/// and principal moments. Constant: this is the border between what users see (L) and what is
/// integrated (B).
struct BodyFrame {
  double mass = 0;                       ///< [kg], its own
  Vector3d I_BBcm_B = Vector3d::Zero();  ///< I1 <= I2 <= I3 [kg m^2], with what it carries along
  Vector3d p_LBcm = Vector3d::Zero();    ///< [m]
  Quaterniond q_LB = Quaterniond::Identity();
  bool has_added_mass = false;
  Matrix3d mass_matrix_B = Matrix3d::Zero();  ///< [kg], with added mass only: P = R M R^T v
};

/// Motion of a root link as users see it.
struct LinkMotion {
  Vector3d p_WL = Vector3d::Zero();  ///< link origin [m]
  Quaterniond q_WL = Quaterniond::Identity();
  Vector3d v_WL_L = Vector3d::Zero();  ///< velocity of the link origin [m/s], link axes
  Vector3d w_WL_L = Vector3d::Zero();  ///< angular velocity [rad/s], link axes
};

/// @throws std::invalid_argument if no rigid body has these mass properties.
BodyFrame bodyFrame(const MassProperties& body_L, const AddedMass& added_L = {});

/// State of the body whose root link is at X_WL, with v_WBcm [m/s] in world axes and w_WB_L [rad/s]
/// in link axes.
BodyState stateOfLink(const BodyFrame& frame, const Isometry3d& X_WL, const Vector3d& v_WBcm,
                      const Vector3d& w_WB_L);

/// Pose and velocities of the root link.
LinkMotion linkMotion(const BodyFrame& frame, const BodyState& body);

}  // namespace rigid_body_sim

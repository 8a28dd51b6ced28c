#pragma once

// The bodies of scenes/probe.yaml and bodies/probe.urdf, as numbers: what the node should make of
// them is worked out here from the definitions, with none of the core's functions.

#include <rigid_body_sim/BodyStates.h>

#include <Eigen/Geometry>
#include <stdexcept>
#include <string>

namespace rigid_body_sim {

using Eigen::Isometry3d;
using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr double kStep_s = 0.02;

/// A rigid body in its root link frame L, and how it starts.
struct Solid {
  std::string name;
  double mass;        ///< [kg]
  Vector3d p_LBcm;    ///< [m]
  Matrix3d I_BBcm_L;  ///< about the centre of mass [kg m^2]
  Isometry3d X_WL;    ///< at the start
  Vector3d v_WBcm;    ///< at the start [m/s], world axes
  Vector3d w_WL_L;    ///< at the start [rad/s], link axes
};

/// URDF's rpy: turned about the fixed x, then y, then z.
inline Isometry3d urdfPose(const Vector3d& xyz, const Vector3d& rpy) {
  using Eigen::AngleAxisd;
  Isometry3d X = Isometry3d::Identity();
  X.linear() = (AngleAxisd(rpy.z(), Vector3d::UnitZ()) * AngleAxisd(rpy.y(), Vector3d::UnitY()) *
                AngleAxisd(rpy.x(), Vector3d::UnitX()))
                   .toRotationMatrix();
  X.translation() = xyz;
  return X;
}

inline Matrix3d tensor(double xx, double xy, double xz, double yy, double yz, double zz) {
  Matrix3d I;
  I << xx, xy, xz, xy, yy, yz, xz, yz, zz;
  return I;
}

/// Pose of the thruster's link frame in the probe's.
inline Isometry3d thrusterInProbe() { return urdfPose({-0.31, 0.22, 0.13}, {0.5, -0.3, 0.8}); }

inline Solid probe() {
  const Isometry3d X_LA = urdfPose({0.11, -0.23, 0.37}, {0.4, -0.7, 1.1});
  const Isometry3d X_LT = thrusterInProbe() * urdfPose({0.02, 0.03, -0.05}, {-0.6, 0.3, 0.9});
  const Matrix3d I_A = tensor(0.16, -0.03, 0.02, 0.21, 0.04, 0.18);
  const Matrix3d I_T = tensor(0.002, 0.0003, -0.0002, 0.003, 0.0004, 0.0025);
  const double m_A = 2.7, m_T = 0.4;
  const Vector3d d = X_LT.translation() - X_LA.translation();

  Solid body;
  body.name = "probe";
  body.mass = m_A + m_T;
  body.p_LBcm = X_LA.translation() + m_T / body.mass * d;
  // Two masses about their common centre of mass: their tensors, and the reduced mass at d.
  body.I_BBcm_L =
      X_LA.linear() * I_A * X_LA.linear().transpose() +
      X_LT.linear() * I_T * X_LT.linear().transpose() +
      m_A * m_T / body.mass * (d.squaredNorm() * Matrix3d::Identity() - d * d.transpose());
  body.X_WL.setIdentity();
  body.X_WL.linear() = Quaterniond(0.5291502622129181, -0.48, 0.6, 0.36).toRotationMatrix();
  body.X_WL.translation() << 1.7, -0.9, 2.3;
  body.v_WBcm << 0.4, -1.1, 0.6;
  body.w_WL_L << 1.3, 0.7, -0.9;
  return body;
}

inline Solid puck() {
  Solid body;
  body.name = "puck";
  body.mass = 2;
  body.p_LBcm.setZero();
  body.I_BBcm_L = Vector3d(0.05, 0.02, 0.04).asDiagonal();
  body.X_WL.setIdentity();
  body.X_WL.linear() = Quaterniond(0.5291502622129181, 0.36, -0.48, 0.6).toRotationMatrix();
  body.X_WL.translation() << -3, 0.5, 1;
  body.v_WBcm << -0.2, 0.1, 0.3;
  body.w_WL_L << 2.5, 0, 0;
  return body;
}

inline Vector3d toEigen(const geometry_msgs::Vector3& v) { return {v.x, v.y, v.z}; }
inline Vector3d toEigen(const geometry_msgs::Point& p) { return {p.x, p.y, p.z}; }
inline Quaterniond toEigen(const geometry_msgs::Quaternion& q) { return {q.w, q.x, q.y, q.z}; }

/// A body's pose and velocities as published.
struct Motion {
  Vector3d p_WL;
  Quaterniond q_WL;
  Vector3d v_WL_L;  ///< of the link's origin, link axes
  Vector3d w_WL_L;

  Matrix3d R_WL() const { return q_WL.toRotationMatrix(); }
};

inline Motion motionOf(const geometry_msgs::Pose& pose, const geometry_msgs::Twist& twist) {
  return {toEigen(pose.position), toEigen(pose.orientation), toEigen(twist.linear),
          toEigen(twist.angular)};
}

inline Motion motionOf(const BodyStates& states, const std::string& body) {
  for (std::size_t i = 0; i < states.names.size(); ++i)
    if (states.names[i] == body) return motionOf(states.poses[i], states.twists[i]);
  throw std::runtime_error("no " + body + " in the states");
}

/// Linear and angular momentum about the centre of mass, in world axes. Free flight keeps both, so
/// that what an input gave can be read off exactly, whatever the body turned meanwhile.
struct Momentum {
  Vector3d P_WB;      ///< [kg m/s]
  Vector3d L_WBcm_W;  ///< [kg m^2/s]
};

inline Momentum momentumAtStart(const Solid& body) {
  return {body.mass * body.v_WBcm, body.X_WL.linear() * body.I_BBcm_L * body.w_WL_L};
}

inline Momentum momentumOf(const Solid& body, const Motion& motion) {
  const Vector3d v_WBcm_L = motion.v_WL_L + motion.w_WL_L.cross(body.p_LBcm);
  return {body.mass * (motion.R_WL() * v_WBcm_L), motion.R_WL() * body.I_BBcm_L * motion.w_WL_L};
}

inline Momentum momentumOf(const Solid& body, const BodyStates& states) {
  return momentumOf(body, motionOf(states, body.name));
}

/// Velocities of a body that is turned as `motion` and has this momentum: the closed form of what
/// should be published.
inline Motion withMomentum(const Solid& body, Motion motion, const Momentum& momentum) {
  const Matrix3d R_LW = motion.R_WL().transpose();
  motion.w_WL_L = body.I_BBcm_L.inverse() * (R_LW * momentum.L_WBcm_W);
  motion.v_WL_L = R_LW * momentum.P_WB / body.mass - motion.w_WL_L.cross(body.p_LBcm);
  return motion;
}

inline Vector3d centreOfMass(const Solid& body, const Motion& motion) {
  return motion.p_WL + motion.R_WL() * body.p_LBcm;
}

}  // namespace rigid_body_sim

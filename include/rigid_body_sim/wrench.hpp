#pragma once

#include "rigid_body_sim/conventions.hpp"

namespace rigid_body_sim {

/// A force and a torque about a stated point Q, both in the axes of one frame F.
struct Wrench {
  Vector3d f_F = Vector3d::Zero();    ///< [N], or [N s] for an impulse
  Vector3d t_Q_F = Vector3d::Zero();  ///< about Q [N m], or [N m s] for an impulse
};

/// True if it does nothing at all.
inline bool isZero(const Wrench& wrench) { return wrench.f_F.isZero(0) && wrench.t_Q_F.isZero(0); }

/// The same action about point R, where p_RQ_F [m] leads from R to Q: t_R = t_Q + p_RQ x f.
inline Wrench aboutPoint(const Wrench& about_Q, const Vector3d& p_RQ_F) {
  return {about_Q.f_F, about_Q.t_Q_F + p_RQ_F.cross(about_Q.f_F)};
}

/// Moment about a point O of a vector (force [N], momentum [kg m/s], impulse [N s]) that acts at A:
/// p_OA x vector.
inline Vector3d momentAboutPoint(const Vector3d& p_OA, const Vector3d& vector) {
  return p_OA.cross(vector);
}

/// Moment about the axis through O along `direction` (any length but zero): the component of the
/// moment about O along the axis, as a vector.
inline Vector3d momentAboutAxis(const Vector3d& p_OA, const Vector3d& vector,
                                const Vector3d& direction) {
  return p_OA.cross(vector).dot(direction) / direction.squaredNorm() * direction;
}

/// The axes in which a held wrench keeps its components.
enum class Axes {
  kWorld,  ///< does not turn
  kBody,   ///< turns with the body
};

/// A wrench on one body as inputs give it: its components stay constant in `axes`, and its point of
/// application Q stays fixed to the body.
struct AppliedWrench {
  Axes axes = Axes::kWorld;
  Wrench wrench;                         ///< in W for kWorld, in B for kBody; torque about Q
  Vector3d p_BcmQ_B = Vector3d::Zero();  ///< Q from the centre of mass [m], in B
};

/// What `applied` amounts to at the attitude q_WB: about the centre of mass, in world axes.
inline Wrench inWorldAboutCom(const AppliedWrench& applied, const Quaterniond& q_WB) {
  if (applied.axes == Axes::kWorld) return aboutPoint(applied.wrench, q_WB * applied.p_BcmQ_B);
  const Wrench about_com = aboutPoint(applied.wrench, applied.p_BcmQ_B);
  return {q_WB * about_com.f_F, q_WB * about_com.t_Q_F};
}

}  // namespace rigid_body_sim

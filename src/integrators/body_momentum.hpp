#pragma once

#include <cmath>

#include "rigid_body_sim/body_state.hpp"
#include "rigid_body_sim/integrator.hpp"
#include "rigid_body_sim/rotation.hpp"
#include "rigid_body_sim/wrench.hpp"

// What the Runge-Kutta methods share: their state is attitude and angular momentum in body axes,
// m = R^T L. In world axes the same methods would be hundreds of times less accurate, as every
// error of the attitude turns up in m.
namespace rigid_body_sim {

/// m' in body axes [N m]: m x w + t, the first term only with the gyroscopic effect.
inline Vector3d momentumRate(Gyroscopic gyroscopic, const Vector3d& m_B, const Vector3d& w_B,
                             const Vector3d& t_B) {
  if (gyroscopic == Gyroscopic::kOff) return t_B;
  return m_B.cross(w_B) + t_B;
}

/// The vector, not zero, times a power of two that brings it to a length of about one: without any
/// rounding.
inline Vector3d scaled(const Vector3d& v) {
  const int exponent = -std::ilogb(v.lpNorm<Eigen::Infinity>());
  return {std::scalbn(v.x(), exponent), std::scalbn(v.y(), exponent), std::scalbn(v.z(), exponent)};
}

/// Denormal numbers have lost digits: a vector of them has no direction.
constexpr double kLeastDirected = 1e-290;

/// Ends a step of `body`, which is at its beginning, at the attitude q_WB and the momentum m_B.
/// `L_W` is what the world's torques have summed up to: the shortest turn of the body brings R m
/// onto it. So the angular momentum of free flight stays the same to the bit, and no error of m
/// gets into it. Where little is left of L, as at the end of a braking, the error of m that is left
/// of the larger one says nothing of the attitude, and the body is not turned. Without the
/// gyroscopic effect L follows from the attitude.
inline void setRotation(Gyroscopic gyroscopic, BodyState& body, const Quaterniond& q_WB,
                        const Vector3d& m_B, const Vector3d& L_W) {
  body.q_WB = q_WB.normalized();
  if (gyroscopic == Gyroscopic::kOff) {
    body.L_WBcm_W = body.q_WB * m_B;
    return;
  }
  const double start = body.L_WBcm_W.lpNorm<Eigen::Infinity>();
  body.L_WBcm_W = L_W;
  const double left = L_W.lpNorm<Eigen::Infinity>();
  if (!(left > 0.1 * start) || !(left > kLeastDirected) || m_B.isZero(0)) return;
  Vector3d now = body.q_WB * m_B, wanted = L_W;
  double size = m_B.norm() * L_W.norm();
  if (std::isnan(size)) return;            // the body will be frozen
  if (!(size > 1e-140 && size < 1e140)) {  // products of two of these leave the range of numbers
    now = scaled(now);
    wanted = scaled(wanted);
    size = now.norm() * wanted.norm();
  }
  const double cosine = now.dot(wanted);
  if (!(cosine > 0.9999 * size)) return;
  const Vector3d axis = now.cross(wanted);
  const Quaterniond turn(size + cosine, axis.x(), axis.y(), axis.z());
  body.q_WB = (turn * body.q_WB).normalized();
}

}  // namespace rigid_body_sim

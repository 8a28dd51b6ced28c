#pragma once

#include <cmath>

#include "rigid_body_sim/conventions.hpp"

namespace rigid_body_sim {

/// Cosine and sine of half an angle: the rotation about a known axis.
struct HalfAngle {
  double cos = 1;
  double sin = 0;
};

/// cos(x) and sin(x)/x for x^2 >= 0.
/// Below x^2 = 0.1 the Taylor polynomials, whose first term left out is at most 1.2e-18
/// and 7.6e-20: no square root, no trigonometric call, and full accuracy at x = 0.
struct CosSinc {
  double cos;
  double sinc;

  explicit CosSinc(double x2) {
    if (x2 < 0.1) {
      cos = 1 - x2 * (1.0 / 2) *
                    (1 - x2 * (1.0 / 12) *
                             (1 - x2 * (1.0 / 30) *
                                      (1 - x2 * (1.0 / 56) *
                                               (1 - x2 * (1.0 / 90) * (1 - x2 * (1.0 / 132))))));
      sinc = 1 - x2 * (1.0 / 6) *
                     (1 - x2 * (1.0 / 20) *
                              (1 - x2 * (1.0 / 42) *
                                       (1 - x2 * (1.0 / 72) *
                                                (1 - x2 * (1.0 / 110) * (1 - x2 * (1.0 / 156))))));
    } else {
      const double x = std::sqrt(x2);
      cos = std::cos(x);
      sinc = std::sin(x) / x;
    }
  }
};

/// Half of the rotation by `angle` [rad].
inline HalfAngle halfAngle(double angle) {
  const double x = 0.5 * angle;
  const CosSinc f(x * x);
  return {f.cos, x * f.sinc};
}

/// Rotation by the vector r [rad], [cos |r|/2, sin(|r|/2) r/|r|] (founding text, section 6).
inline Quaterniond rotationExp(const Vector3d& r) {
  const CosSinc f(0.25 * r.squaredNorm());
  const Vector3d v = (0.5 * f.sinc) * r;
  return {f.cos, v.x(), v.y(), v.z()};
}

/// Rotation vector of q [rad], at most pi long.
inline Vector3d rotationLog(const Quaterniond& q) {
  const double s = q.vec().norm();
  if (s == 0) return Vector3d::Zero();
  const double angle = 2 * std::atan2(s, std::abs(q.w()));
  return (std::copysign(angle, q.w()) / s) * q.vec();
}

/// Brings q, already within rounding of unit length, back to it by one Newton step of 1/sqrt:
/// no square root, no division. The step's residual is of the order of the rounding it removes.
inline Quaterniond renormalized(const Quaterniond& q) {
  return Quaterniond(Eigen::Vector4d((1.5 - 0.5 * q.squaredNorm()) * q.coeffs()));
}

}  // namespace rigid_body_sim

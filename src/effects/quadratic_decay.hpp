#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <cmath>

#include "rigid_body_sim/column_pointers.hpp"

// Motions that quadratic drag slows down, u' = -c |u| A u: u is a velocity through the air, A the
// inverse mass or inertia, positive definite. All factors lie between 0 and 1 whatever c: no step
// turns a velocity round or adds energy.
namespace rigid_body_sim {

/// What is left of u after h, if A is a number: exactly 1 / (1 + c |u| A h).
inline double quadraticDecay(double c_speed_A_h) { return 1 / (1 + c_speed_A_h); }

/// s = integral of c |u| dt over h, with which u falls along each principal axis of A exactly by
/// exp(-a_i s). For |u| that falls by the rate it has at the beginning, ln(1 + a c |u| h) / a with
/// a = u.A u / |u|^2: wrong by terms of h^3, and exact where A acts on u as a number. |u| falls
/// slower and slower, so in long steps s is too small rather than too large.
/// @param along principal axes; not zero
inline double decayPath(const Vector3d& u, double speed, const Vector3d& A, double c_h) {
  const double a = (u / speed).cwiseAbs2().dot(A);
  return std::log1p(a * c_h * speed) / a;
}

/// Momentum after h of the drag -c |u| u, u = P / m - wind. Exact.
inline Triple brakedMomentum(const Triple& P_W, double mass, const Triple& wind_W, double c_h) {
  const Triple at_rest = mass * wind_W;  // in the air
  const Triple through_air = P_W - at_rest;
  const double speed = std::sqrt(dot(through_air, through_air)) / mass;
  return at_rest + quadraticDecay(c_h * speed / mass) * through_air;
}

inline Vector3d brakedMomentum(const Vector3d& P_W, double mass, const Vector3d& wind_W,
                               double c_h) {
  return brakedMomentum(Triple(P_W), mass, Triple(wind_W), c_h).vector();
}

/// The same of a body with the inverse mass matrix A_B. Second order.
inline Vector3d brakedMomentum(const Vector3d& P_W, const Matrix3d& A_B, const Quaterniond& q_WB,
                               const Vector3d& wind_W, double c_h) {
  const Eigen::SelfAdjointEigenSolver<Matrix3d> axes(A_B);
  const Quaterniond q_BW = q_WB.conjugate();
  const Matrix3d& V = axes.eigenvectors();
  const Vector3d wind = V.transpose() * (q_BW * wind_W);
  const Vector3d A = axes.eigenvalues();
  const Vector3d u = A.cwiseProduct(V.transpose() * (q_BW * P_W)) - wind;
  const double speed = u.norm();
  if (speed == 0) return P_W;
  const double s = decayPath(u, speed, A, c_h);
  const Vector3d left = u.array() * (-s * A.array()).exp();
  return q_WB * (V * (wind + left).cwiseQuotient(A));
}

/// Angular momentum after h of the torque -c |w| w, for principal moments I. Exact for spheres,
/// second order else.
inline Vector3d brakedSpin(const Vector3d& L_W, const Vector3d& I, const Quaterniond& q_WB,
                           double c_h) {
  if (I(0) == I(2)) return quadraticDecay(c_h * (L_W.norm() / I(0)) / I(0)) * L_W;
  const Vector3d A = I.cwiseInverse();
  const Vector3d L_B = q_WB.conjugate() * L_W;
  const Vector3d w = L_B.cwiseProduct(A);
  const double speed = w.norm();
  if (speed == 0) return L_W;
  const double s = decayPath(w, speed, A, c_h);
  return q_WB * Vector3d(L_B.array() * (-s * A.array()).exp());
}

/// The fastest rate [1/s] at which a small change of u dies away: the largest eigenvalue of
/// A d(c |u| u)/du = c A (|u| + u u^T / |u|); 2 c |u| A if A is a number.
inline double fastestDecay(const Vector3d& u, const Matrix3d& A, double c) {
  const double speed = u.norm();
  if (speed == 0) return 0;
  const Matrix3d slope = speed * Matrix3d::Identity() + u * (u / speed).transpose();
  const Matrix3d root = A.llt().matrixL();  // root^T slope root has the same eigenvalues
  const Matrix3d similar = root.transpose() * slope * root;
  return c *
         Eigen::SelfAdjointEigenSolver<Matrix3d>(similar, Eigen::EigenvaluesOnly).eigenvalues()(2);
}

}  // namespace rigid_body_sim

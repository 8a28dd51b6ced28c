#pragma once

#include <Eigen/Eigenvalues>
#include <cmath>

#include "rigid_body_sim/conventions.hpp"

namespace rigid_body_sim {

/// The fastest small swing [rad/s] of a free body whose vector m_B, fixed to it, is drawn to a
/// direction fixed in the world with the torque |m| b sin(angle): a dipole in a field, an arm with
/// a constant force at its end. Aligned, the torque on a small turn e is b/|m| (m m^T - |m|^2) e,
/// so that the square of the rate is the largest eigenvalue of that matrix, negated, against the
/// tensor. Turns about m do not count, however small their moment is.
inline double alignmentRate(const Vector3d& m_B, double b, const Vector3d& I_BBcm_B) {
  const double m = m_B.norm();
  const Matrix3d stiffness = b / m * (m * m * Matrix3d::Identity() - m_B * m_B.transpose());
  const Vector3d scale = I_BBcm_B.cwiseSqrt().cwiseInverse();
  const Matrix3d ratio = scale.asDiagonal() * stiffness * scale.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Matrix3d> solver(ratio, Eigen::EigenvaluesOnly);
  return std::sqrt(solver.eigenvalues()(2));
}

}  // namespace rigid_body_sim

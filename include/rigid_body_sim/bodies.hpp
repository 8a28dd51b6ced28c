#pragma once

#include "rigid_body_sim/body_state.hpp"

namespace rigid_body_sim {

/// One 3-vector a body. Stored column by column (Eigen's default), that is as a structure of
/// arrays: the x of all bodies, then the y, then the z.
using Column3 = Eigen::Matrix<double, Eigen::Dynamic, 3>;

/// One quaternion a body, columns in the order of Eigen's coeffs(): x, y, z, w.
using ColumnQ = Eigen::Matrix<double, Eigen::Dynamic, 4>;

/// One rotation matrix a body, or another 3 x 3 one, stored column by column: element (r, c) is in
/// column 3 c + r.
using ColumnR = Eigen::Matrix<double, Eigen::Dynamic, 9>;

/// All bodies of a simulation; row i of every member belongs to body i. B is the frame of principal
/// axes at the centre of mass.
struct Bodies {
  // Constants.
  Eigen::VectorXd mass;  ///< [kg]
  Column3 I_BBcm_B;      ///< principal moments I1 <= I2 <= I3 [kg m^2]
  /// Inverse of the mass matrix in B [1/kg], where a body carries added mass along: v = R A R^T P.
  /// Without rows, where none does: v = P / m.
  ColumnR inverse_mass_B;

  // State, see BodyState.
  Column3 p_WBcm;    ///< [m]
  ColumnQ q_WB;      ///< unit
  Column3 P_WB;      ///< [kg m/s]
  Column3 L_WBcm_W;  ///< [kg m^2/s]
  Column3 p_low;     ///< [m]

  Bodies() = default;
  explicit Bodies(Eigen::Index count)
      : mass(count),
        I_BBcm_B(count, 3),
        p_WBcm(count, 3),
        q_WB(count, 4),
        P_WB(count, 3),
        L_WBcm_W(count, 3),
        p_low(Column3::Zero(count, 3)) {}

  Eigen::Index count() const { return mass.size(); }
  bool hasAddedMass() const { return inverse_mass_B.rows() > 0; }

  /// Whether body i does: one that does not flies as if none did, to the bit.
  bool carries(Eigen::Index i) const {
    if (!hasAddedMass()) return false;
    const double own = 1 / mass(i);
    for (const int k : {0, 4, 8})
      if (inverse_mass_B(i, k) != own) return true;
    for (const int k : {1, 2, 5})
      if (inverse_mass_B(i, k) != 0) return true;
    return false;
  }

  /// Of body i; the others have their own mass alone.
  void setInverseMass(Eigen::Index i, const Matrix3d& A_B) {
    if (!hasAddedMass()) {
      inverse_mass_B.setZero(count(), 9);
      for (const int k : {0, 4, 8}) inverse_mass_B.col(k) = mass.cwiseInverse();
    }
    inverse_mass_B.row(i) = Eigen::Map<const Eigen::Matrix<double, 1, 9>>(A_B.data());
  }

  /// Velocity of the centre of mass [m/s], in W.
  Vector3d v_WBcm(Eigen::Index i) const { return velocityFor(i, P_WB.row(i)); }

  /// The velocity that body i has with the momentum P [kg m/s], at its present attitude.
  Vector3d velocityFor(Eigen::Index i, const Vector3d& P) const {
    if (!carries(i)) return P / mass(i);
    const Quaterniond q(Eigen::Vector4d(q_WB.row(i)));
    const Eigen::Matrix<double, 9, 1> A = inverse_mass_B.row(i);
    return q * (Eigen::Map<const Matrix3d>(A.data()) * (q.conjugate() * P));
  }

  BodyState state(Eigen::Index i) const {
    return {p_WBcm.row(i), Quaterniond(Eigen::Vector4d(q_WB.row(i))), P_WB.row(i), L_WBcm_W.row(i),
            p_low.row(i)};
  }

  void setState(Eigen::Index i, const BodyState& state) {
    p_WBcm.row(i) = state.p_WBcm;
    q_WB.row(i) = state.q_WB.coeffs();
    P_WB.row(i) = state.P_WB;
    L_WBcm_W.row(i) = state.L_WBcm_W;
    p_low.row(i) = state.p_low;
  }

  Vector3d moments(Eigen::Index i) const { return I_BBcm_B.row(i); }
};

}  // namespace rigid_body_sim

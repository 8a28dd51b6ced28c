#pragma once

#include "rigid_body_sim/bodies.hpp"

namespace rigid_body_sim {

/// All bodies at one instant, as effects see them. What several effects need of the state is worked
/// out once, for all bodies, when the first of them asks for it.
class Instant {
 public:
  Instant() = default;
  Instant(const Bodies& bodies, double time_s) { set(bodies, time_s); }

  /// Another instant, in the same memory.
  void set(const Bodies& bodies, double time_s);

  /// Momenta or positions have changed, but no attitude.
  void forgetVelocities() { has_v_ = has_w_ = false; }

  const Bodies& bodies() const { return *bodies_; }
  double time_s() const { return time_s_; }

  /// Velocities of the centres of mass [m/s], in W.
  const Column3& v_WBcm() const;

  /// Rotation matrices; R(r, c) of body i is R_WB()(i, 3 c + r).
  const ColumnR& R_WB() const;

  /// Angular velocities [rad/s], in W.
  const Column3& w_WB() const;

  Matrix3d R_WB(Eigen::Index i) const {
    return Eigen::Map<const Matrix3d>(Eigen::Matrix<double, 9, 1>(R_WB().row(i)).data());
  }

 private:
  const Bodies* bodies_ = nullptr;
  double time_s_ = 0;
  mutable Column3 v_WBcm_, w_WB_;
  mutable ColumnR R_WB_;
  mutable bool has_v_ = false, has_w_ = false, has_R_ = false;
};

}  // namespace rigid_body_sim

#include "reference/free_rotation.hpp"

#include <cmath>
#include <stdexcept>

namespace rigid_body_sim::reference {
namespace {

using Real = long double;
using Vector3r = Eigen::Matrix<Real, 3, 1>;
using Quaternionr = Eigen::Quaternion<Real>;

Quaternionr turnBy(const Vector3r& r) {
  const Real angle = r.norm();
  if (angle == 0) return Quaternionr::Identity();
  const Vector3r v = std::sin(angle / 2) / angle * r;
  return {std::cos(angle / 2), v.x(), v.y(), v.z()};
}

/// Index of the moment that differs from the other two.
int axisOfSymmetry(const Vector3d& I) {
  for (int i = 0; i < 3; ++i)
    if (I((i + 1) % 3) == I((i + 2) % 3)) return i;
  throw std::invalid_argument("no two principal moments are equal");
}

}  // namespace

Rotation symmetricTop(const Vector3d& I_BBcm_B, const Rotation& start, double time_s) {
  const int axis = axisOfSymmetry(I_BBcm_B);
  const Real along = I_BBcm_B(axis);
  const Real across = I_BBcm_B((axis + 1) % 3);
  const Real t = time_s;
  const Quaternionr q0 = start.q_WB.cast<Real>().normalized();
  const Vector3r L_B = I_BBcm_B.cast<Real>().cwiseProduct(start.w_WB_B.cast<Real>());
  const Vector3r L_W = q0 * L_B;
  const Vector3r own_turn =
      t * (across - along) / (along * across) * L_B(axis) * Vector3r::Unit(axis);
  const Quaternionr q = (turnBy(t / across * L_W) * q0 * turnBy(own_turn)).normalized();
  const Vector3r w = (q.conjugate() * L_W).cwiseQuotient(I_BBcm_B.cast<Real>());
  return {q.cast<double>(), w.cast<double>()};
}

}  // namespace rigid_body_sim::reference

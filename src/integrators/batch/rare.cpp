#include "integrators/batch/rare.hpp"

#include <Eigen/Geometry>
#include <cmath>

namespace rigid_body_sim::batch {

void sinCosOfHuge(double x, double* sin, double* cos) {
  *sin = std::sin(x);
  *cos = std::cos(x);
}

void momentumInBody(const double* q_WB, const double* L_W, double* m_B) {
  using Real = long double;
  const Eigen::Quaternion<Real> q =
      Eigen::Quaterniond(Eigen::Map<const Eigen::Vector4d>(q_WB)).cast<Real>().normalized();
  const Eigen::Vector3d L(Eigen::Map<const Eigen::Vector3d>(L_W, 3));
  Eigen::Map<Eigen::Vector3d>(m_B, 3) = (q.conjugate() * L.cast<Real>()).cast<double>();
}

}  // namespace rigid_body_sim::batch

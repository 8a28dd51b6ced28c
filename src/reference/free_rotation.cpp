#include "reference/free_rotation.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

namespace rigid_body_sim::reference {
namespace {

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

constexpr int kOrder = 30;

/// Taylor coefficients of momentum in body axes and attitude (w, x, y, z).
struct Series {
  std::array<std::array<Real, kOrder + 1>, 3> m;
  std::array<std::array<Real, kOrder + 1>, 4> q;
};

template <class Coefficients>
Real convolution(const Coefficients& a, const Coefficients& b, int n) {
  Real sum = 0;
  for (int j = 0; j <= n; ++j) sum += a[j] * b[n - j];
  return sum;
}

Series seriesOf(const Vector3r& I, const Vector3r& m, const Quaternionr& q) {
  Series s;
  std::array<std::array<Real, kOrder + 1>, 3> w;
  for (int i = 0; i < 3; ++i) s.m[i][0] = m(i);
  s.q[0][0] = q.w();
  for (int i = 0; i < 3; ++i) s.q[i + 1][0] = q.vec()(i);
  for (int n = 0; n < kOrder; ++n) {
    for (int i = 0; i < 3; ++i) w[i][n] = s.m[i][n] / I(i);
    Real turn = 0;
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3, k = (i + 2) % 3;
      s.m[i][n + 1] = (convolution(s.m[j], w[k], n) - convolution(s.m[k], w[j], n)) / (n + 1);
      s.q[i + 1][n + 1] = (convolution(s.q[0], w[i], n) + convolution(s.q[j + 1], w[k], n) -
                           convolution(s.q[k + 1], w[j], n)) /
                          (2 * (n + 1));
      turn -= convolution(s.q[i + 1], w[i], n);
    }
    s.q[0][n + 1] = turn / (2 * (n + 1));
  }
  return s;
}

Real at(const std::array<Real, kOrder + 1>& coefficients, Real t) {
  Real sum = 0;
  for (int n = kOrder; n >= 0; --n) sum = sum * t + coefficients[n];
  return sum;
}

/// Rate [rad/s] at which the momentum swings around the smallest or the largest axis: that of the
/// elliptic functions of Jacobi's solution, whose poles limit the series.
Real swing(const Vector3r& I, const Vector3r& m) {
  const Real a12 = 1 / I(0) - 1 / I(1), a23 = 1 / I(1) - 1 / I(2);
  const Vector3r m2 = m.cwiseProduct(m);
  const bool is_around_1 = m2(0) * a12 > m2(2) * a23;
  const Real W = m2(1) * (is_around_1 ? a23 : a12) + m2(is_around_1 ? 0 : 2) * (a12 + a23);
  return std::sqrt(std::abs((is_around_1 ? a12 : a23) * W));
}

}  // namespace

std::vector<Quaternionr> freeAttitudes(const Vector3d& I_BBcm_B, const Quaterniond& q_WB,
                                       const Vector3d& L_W, double interval_s, int count) {
  const Vector3r I = I_BBcm_B.cast<Real>();
  Quaternionr q = q_WB.cast<Real>().normalized();
  Vector3r m = q.conjugate() * L_W.cast<Real>();
  const Real rate = m.cwiseQuotient(I).norm() + swing(I, m);
  const int steps = std::max(1, static_cast<int>(std::ceil(rate * Real(interval_s) / Real(0.4))));
  std::vector<Quaternionr> attitudes = {q};
  for (int sample = 1; sample <= count; ++sample) {
    for (int i = 0; i < steps; ++i) {
      const Series s = seriesOf(I, m, q);
      const Real h = Real(interval_s) / steps;
      m = {at(s.m[0], h), at(s.m[1], h), at(s.m[2], h)};
      q = Quaternionr(at(s.q[0], h), at(s.q[1], h), at(s.q[2], h), at(s.q[3], h)).normalized();
    }
    attitudes.push_back(q);
  }
  return attitudes;
}

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

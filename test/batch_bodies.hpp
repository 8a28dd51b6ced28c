#pragma once

// Bodies of every kind for the batch kernels, and what the tests do with them.
#include <algorithm>
#include <vector>

#include "generic.hpp"
#include "integrators/batch/kernels.hpp"

namespace rigid_body_sim::batch {

inline BodyColumns columnsOf(Bodies& bodies) {
  return {bodies.count(),     bodies.mass.data(), bodies.I_BBcm_B.data(), bodies.p_WBcm.data(),
          bodies.q_WB.data(), bodies.P_WB.data(), bodies.L_WBcm_W.data(), bodies.p_low.data()};
}

struct Pushes {
  Column3 f_W, t_Bcm_W;
  explicit Pushes(Eigen::Index count) : f_W(count, 3), t_Bcm_W(count, 3) {}
};

inline WrenchColumns columnsOf(const Pushes& pushes) {
  return {pushes.f_W.rows(), pushes.f_W.data(), pushes.t_Bcm_W.data()};
}

/// Moments of random bodies, some of them of a special kind.
inline Vector3d someMoments(Sampler& sample, Eigen::Index kind) {
  Vector3d I(1 + 0.2 * sample.number(), 1.5 + 0.2 * sample.number(), 2 + 0.2 * sample.number());
  if (kind == 1) I.setConstant(1.3);
  if (kind == 2) I(1) = I(0);
  if (kind == 3) I(1) = I(2);
  if (kind == 4) I(0) = 1e-6;
  if (kind == 5) I *= 1e-160;
  if (kind == 6) I *= 1e160;
  if (kind == 7) I << 1, 1 + 1e-15, 1 + 3e-15;
  return I;
}

/// Rates that go with them: still, hardly, slow, fast, or about one axis.
inline Vector3d someRates(Sampler& sample, Eigen::Index kind) {
  const Vector3d w = 2 * sample.vector();
  if (kind == 1) return Vector3d::Zero();
  if (kind == 2) return 40 * w;
  if (kind == 3) return 1e-9 * w;
  if (kind == 4) return {0, w(1), 0};
  if (kind == 5) return {w(0), 0, w(2)};
  if (kind == 6) return {1e-310, 0, -1e-310};
  if (kind == 7) return 3e8 * w;
  return w;
}

/// `count` bodies from the `first` one of an endless row of them.
inline Bodies someBodies(Eigen::Index count, Eigen::Index first = 0) {
  Bodies bodies(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const Eigen::Index k = first + i;
    Sampler sample(static_cast<std::uint32_t>(k + 1));
    bodies.mass(i) = 1.5 + sample.number();
    bodies.I_BBcm_B.row(i) = someMoments(sample, k % 13);
    BodyState state;
    state.p_WBcm = sample.vector();
    state.q_WB = sample.attitude();
    state.P_WB = sample.vector();
    state.L_WBcm_W = state.q_WB * bodies.moments(i).cwiseProduct(someRates(sample, k / 3 % 11));
    if (k % 11 == 10) state.L_WBcm_W(k % 3) = kNaN;
    bodies.setState(i, state);
  }
  return bodies;
}

/// Wrenches on them, of their own size; some have no torque.
inline Pushes somePushes(Eigen::Index count, Eigen::Index first = 0) {
  Pushes pushes(count);
  const Bodies bodies = someBodies(count, first);
  for (Eigen::Index i = 0; i < count; ++i) {
    const Eigen::Index k = first + i;
    Sampler sample(static_cast<std::uint32_t>(1000 + k));
    pushes.f_W.row(i) = sample.vector();
    pushes.t_Bcm_W.row(i) = 0.1 * bodies.I_BBcm_B(i, 2) * sample.vector();
    if (k % 4 == 1) pushes.t_Bcm_W.row(i).setZero();
  }
  return pushes;
}

/// True if both have the same bits, but that one NaN is as good as another.
inline bool sameNumbers(const double* a, const double* b, Eigen::Index count) {
  for (Eigen::Index i = 0; i < count; ++i)
    if (!(std::isnan(a[i]) && std::isnan(b[i])) && std::memcmp(a + i, b + i, sizeof(double)) != 0)
      return false;
  return true;
}
template <class Matrix>
bool sameNumbers(const Matrix& a, const Matrix& b) {
  return a.rows() == b.rows() && sameNumbers(a.data(), b.data(), a.size());
}
inline bool sameNumbers(const Bodies& a, const Bodies& b) {
  return sameNumbers(a.p_WBcm, b.p_WBcm) && sameNumbers(a.q_WB, b.q_WB) &&
         sameNumbers(a.P_WB, b.P_WB) && sameNumbers(a.L_WBcm_W, b.L_WBcm_W) &&
         sameNumbers(a.p_low, b.p_low);
}

}  // namespace rigid_body_sim::batch

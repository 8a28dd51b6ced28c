#pragma once

#include "integrators/batch/rk4.hpp"

// The method of rk4.cpp where the wrenches of all four stages are the same: one pass, and the bits
// that stage after stage would give.
namespace rigid_body_sim::batch {
namespace {

/// afterStep() with the same at all stages: doubling is exact, and 2 k + 4 k rounds as 6 k does.
template <class S>
RBS_INLINE Vector<S> afterSteadyStep(const Vector<S>& v, const Vector<S>& k, double h) {
  return v + (h / 6) * (6.0 * k);
}

/// Momentum's rate at a stage, to which the body turned by `turn` [rad] from the step's start.
/// @tparam has_torque false: t0_B is zero, and no stage needs an attitude
template <bool gyroscopic, bool has_torque, class S>
RBS_INLINE Vector<S> rateAtStage(const Vector<S>& m_B, const Vector<S>& w_B, const Vector<S>& t0_B,
                                 const Vector<S>& turn) {
  if constexpr (!has_torque) return momentumRate<gyroscopic>(m_B, w_B, t0_B);
  return momentumRate<gyroscopic>(m_B, w_B, rotatedBack(rotationExp(turn), t0_B));
}

/// The rotation over a step under the torque t_W.
template <bool gyroscopic, bool has_torque, class S>
RBS_INLINE Rotation<S> rk4Rotation(const Rotation<S>& before, const Vector<S>& I,
                                   const Vector<S>& t_W, double h) {
  const Vector<S> a = {1 / I.x, 1 / I.y, 1 / I.z};
  const Vector<S> t0_B = has_torque ? torqueAtStart(before.q_WB, t_W) : t_W;
  const Vector<S> m1 = rotatedBack(before.q_WB, before.L_W), w1 = product(a, m1);
  const Vector<S> k1 = momentumRate<gyroscopic>(m1, w1, t0_B);
  const Vector<S> m2 = m1 + (0.5 * h) * k1, w2 = product(a, m2);
  const Vector<S> k2 = rateAtStage<gyroscopic, has_torque>(m2, w2, t0_B, (0.5 * h) * w1);
  const Vector<S> m3 = m1 + (0.5 * h) * k2, w3 = product(a, m3);
  const Vector<S> k3 = rateAtStage<gyroscopic, has_torque>(m3, w3, t0_B, turnToThird(w1, w2, h));
  const Vector<S> m4 = m1 + h * k3, w4 = product(a, m4);
  const Vector<S> k4 = rateAtStage<gyroscopic, has_torque>(m4, w4, t0_B, h * w3);
  const Vector<S> turn = turnToEnd(w1, w2 + w3, w4, h);
  const Vector<S> m_B = afterStep(m1, k1, k2 + k3, k4, h);
  return rotationAfter<gyroscopic>(before.q_WB, turn, m1, m_B, afterSteadyStep(before.L_W, t_W, h));
}

/// Positions and linear momenta under the force f_W.
template <class Place, class S>
RBS_INLINE void rk4Path(const Place& at, const BodyColumns& bodies, const Vector<S>& f_W,
                        double h) {
  const std::ptrdiff_t n = bodies.stride;
  const Vector<S> P = loadVector(at, bodies.P_WB, n);
  move(at, bodies, (h * (1 / at.load(bodies.mass))) * (P + (h / 6) * (3.0 * f_W)));
  storeVector(at, bodies.P_WB, n, afterSteadyStep(P, f_W, h));
}

/// @param by null: nothing acts
template <class S, bool gyroscopic>
void rk4Steady(const BodyColumns& of, const WrenchColumns* by, double h, Range range) {
  const BodyColumns bodies = of;
  const WrenchColumns wrenches = by ? *by : WrenchColumns{};
  forPacks<S>(range.begin, range.end, [=](const auto& at) {
    using T = NumberOf<decltype(at)>;
    const std::ptrdiff_t n = bodies.stride;
    Vector<T> t_W = {T(0.0), T(0.0), T(0.0)};
    if (wrenches.f_W) {
      t_W = loadVector(at, wrenches.t_Bcm_W, wrenches.stride);
      rk4Path(at, bodies, loadVector(at, wrenches.f_W, wrenches.stride), h);
    } else {
      driftPosition(at, bodies, loadVector(at, bodies.P_WB, n), h);
    }
    const Rotation<T> before = {loadQuaternion(at, bodies.q_WB, n),
                                loadVector(at, bodies.L_WBcm_W, n)};
    const bool is_torque_free = all(isZero(t_W));
    if (is_torque_free && all(isZero(before.L_W)))
      return storeVector(at, bodies.L_WBcm_W, n, afterSteadyStep(before.L_W, t_W, h));
    const Vector<T> I = loadVector(at, bodies.I_BBcm_B, n);
    const Rotation<T> after = is_torque_free ? rk4Rotation<gyroscopic, false>(before, I, t_W, h)
                                             : rk4Rotation<gyroscopic, true>(before, I, t_W, h);
    storeQuaternion(at, bodies.q_WB, n, after.q_WB);
    storeVector(at, bodies.L_WBcm_W, n, after.L_W);
  });
}

}  // namespace
}  // namespace rigid_body_sim::batch

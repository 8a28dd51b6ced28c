#pragma once

#include "integrators/batch/rk4.hpp"

// The method of rk4.cpp where the wrenches of all four stages are the same: one pass, and the bits
// that stage after stage would give.
namespace rigid_body_sim::batch {
namespace {

/// The rotation over a step under the torque t_W.
/// @tparam turns_torque false: t_W is zero, and no stage needs an attitude
template <bool gyroscopic, bool turns_torque, class S>
RBS_INLINE Rotation<S> rk4Rotation(const Rotation<S>& before, const Vector<S>& I,
                                   const Vector<S>& t_W, double h) {
  const Vector<S> a = {1 / I.x, 1 / I.y, 1 / I.z};
  const auto rate = [&](const Vector<S>& m_B, const Vector<S>& w_B, const Vector<S>& turn) {
    if constexpr (!turns_torque) return momentumRate<gyroscopic>(m_B, w_B, t_W);
    const Quaternion<S> q_WB = before.q_WB * rotationExp(turn);
    return momentumRate<gyroscopic>(m_B, w_B, torqueInBody(q_WB, t_W));
  };
  const Vector<S> m1 = rotatedBack(before.q_WB, before.L_W), w1 = product(a, m1);
  const Vector<S> k1 =
      momentumRate<gyroscopic>(m1, w1, turns_torque ? torqueInBody(before.q_WB, t_W) : t_W);
  const Vector<S> m2 = m1 + (0.5 * h) * k1, w2 = product(a, m2);
  const Vector<S> k2 = rate(m2, w2, (0.5 * h) * w1);
  const Vector<S> m3 = m1 + (0.5 * h) * k2, w3 = product(a, m3);
  const Vector<S> k3 = rate(m3, w3, (0.5 * h) * w2 + (h * h / 8) * cross(w1, w2));
  const Vector<S> m4 = m1 + h * k3, w4 = product(a, m4);
  const Vector<S> k4 = rate(m4, w4, h * w3);
  const double sixth = h / 6;
  const Vector<S> turn = sixth * (w1 + 2 * w2 + 2 * w3 + w4) + (h * h / 12) * cross(w1, w4);
  const Vector<S> m_B = m1 + sixth * (k1 + 2 * k2 + 2 * k3 + k4);
  const Vector<S> L_W = before.L_W + sixth * (t_W + 2 * t_W + 2 * t_W + t_W);
  return rotationAfter<gyroscopic>(before, turn, m_B, L_W);
}

/// Positions and linear momenta under the force f_W.
template <class Place, class S>
RBS_INLINE void rk4Path(const Place& at, const BodyColumns& bodies, const Vector<S>& f_W,
                        double h) {
  const std::ptrdiff_t n = bodies.stride;
  const double sixth = h / 6;
  const Vector<S> P = loadVector(at, bodies.P_WB, n);
  move(at, bodies, (h * (1 / at.load(bodies.mass))) * (P + sixth * (f_W + f_W + f_W)));
  storeVector(at, bodies.P_WB, n, P + sixth * (f_W + 2 * f_W + 2 * f_W + f_W));
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
      return storeVector(at, bodies.L_WBcm_W, n, before.L_W + t_W);  // -0 becomes 0, as elsewhere
    const Vector<T> I = loadVector(at, bodies.I_BBcm_B, n);
    const Rotation<T> after = is_torque_free ? rk4Rotation<gyroscopic, false>(before, I, t_W, h)
                                             : rk4Rotation<gyroscopic, true>(before, I, t_W, h);
    storeQuaternion(at, bodies.q_WB, n, after.q_WB);
    storeVector(at, bodies.L_WBcm_W, n, after.L_W);
  });
}

}  // namespace
}  // namespace rigid_body_sim::batch

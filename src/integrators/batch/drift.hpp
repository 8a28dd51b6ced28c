#pragma once

#include "integrators/batch/columns.hpp"
#include "integrators/batch/vectors.hpp"

// Kicks and drifts, see kick.hpp and drift.hpp beside this folder.
namespace rigid_body_sim::batch {
namespace {

/// v += h f of three columns.
template <class Place>
RBS_INLINE auto kicked(const Place& at, double* columns, std::ptrdiff_t stride, const double* rates,
                       std::ptrdiff_t rate_stride, double h) {
  const auto v = loadVector(at, columns, stride) + h * loadVector(at, rates, rate_stride);
  storeVector(at, columns, stride, v);
  return v;
}

/// As rigid_body_sim::move().
template <class Place, class S>
RBS_INLINE void move(const Place& at, const BodyColumns& bodies, const Vector<S>& way) {
  const std::ptrdiff_t n = bodies.stride;
  const Vector<S> p = loadVector(at, bodies.p_WBcm, n);
  const Vector<S> all = loadVector(at, bodies.p_low, n) + way;
  const Vector<S> sum = p + all;
  const Vector<S> added = sum - p;
  storeVector(at, bodies.p_low, n, (p - (sum - added)) + (all - added));
  storeVector(at, bodies.p_WBcm, n, sum);
}

/// A number times zero is zero, but for what is not finite.
template <class S>
bool areFinite(const BodyColumns& of, Range range) {
  const BodyColumns bodies = of;
  bool are = true;
  forPacks<S>(range.begin, range.end, [&](const auto& at) {
    const std::ptrdiff_t n = bodies.stride;
    const auto p = loadVector(at, bodies.p_WBcm, n), P = loadVector(at, bodies.P_WB, n),
               L = loadVector(at, bodies.L_WBcm_W, n);
    const auto q = loadQuaternion(at, bodies.q_WB, n);
    const auto zero = 0.0 * p.x + 0.0 * p.y + 0.0 * p.z + (0.0 * P.x + 0.0 * P.y + 0.0 * P.z) +
                      (0.0 * L.x + 0.0 * L.y + 0.0 * L.z) +
                      (0.0 * q.x + 0.0 * q.y + 0.0 * q.z + 0.0 * q.w);
    are = are & all(zero == 0);
  });
  return are;
}

template <class S>
void kick(const BodyColumns& to, const WrenchColumns& by, double h, Range range) {
  const BodyColumns bodies = to;  // a copy, which no store can change
  const WrenchColumns wrenches = by;
  forPacks<S>(range.begin, range.end, [=](const auto& at) {
    kicked(at, bodies.P_WB, bodies.stride, wrenches.f_W, wrenches.stride, h);
    kicked(at, bodies.L_WBcm_W, bodies.stride, wrenches.t_Bcm_W, wrenches.stride, h);
  });
}

template <class Place, class S>
RBS_INLINE void driftPosition(const Place& at, const BodyColumns& bodies, const Vector<S>& P_WB,
                              double h) {
  move(at, bodies, (h / at.load(bodies.mass)) * P_WB);
}

template <class S>
void driftPositions(const BodyColumns& bodies, double h, Range range) {
  forPacks<S>(range.begin, range.end, [&](const auto& at) {
    driftPosition(at, bodies, loadVector(at, bodies.P_WB, bodies.stride), h);
  });
}

/// The attitude after h [s] at the constant rate of the beginning, w = R I^-1 R^T L.
struct ConstantRate {
  template <class S>
  RBS_INLINE Quaternion<S> operator()(const Quaternion<S>& q_WB, const Vector<S>& L_W,
                                      const Vector<S>& I, double h) const {
    return renormalized(q_WB * rotationExp(h * quotient(rotatedBack(q_WB, L_W), I)));
  }
};

/// The same by the splitting explained in split2.cpp.
struct Split {
  template <class S>
  RBS_INLINE Quaternion<S> operator()(const Quaternion<S>& q_WB, const Vector<S>& L_W,
                                      const Vector<S>& I, double h) const {
    const S d1 = (I.y - I.x) / I.x / I.y;
    const S d3 = (I.y - I.z) / I.y / I.z;
    const Vector<S> m = rotatedBack(q_WB, L_W);
    const HalfAngle<S> first = halfAngle(0.5 * h * d3 * m.z);
    const S c = first.cos * first.cos - first.sin * first.sin;
    const S s = 2 * first.sin * first.cos;
    const S m1 = c * m.x + s * m.y;
    const S m2 = c * m.y - s * m.x;
    const HalfAngle<S> middle = halfAngle(h * d1 * m1);
    const S m3 = (middle.cos * middle.cos - middle.sin * middle.sin) * m.z -
                 2 * middle.sin * middle.cos * m2;
    const HalfAngle<S> last = halfAngle(0.5 * h * d3 * m3);

    const S cc = first.cos * last.cos - first.sin * last.sin;
    const S sc = first.cos * last.sin + first.sin * last.cos;
    const S cd = first.cos * last.cos + first.sin * last.sin;
    const S sd = first.sin * last.cos - first.cos * last.sin;
    const Quaternion<S> turn = {middle.sin * cd, middle.sin * sd, middle.cos * sc, middle.cos * cc};
    return renormalized(rotationExp((h / I.y) * L_W) * q_WB * turn);
  }
};

/// What may happen to the momenta before a drift.
enum class First { kNothing, kKick };

/// @param by of kKick; what it points to is not read with kNothing
template <class S, class Rotation, First first>
void drift(const BodyColumns& of, const WrenchColumns* by, double h, Range range) {
  const BodyColumns bodies = of;
  const WrenchColumns wrenches = first == First::kKick ? *by : WrenchColumns{};
  forPacks<S>(range.begin, range.end, [=](const auto& at) {
    const std::ptrdiff_t n = bodies.stride;
    auto P_WB = loadVector(at, bodies.P_WB, n);
    auto L_W = loadVector(at, bodies.L_WBcm_W, n);
    if constexpr (first == First::kKick) {
      P_WB = P_WB + h * loadVector(at, wrenches.f_W, wrenches.stride);
      L_W = L_W + h * loadVector(at, wrenches.t_Bcm_W, wrenches.stride);
      storeVector(at, bodies.P_WB, n, P_WB);
      storeVector(at, bodies.L_WBcm_W, n, L_W);
    }
    driftPosition(at, bodies, P_WB, h);
    // Without spin, as a point mass always is, the attitude stays the same to the bit.
    const auto is_still = isZero(L_W);
    if (all(is_still)) return;
    const auto q_WB = loadQuaternion(at, bodies.q_WB, n);
    const auto next = Rotation()(q_WB, L_W, loadVector(at, bodies.I_BBcm_B, n), h);
    storeQuaternion(at, bodies.q_WB, n, select(is_still, q_WB, next));
  });
}

/// Without w x I w the angular momentum keeps its components in the body's axes, and so does the
/// angular velocity, there and in the world.
template <class S>
void driftWithoutGyroscopicTerm(const BodyColumns& of, double h, Range range) {
  const BodyColumns bodies = of;
  forPacks<S>(range.begin, range.end, [=](const auto& at) {
    const std::ptrdiff_t n = bodies.stride;
    driftPosition(at, bodies, loadVector(at, bodies.P_WB, n), h);
    const auto L_W = loadVector(at, bodies.L_WBcm_W, n);
    const auto is_still = isZero(L_W);
    if (all(is_still)) return;
    const auto q_WB = loadQuaternion(at, bodies.q_WB, n);
    const auto m_B = rotatedBack(q_WB, L_W);
    const auto w_B = quotient(m_B, loadVector(at, bodies.I_BBcm_B, n));
    const auto next = renormalized(q_WB * rotationExp(h * w_B));
    storeQuaternion(at, bodies.q_WB, n, select(is_still, q_WB, next));
    storeVector(at, bodies.L_WBcm_W, n, select(is_still, L_W, rotated(next, m_B)));
  });
}

}  // namespace
}  // namespace rigid_body_sim::batch

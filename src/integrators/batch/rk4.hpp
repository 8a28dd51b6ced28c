#pragma once

#include "integrators/batch/aligned.hpp"
#include "integrators/batch/drift.hpp"
#include "integrators/batch/tiles.hpp"

// The method of rk4.cpp.
namespace rigid_body_sim::batch {
namespace {

/// Momentum's rate in body axes, m x w + t, the first term only with the gyroscopic effect.
template <bool gyroscopic, class S>
RBS_INLINE Vector<S> momentumRate(const Vector<S>& m_B, const Vector<S>& w_B,
                                  const Vector<S>& t_B) {
  if constexpr (gyroscopic) return cross(m_B, w_B) + t_B;
  return t_B;
}

/// A torque in the body axes of the step's start; none is +0 whatever the attitude, as where none
/// is computed. Stages turn it on from there.
template <class S>
RBS_INLINE Vector<S> torqueAtStart(const Quaternion<S>& q_WB, const Vector<S>& t_W) {
  const Vector<S> t_B = rotatedBack(q_WB, t_W);
  return {t_B.x + 0.0, t_B.y + 0.0, t_B.z + 0.0};
}

/// Turns of the body from the step's start [rad], in body axes: where the second stage's rate w2
/// leads the third stage, and where all four lead the end.
template <class S>
RBS_INLINE Vector<S> turnToThird(const Vector<S>& w1, const Vector<S>& w2, double h) {
  return (0.5 * h) * w2 + (h * h / 8) * cross(w1, w2);
}
template <class S>
RBS_INLINE Vector<S> turnToEnd(const Vector<S>& w1, const Vector<S>& w2_w3, const Vector<S>& w4,
                               double h) {
  return (h / 6) * ((w1 + w4) + 2 * w2_w3) + (h * h / 12) * cross(w1, w4);
}

/// v + h (k1 + 2 k2 + 2 k3 + k4) / 6, with k2_k3 the sum of those two.
template <class S>
RBS_INLINE Vector<S> afterStep(const Vector<S>& v, const Vector<S>& k1, const Vector<S>& k2_k3,
                               const Vector<S>& k4, double h) {
  return v + (h / 6) * ((k1 + k4) + 2 * k2_k3);
}

/// Attitude and angular momentum at the end of a step.
template <class S>
struct Rotation {
  Quaternion<S> q_WB;
  Vector<S> L_W;
};

/// The end of a step of which the momentum in body axes was m1_B at the start and is m_B, after the
/// body's `turn` [rad], in body axes.
template <bool gyroscopic, class S>
RBS_INLINE Rotation<S> rotationAfter(const Quaternion<S>& before, const Vector<S>& turn,
                                     const Vector<S>& m1_B, const Vector<S>& m_B,
                                     const Vector<S>& L_W) {
  const auto is_still = isZero(turn);
  const Quaternion<S> turned = before * rotationExp(turn);
  if constexpr (gyroscopic) return {select(is_still, before, aligned(turned, m1_B, m_B, L_W)), L_W};
  const Quaternion<S> q_WB = select(is_still, before, renormalized(turned));
  return {q_WB, rotated(q_WB, m_B)};
}

// Numbers in rk4's tiles.
enum Rk4Number {
  kInverseMass = 0,
  kInverseI = 1,
  kStartMomentum = 4,
  kStartRate = 7,
  kStartMomentumRate = 10,
  kStartTorque = 13,
  kStartForce = 16,
  kStageMomentum = 19,
  kStageTurn = 22,    // a quaternion, from the step's start
  kMiddleRates = 26,  // of the second and third stage, together
  kMiddleMomentumRates = 29,
  kMiddleTorques = 32,
  kMiddleForces = 35,
  kRk4End = 38
};
static_assert(kRk4End == kRk4Numbers);

/// What the effects at a stage look at.
enum class EffectsSee { kPose, kVelocityToo };

/// Adds the value at a middle stage, 1 or 2, to their sum.
template <int stage, class Tile, class S>
RBS_INLINE void addMiddle(const Tile& tile, int number, const Vector<S>& value) {
  if constexpr (stage == 1) tile.storeVector(number, value);
  if constexpr (stage == 2) tile.storeVector(number, tile.loadVector(number) + value);
}

/// Positions and linear momenta: from the forces at stage `stage` to the next one, or to the end.
template <int stage, class Place>
RBS_INLINE void rk4PathAt(const Place& at, const BodyColumns& bodies, const BodyColumns& stages,
                          const WrenchColumns& wrenches, double* tiles, double h) {
  const auto tile = inTile<kRk4Numbers>(at, tiles);
  const std::ptrdiff_t n = bodies.stride, ns = stages.stride;
  const auto f_W = loadVector(at, wrenches.f_W, wrenches.stride);
  const auto P0 = loadVector(at, bodies.P_WB, n), p0 = loadVector(at, bodies.p_WBcm, n);
  if constexpr (stage == 0) {
    tile.store(kInverseMass, 1 / at.load(bodies.mass));
    tile.storeVector(kStartForce, f_W);
  } else {
    addMiddle<stage>(tile, kMiddleForces, f_W);
  }
  if constexpr (stage == 3) {
    const auto f1_W = tile.loadVector(kStartForce), middle = tile.loadVector(kMiddleForces);
    move(at, bodies, (h * tile.load(kInverseMass)) * (P0 + (h / 6) * (f1_W + middle)));
    storeVector(at, bodies.P_WB, n, afterStep(P0, f1_W, middle, f_W, h));
  } else {
    const double ah = stage == 2 ? h : 0.5 * h;
    const auto P = stage == 0 ? P0 : loadVector(at, stages.P_WB, ns);
    storeVector(at, stages.p_WBcm, ns, p0 + (ah * tile.load(kInverseMass)) * P);
    storeVector(at, stages.P_WB, ns, P0 + ah * f_W);
  }
}

/// What a stage finds of the rotation.
template <class S>
struct Stage {
  Vector<S> t_W, w_B, m_rate_B;
};

/// The rotation at which the effects of the stage after `stage` are evaluated.
template <EffectsSee sight, int stage, class Place, class Tile, class S>
RBS_INLINE void beginNext(const Place& at, const BodyColumns& stages, const Tile& tile,
                          const Stage<S>& k, const Quaternion<S>& q0_WB, const Vector<S>& m0_B,
                          double h) {
  const std::ptrdiff_t ns = stages.stride;
  const double ah = stage == 2 ? h : 0.5 * h;
  const Vector<S> turn =
      stage == 1 ? turnToThird(tile.loadVector(kStartRate), k.w_B, h) : ah * k.w_B;
  const Quaternion<S> q_turn = rotationExp(turn), q_WB = q0_WB * q_turn;
  const Vector<S> m_B = m0_B + ah * k.m_rate_B;
  tile.storeVector(kStageMomentum, m_B);
  tile.storeQuaternion(kStageTurn, q_turn);
  storeQuaternion(at, stages.q_WB, ns, q_WB);
  if constexpr (sight == EffectsSee::kVelocityToo)
    storeVector(at, stages.L_WBcm_W, ns, rotated(q_WB, m_B));
}

template <bool gyroscopic, class Place, class Tile, class S>
RBS_INLINE void endStep(const Place& at, const BodyColumns& bodies, const Tile& tile,
                        const Stage<S>& k, const Quaternion<S>& q0_WB, const Vector<S>& m0_B,
                        double h) {
  const std::ptrdiff_t n = bodies.stride;
  const Vector<S> turn =
      turnToEnd(tile.loadVector(kStartRate), tile.loadVector(kMiddleRates), k.w_B, h);
  const Vector<S> m_B = afterStep(m0_B, tile.loadVector(kStartMomentumRate),
                                  tile.loadVector(kMiddleMomentumRates), k.m_rate_B, h);
  const Vector<S> L_W = afterStep(loadVector(at, bodies.L_WBcm_W, n), tile.loadVector(kStartTorque),
                                  tile.loadVector(kMiddleTorques), k.t_W, h);
  const Rotation<S> after = rotationAfter<gyroscopic>(q0_WB, turn, m0_B, m_B, L_W);
  storeQuaternion(at, bodies.q_WB, n, after.q_WB);
  storeVector(at, bodies.L_WBcm_W, n, after.L_W);
}

/// The rotation, as rk4PathAt().
template <bool gyroscopic, EffectsSee sight, int stage, class Place>
RBS_INLINE void rk4TurnAt(const Place& at, const BodyColumns& bodies, const BodyColumns& stages,
                          const WrenchColumns& wrenches, double* tiles, double h) {
  using S = typename Place::Number;
  const auto tile = inTile<kRk4Numbers>(at, tiles);
  Stage<S> k;
  k.t_W = loadVector(at, wrenches.t_Bcm_W, wrenches.stride);
  const Quaternion<S> q0_WB = loadQuaternion(at, bodies.q_WB, bodies.stride);
  Vector<S> t_B = torqueAtStart(q0_WB, k.t_W), m0_B, m_B, a;
  if constexpr (stage == 0) {
    m0_B = m_B = rotatedBack(q0_WB, loadVector(at, bodies.L_WBcm_W, bodies.stride));
    const auto I = loadVector(at, bodies.I_BBcm_B, bodies.stride);
    a = {1 / I.x, 1 / I.y, 1 / I.z};
    tile.storeVector(kInverseI, a);
    tile.storeVector(kStartMomentum, m0_B);
  } else {
    t_B = rotatedBack(tile.loadQuaternion(kStageTurn), t_B);
    m0_B = tile.loadVector(kStartMomentum);
    m_B = tile.loadVector(kStageMomentum);
    a = tile.loadVector(kInverseI);
  }
  k.w_B = product(a, m_B);
  k.m_rate_B = momentumRate<gyroscopic>(m_B, k.w_B, t_B);
  if constexpr (stage == 0) {
    tile.storeVector(kStartRate, k.w_B);
    tile.storeVector(kStartMomentumRate, k.m_rate_B);
    tile.storeVector(kStartTorque, k.t_W);
  } else {
    addMiddle<stage>(tile, kMiddleRates, k.w_B);
    addMiddle<stage>(tile, kMiddleMomentumRates, k.m_rate_B);
    addMiddle<stage>(tile, kMiddleTorques, k.t_W);
  }
  if constexpr (stage < 3)
    beginNext<sight, stage>(at, stages, tile, k, q0_WB, m0_B, h);
  else
    endStep<gyroscopic>(at, bodies, tile, k, q0_WB, m0_B, h);
}

/// How many bodies go through the two parts of a stage together, see kTogether.
constexpr std::ptrdiff_t kTogetherInStage = 32;

template <class S, bool gyroscopic, EffectsSee sight, int stage>
void rk4StageOf(const BodyColumns& of, const BodyColumns& stages_of, const WrenchColumns& by,
                double* tiles, double h, Range range) {
  const BodyColumns bodies = of, stages = stages_of;
  const WrenchColumns wrenches = by;
  for (std::ptrdiff_t i = range.begin; i < range.end; i += kTogetherInStage) {
    const std::ptrdiff_t end = i + kTogetherInStage < range.end ? i + kTogetherInStage : range.end;
    forPacks<S>(i, end,
                [=](const auto& at) { rk4PathAt<stage>(at, bodies, stages, wrenches, tiles, h); });
    forPacks<S>(i, end, [=](const auto& at) {
      rk4TurnAt<gyroscopic, sight, stage>(at, bodies, stages, wrenches, tiles, h);
    });
  }
}

template <class S, bool gyroscopic, EffectsSee sight>
void rk4Stage(const BodyColumns& bodies, const BodyColumns& stages, const WrenchColumns& wrenches,
              double* tiles, int stage, double h, Range range) {
  if (stage == 0)
    rk4StageOf<S, gyroscopic, sight, 0>(bodies, stages, wrenches, tiles, h, range);
  else if (stage == 1)
    rk4StageOf<S, gyroscopic, sight, 1>(bodies, stages, wrenches, tiles, h, range);
  else if (stage == 2)
    rk4StageOf<S, gyroscopic, sight, 2>(bodies, stages, wrenches, tiles, h, range);
  else
    rk4StageOf<S, gyroscopic, sight, 3>(bodies, stages, wrenches, tiles, h, range);
}

}  // namespace
}  // namespace rigid_body_sim::batch

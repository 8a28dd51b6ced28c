#pragma once

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

/// A torque in body axes; none is +0 whatever the attitude, as where none is computed.
template <class S>
RBS_INLINE Vector<S> torqueInBody(const Quaternion<S>& q_WB, const Vector<S>& t_W) {
  const Vector<S> t_B = rotatedBack(q_WB, t_W);
  return {t_B.x + 0.0, t_B.y + 0.0, t_B.z + 0.0};
}

/// Attitude and angular momentum at the end of a step.
template <class S>
struct Rotation {
  Quaternion<S> q_WB;
  Vector<S> L_W;
};

/// As in body_momentum.hpp.
constexpr double kLeastDirected = 1e-290;

/// setRotation() of body_momentum.hpp: `q_WB`, of unit length but for rounding, turned so that R m
/// comes onto L, where L is not merely what is left of `before`.
template <class S>
RBS_INLINE Quaternion<S> aligned(const Quaternion<S>& q_WB, const Vector<S>& m_B,
                                 const Vector<S>& L_W, const Vector<S>& before) {
  Vector<S> now = rotated(q_WB, m_B), wanted = L_W;
  S square = dot(m_B, m_B) * dot(L_W, L_W);
  if (!all((square > 1e-280) & (square < 1e280))) {
    // Products of two of these leave the range of numbers.
    const auto is_beyond = !((square > 1e-280) & (square < 1e280));
    const S now_size = largest(now), wanted_size = largest(wanted);
    now = select(is_beyond, inversePower(now_size) * now, now);
    wanted = select(is_beyond, inversePower(wanted_size) * wanted, wanted);
    square = select(is_beyond, dot(now, now) * dot(wanted, wanted), square);
  }
  const S size = root(square);
  const S cosine = dot(now, wanted);
  const Vector<S> axis = cross(now, wanted);
  const Quaternion<S> turned = Quaternion<S>{axis.x, axis.y, axis.z, size + cosine} * q_WB;
  const S length = root(squaredNorm(turned));
  const auto is_still = isZero(m_B);
  const S safe = select(length == 0, S(1.0), length);
  const S left = largest(L_W);
  const auto is_directed = (left > 0.1 * largest(before)) & (left > kLeastDirected);
  const auto turns = is_directed & (cosine > 0.9999 * size) & !is_still;
  return select(turns, scaled(1 / safe, turned), q_WB);
}

/// The end of a step at the body's `turn` [rad], in body axes.
template <bool gyroscopic, class S>
RBS_INLINE Rotation<S> rotationAfter(const Rotation<S>& before, const Vector<S>& turn,
                                     const Vector<S>& m_B, const Vector<S>& L_W) {
  const Quaternion<S> q_WB =
      select(isZero(turn), before.q_WB, renormalized(before.q_WB * rotationExp(turn)));
  if constexpr (gyroscopic) return {aligned(q_WB, m_B, L_W, before.L_W), L_W};
  return {q_WB, rotated(q_WB, m_B)};
}

// Numbers in rk4's tiles. Sums are those of the stages, with the weights 1, 2, 2, 1.
enum Rk4Number {
  kInverseMass = 0,
  kInverseI = 1,
  kStartMomentum = 4,
  kStartRate = 7,
  kStageMomentum = 10,
  kRates = 13,
  kMomentumRates = 16,
  kTorques = 19,
  kForces = 22,
  kForcesOfPath = 25,  // sum of the first three, each once: what the positions are of
  kRk4End = 28
};
static_assert(kRk4End == kRk4Numbers);

/// What the effects at a stage look at.
enum class EffectsSee { kPose, kVelocityToo };

/// Adds a stage that is not the last to a sum.
template <int stage, class Tile, class S>
RBS_INLINE void addUp(const Tile& tile, int number, const Vector<S>& value) {
  if constexpr (stage == 0)
    tile.storeVector(number, value);
  else
    tile.storeVector(number, tile.loadVector(number) + 2 * value);
}

/// Positions and linear momenta: from the forces at stage `stage` to the next one, or to the end.
template <int stage, class Place>
RBS_INLINE void rk4PathAt(const Place& at, const BodyColumns& bodies, const BodyColumns& stages,
                          const WrenchColumns& wrenches, double* tiles, double h) {
  const auto tile = inTile<kRk4Numbers>(at, tiles);
  const std::ptrdiff_t n = bodies.stride, ns = stages.stride;
  const auto f_W = loadVector(at, wrenches.f_W, wrenches.stride);
  const auto P0 = loadVector(at, bodies.P_WB, n), p0 = loadVector(at, bodies.p_WBcm, n);
  if constexpr (stage == 0) tile.store(kInverseMass, 1 / at.load(bodies.mass));
  if constexpr (stage == 3) {
    const double sixth = h / 6;
    move(at, bodies, (h * tile.load(kInverseMass)) * (P0 + sixth * tile.loadVector(kForcesOfPath)));
    storeVector(at, bodies.P_WB, n, P0 + sixth * (tile.loadVector(kForces) + f_W));
  } else {
    const double ah = stage == 2 ? h : 0.5 * h;
    const auto P = stage == 0 ? P0 : loadVector(at, stages.P_WB, ns);
    storeVector(at, stages.p_WBcm, ns, p0 + (ah * tile.load(kInverseMass)) * P);
    storeVector(at, stages.P_WB, ns, P0 + ah * f_W);
    addUp<stage>(tile, kForces, f_W);
    tile.storeVector(kForcesOfPath, stage == 0 ? f_W : tile.loadVector(kForcesOfPath) + f_W);
  }
}

/// What a stage finds of the rotation.
template <class S>
struct Stage {
  Vector<S> t_W, w_B, m_rate_B;
};

/// The rotation at which the effects of the stage after `stage` are evaluated.
template <EffectsSee sight, int stage, class Place, class Tile, class S>
RBS_INLINE void beginNext(const Place& at, const BodyColumns& bodies, const BodyColumns& stages,
                          const Tile& tile, const Stage<S>& k, const Vector<S>& m0_B, double h) {
  const std::ptrdiff_t ns = stages.stride;
  const double ah = stage == 2 ? h : 0.5 * h;
  addUp<stage>(tile, kRates, k.w_B);
  addUp<stage>(tile, kMomentumRates, k.m_rate_B);
  addUp<stage>(tile, kTorques, k.t_W);
  Vector<S> turn = ah * k.w_B;
  if constexpr (stage == 1) turn = turn + (h * h / 8) * cross(tile.loadVector(kStartRate), k.w_B);
  const Quaternion<S> q_WB = loadQuaternion(at, bodies.q_WB, bodies.stride) * rotationExp(turn);
  const Vector<S> m_B = m0_B + ah * k.m_rate_B;
  tile.storeVector(kStageMomentum, m_B);
  storeQuaternion(at, stages.q_WB, ns, q_WB);
  if constexpr (sight == EffectsSee::kVelocityToo)
    storeVector(at, stages.L_WBcm_W, ns, rotated(q_WB, m_B));
}

template <bool gyroscopic, class Place, class Tile, class S>
RBS_INLINE void endStep(const Place& at, const BodyColumns& bodies, const Tile& tile,
                        const Stage<S>& k, const Vector<S>& m0_B, double h) {
  const std::ptrdiff_t n = bodies.stride;
  const double sixth = h / 6;
  const Vector<S> turn = sixth * (tile.loadVector(kRates) + k.w_B) +
                         (h * h / 12) * cross(tile.loadVector(kStartRate), k.w_B);
  const Vector<S> m_B = m0_B + sixth * (tile.loadVector(kMomentumRates) + k.m_rate_B);
  const Rotation<S> before = {loadQuaternion(at, bodies.q_WB, n),
                              loadVector(at, bodies.L_WBcm_W, n)};
  const Vector<S> L_W = before.L_W + sixth * (tile.loadVector(kTorques) + k.t_W);
  const Rotation<S> after = rotationAfter<gyroscopic>(before, turn, m_B, L_W);
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
  Vector<S> m0_B, m_B, a;
  Quaternion<S> q_WB;
  if constexpr (stage == 0) {
    q_WB = loadQuaternion(at, bodies.q_WB, bodies.stride);
    m0_B = m_B = rotatedBack(q_WB, loadVector(at, bodies.L_WBcm_W, bodies.stride));
    const auto I = loadVector(at, bodies.I_BBcm_B, bodies.stride);
    a = {1 / I.x, 1 / I.y, 1 / I.z};
    tile.storeVector(kInverseI, a);
    tile.storeVector(kStartMomentum, m0_B);
  } else {
    q_WB = loadQuaternion(at, stages.q_WB, stages.stride);
    m0_B = tile.loadVector(kStartMomentum);
    m_B = tile.loadVector(kStageMomentum);
    a = tile.loadVector(kInverseI);
  }
  k.w_B = product(a, m_B);
  k.m_rate_B = momentumRate<gyroscopic>(m_B, k.w_B, torqueInBody(q_WB, k.t_W));
  if constexpr (stage == 0) tile.storeVector(kStartRate, k.w_B);
  if constexpr (stage < 3)
    beginNext<sight, stage>(at, bodies, stages, tile, k, m0_B, h);
  else
    endStep<gyroscopic>(at, bodies, tile, k, m0_B, h);
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

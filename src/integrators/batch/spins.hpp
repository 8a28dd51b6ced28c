#pragma once

#include "integrators/batch/drift.hpp"
#include "integrators/batch/spin_tile.hpp"

// Kicks and exact free flight, as in exact.cpp, with what it remembers of each body in tiles.
namespace rigid_body_sim::batch {
namespace {

/// m = R^T L anew, where `mask`.
template <class S>
[[gnu::cold, gnu::noinline]] Vector<S> momentumAnew(typename MaskOf<S>::Type mask,
                                                    const Quaternion<S>& q_WB, const Vector<S>& L_W,
                                                    const Vector<S>& m_B) {
  Vector<S> all = m_B;
  for (int i = 0; i < kWidth<S>; ++i) {
    if (!(bits(mask) >> i & 1)) continue;
    const double q[] = {lane(q_WB.x, i), lane(q_WB.y, i), lane(q_WB.z, i), lane(q_WB.w, i)};
    const double L[] = {lane(L_W.x, i), lane(L_W.y, i), lane(L_W.z, i)};
    double m[3];
    momentumInBody(q, L, m);
    setLane(all.x, i, m[0]);
    setLane(all.y, i, m[1]);
    setLane(all.z, i, m[2]);
  }
  return all;
}

/// Ends the coasting of lanes. @returns the momentum of all
template <class Tile, class M>
RBS_INLINE auto momentumAfterCoasting(const Tile& tile, M ends) {
  using S = typename Tile::S;
  Vector<S> m_B = tile.loadVector(kSpinM);
  const auto coasted = ends & !(tile.load(kSpinCoasts) == 0);
  if (any(coasted)) {
    m_B = select(coasted, bodyMomentumOf(loadCoasting(tile)), m_B);
    storeWhere(tile, coasted, kSpinCoasts, S(0.0));
  }
  return m_B;
}

/// Takes up lanes of which somebody else has changed the angular momentum alone: as a kick does.
template <class Tile, class M, class S>
RBS_INLINE void recallMomenta(const Tile& tile, M mask, const Quaternion<S>& q_WB,
                              const Vector<S>& L_W) {
  const Vector<S> m_B = momentumAfterCoasting(tile, mask);
  const Vector<S> old_L = tile.loadVector(kSpinL);
  tile.storeVector(kSpinM, select(mask, m_B + rotatedBack(q_WB, L_W - old_L), m_B));
  tile.storeVector(kSpinL, select(mask, L_W, old_L));
  storeWhere(tile, mask, kSpinDrift, S(0.0));
}

/// Takes up lanes anew.
template <class Tile, class M, class S>
RBS_INLINE void recallAll(const Tile& tile, M mask, const Quaternion<S>& q_WB, const Vector<S>& L_W,
                          const InverseMoments<S>& a) {
  const S none(0.0);
  tile.storeQuaternion(kSpinQ, select(mask, q_WB, tile.loadQuaternion(kSpinQ)));
  tile.storeVector(kSpinL, select(mask, L_W, tile.loadVector(kSpinL)));
  tile.storeVector(kSpinM, momentumAnew<S>(mask, q_WB, L_W, tile.loadVector(kSpinM)));
  storeWhere(tile, mask, kSpinInverse, a.a2);
  storeWhere(tile, mask, kSpinInverse + 1, a.a13);
  storeWhere(tile, mask, kSpinInverse + 2, a.d12);
  storeWhere(tile, mask, kSpinInverse + 3, a.d23);
  storeWhere(tile, mask, kSpinDrift, none);
  storeWhere(tile, mask, kSpinCoasts, none);
  storeCoasting(tile, mask, standingStill<S>());
}

template <class Place, class M>
[[gnu::noinline]] void recallMoved(Place at, BodyColumns bodies, double* tiles, M is_here,
                                   M is_known) {
  using S = typename Place::Number;
  const auto tile = inTile<kSpinNumbers>(at, tiles);
  const Quaternion<S> q_WB = loadQuaternion(at, bodies.q_WB, bodies.stride);
  const Vector<S> L_W = loadVector(at, bodies.L_WBcm_W, bodies.stride);
  const auto is_kicked = is_here & !is_known;
  if (any(is_kicked)) recallMomenta(tile, is_kicked, q_WB, L_W);
  if (all(is_here)) return;
  const auto I = loadVector(at, bodies.I_BBcm_B, bodies.stride);
  recallAll(tile, !is_here, q_WB, L_W, inverseMoments(I));
}

/// Whether the attitude is what the method left behind.
template <class Place, class Tile>
RBS_INLINE auto isHere(const Place& at, const BodyColumns& bodies, const Tile& tile) {
  const auto q_WB = loadQuaternion(at, bodies.q_WB, bodies.stride);
  const auto old = tile.loadQuaternion(kSpinQ);
  return ((old.x == q_WB.x) & (old.y == q_WB.y)) & ((old.z == q_WB.z) & (old.w == q_WB.w));
}
template <class Place, class Tile>
RBS_INLINE auto hasItsMomentum(const Place& at, const BodyColumns& bodies, const Tile& tile) {
  const auto L_W = loadVector(at, bodies.L_WBcm_W, bodies.stride);
  const auto old = tile.loadVector(kSpinL);
  return (old.x == L_W.x) & (old.y == L_W.y) & (old.z == L_W.z);
}

/// Takes up lanes that somebody else has moved.
template <class Place>
RBS_INLINE void recallSpins(const Place& at, const BodyColumns& bodies, double* tiles) {
  const auto tile = inTile<kSpinNumbers>(at, tiles);
  const auto is_here = isHere(at, bodies, tile);
  const auto is_known = is_here & hasItsMomentum(at, bodies, tile);
  if (!all(is_known)) recallMoved(at, bodies, tiles, is_here, is_known);
}

/// L += h t where there is a torque, of bodies that nobody else has moved.
template <class Place, class S, class M>
RBS_INLINE void kickMomenta(const Place& at, const BodyColumns& bodies, double* tiles,
                            const Vector<S>& impulse, M turns) {
  const auto tile = inTile<kSpinNumbers>(at, tiles);
  const Vector<S> m_B = momentumAfterCoasting(tile, turns);
  const Vector<S> L_W = loadVector(at, bodies.L_WBcm_W, bodies.stride);  // with its zeros' signs
  const Vector<S> L_next = select(turns, L_W + impulse, L_W);
  tile.storeVector(kSpinL, L_next);
  storeVector(at, bodies.L_WBcm_W, bodies.stride, L_next);
  const Quaternion<S> q_WB = tile.loadQuaternion(kSpinQ);
  tile.storeVector(kSpinM, select(turns, m_B + rotatedBack(q_WB, impulse), m_B));
  storeWhere(tile, turns, kSpinDrift, S(0.0));
}

template <class Place, class S, class M>
[[gnu::noinline]] void recallAndKick(Place at, BodyColumns bodies, double* tiles, Vector<S> impulse,
                                     M turns) {
  recallSpins(at, bodies, tiles);
  kickMomenta(at, bodies, tiles, impulse, turns);
}

template <class S>
void kickSpins(const BodyColumns& of, const WrenchColumns& by, double* tiles, double h,
               Range range) {
  const BodyColumns bodies = of;
  const WrenchColumns wrenches = by;
  forPacks<S>(range.begin, range.end, [=](const auto& at) {
    using T = NumberOf<decltype(at)>;
    kicked(at, bodies.P_WB, bodies.stride, wrenches.f_W, wrenches.stride, h);
    const Vector<T> t_W = loadVector(at, wrenches.t_Bcm_W, wrenches.stride);
    const auto turns = !isZero(t_W);
    if (any(turns)) recallAndKick(at, bodies, tiles, h * t_W, turns);
  });
}

/// Where rounding has let R m and L part by more than 1e-14 of L, the attitude is turned the
/// shortest way back, and m gets the length of L. What is more than 3e-14 off comes of a kick that
/// took most of L and left m with the roundings of more, or of a turn by more than a radian: m is
/// made anew.
template <class S>
RBS_INLINE void alignSpin(typename MaskOf<S>::Type mask, const Vector<S>& L_W, Quaternion<S>& q_WB,
                          Vector<S>& m_B) {
  const Vector<S> now = rotated(q_WB, m_B);
  const Vector<S> off = now - L_W;
  const S size2 = dot(L_W, L_W), off2 = dot(off, off);
  const auto is_off = mask & !(off2 <= 1e-28 * size2);
  if (!any(is_off)) return;
  const auto is_lost = off2 > 1e-27 * size2;
  if (any(is_off & is_lost)) m_B = momentumAnew<S>(is_off & is_lost, q_WB, L_W, m_B);
  const auto turns = is_off & !is_lost;
  if (!any(turns)) return;
  const Vector<S> half = (0.5 / select(turns, size2, S(1.0))) * cross(now, L_W);
  const Quaternion<S> turned = renormalized(Quaternion<S>{half.x, half.y, half.z, S(1.0)} * q_WB);
  q_WB = select(turns, turned, q_WB);
  const S fit = 1.5 - 0.5 * (dot(now, now) / select(turns, size2, S(1.0)));
  m_B = select(turns, fit * m_B, m_B);
}

template <class Tile>
RBS_INLINE InverseMoments<typename Tile::S> loadInverse(const Tile& tile) {
  return {tile.load(kSpinInverse), tile.load(kSpinInverse + 1), tile.load(kSpinInverse + 2),
          tile.load(kSpinInverse + 3)};
}

/// A body whose rotation is to be worked out.
template <class S>
struct Rotor {
  Vector<S> m_B;
  Vector<S> I;
  InverseMoments<S> a;
};

/// Lanes outside the mask get the numbers of one inside, lest they divide by zero.
template <class S>
RBS_INLINE void fillFrom(typename MaskOf<S>::Type mask, S& x) {
  x = select(mask, x, S(lane(x, __builtin_ctz(bits(mask)))));
}
template <class S>
RBS_INLINE Rotor<S> filled(typename MaskOf<S>::Type mask, Rotor<S> x) {
  if (all(mask)) return x;
  for (S* number : {&x.m_B.x, &x.m_B.y, &x.m_B.z, &x.I.x, &x.I.y, &x.I.z, &x.a.a2, &x.a.a13,
                    &x.a.d12, &x.a.d23})
    fillFrom(mask, *number);
  return x;
}

template <class Place, class Tile, class S>
RBS_INLINE Rotor<S> rotorOf(const Place& at, const BodyColumns& bodies, const Tile& tile,
                            typename MaskOf<S>::Type mask, const Vector<S>& m_B) {
  return filled<S>(mask, {m_B, loadVector(at, bodies.I_BBcm_B, bodies.stride), loadInverse(tile)});
}

template <class Place, class Tile, class S>
RBS_INLINE void turnTo(const Quaternion<S>& q_WB, const Place& at, const BodyColumns& bodies,
                       const Tile& tile) {
  tile.storeQuaternion(kSpinQ, q_WB);
  storeQuaternion(at, bodies.q_WB, bodies.stride, q_WB);
}

/// Attitude and angular momentum of a body that does not coast.
template <class S>
struct Spin {
  Quaternion<S> q_WB;
  Vector<S> L_W;
  Vector<S> m_B;
};

template <class S>
RBS_INLINE void kick(Spin<S>& x, const Vector<S>& impulse_W) {
  x.L_W = x.L_W + impulse_W;
  x.m_B = x.m_B + rotatedBack(x.q_WB, impulse_W);
}

/// Turns lanes; some, in any case.
template <class Place, class Tile, class M, class S>
RBS_INLINE void rotate(const Place& at, const BodyColumns& bodies, const Tile& tile, M mask,
                       double h, Spin<S>& x) {
  const auto is_lost = mask & isZero(x.m_B);  // a kick took all but roundings of L
  if (any(is_lost)) x.m_B = momentumAnew<S>(is_lost, x.q_WB, x.L_W, x.m_B);
  const Rotor<S> rotor = rotorOf(at, bodies, tile, mask, x.m_B);
  FreeRotation<S> free = exactRotation(rotor.m_B, rotor.I, rotor.a, h);
  Quaternion<S> next = renormalized(x.q_WB * free.q_BBnext);
  alignSpin<S>(mask, x.L_W, next, free.m_B);
  x.q_WB = select(mask, next, x.q_WB);
  x.m_B = select(mask, free.m_B, x.m_B);
}

/// Turns lanes that do not coast.
template <class Place, class M>
[[gnu::noinline]] void rotateSpins(Place at, BodyColumns bodies, double* tiles, M mask, double h) {
  using S = typename Place::Number;
  const auto tile = inTile<kSpinNumbers>(at, tiles);
  Spin<S> x = {tile.loadQuaternion(kSpinQ), tile.loadVector(kSpinL),
               momentumAfterCoasting(tile, mask)};
  rotate(at, bodies, tile, mask, h, x);
  tile.storeVector(kSpinM, x.m_B);
  storeWhere(tile, mask, kSpinDrift, S(h));
  turnTo(x.q_WB, at, bodies, tile);
}

/// The second equal drift in a row without torque.
template <class Place, class M>
[[gnu::noinline]] void beginToCoast(Place at, BodyColumns bodies, double* tiles, M mask, double h) {
  using S = typename Place::Number;
  const auto tile = inTile<kSpinNumbers>(at, tiles);
  const Rotor<S> rotor = rotorOf(at, bodies, tile, mask, tile.loadVector(kSpinM));
  storeCoasting(tile, mask,
                coastingOf<S>(tile.loadQuaternion(kSpinQ), rotor.m_B, rotor.I, rotor.a, h));
  storeWhere(tile, mask, kSpinCoasts, S(h));
}

/// A step of bodies that coast. @returns the attitude after it
template <class Tile, class M>
RBS_INLINE auto coast(const Tile& tile, M coasts) {
  auto x = loadCoasting(tile);
  const auto q_WB = nextAttitude(x);
  storeMoved(tile, coasts, x);
  return q_WB;
}

/// The rotation in a drift of h [s]: bodies that drift as long as before coast, the others are
/// turned. Nobody else has moved them.
template <class Place>
RBS_INLINE void moveKnownSpins(const Place& at, const BodyColumns& bodies, double* tiles,
                               double h) {
  if (h == 0) return;
  const auto tile = inTile<kSpinNumbers>(at, tiles);
  const auto spins = !isZero(tile.loadVector(kSpinL));
  const auto goes_on = spins & (tile.load(kSpinDrift) == h);
  const auto rotates = spins & !goes_on;
  if (any(rotates)) rotateSpins(at, bodies, tiles, rotates, h);
  const auto begins = goes_on & !(tile.load(kSpinCoasts) == h);
  if (any(begins)) beginToCoast(at, bodies, tiles, begins, h);
  if (!any(goes_on)) return;
  const auto q_WB = loadQuaternion(at, bodies.q_WB, bodies.stride);
  turnTo(select(goes_on, coast(tile, goes_on), q_WB), at, bodies, tile);
}

template <class Place>
[[gnu::noinline]] void recallAndMove(Place at, BodyColumns bodies, double* tiles, double h) {
  recallSpins(at, bodies, tiles);
  moveKnownSpins(at, bodies, tiles, h);
}

/// The same of any bodies, with a shorter way for those that all coast already.
template <class Place>
RBS_INLINE void moveSpins(const Place& at, const BodyColumns& bodies, double* tiles, double h) {
  if (h == 0) return;  // which would be the step of those that do not coast
  const auto tile = inTile<kSpinNumbers>(at, tiles);
  if (all(tile.load(kSpinCoasts) == h) &&
      all(isHere(at, bodies, tile) & hasItsMomentum(at, bodies, tile)))
    return turnTo(coast(tile, All()), at, bodies, tile);
  recallAndMove(at, bodies, tiles, h);
}

template <class S>
void driftSpins(const BodyColumns& of, double* tiles, double h, Range range) {
  const BodyColumns bodies = of;
  forPacks<S>(range.begin, range.end, [=](const auto& at) {
    driftPosition(at, bodies, loadVector(at, bodies.P_WB, bodies.stride), h);
    moveSpins(at, bodies, tiles, h);
  });
}

/// The rotation in a kick, a drift and a kick, where there is a torque.
template <class Place, class S, class M>
[[gnu::noinline]] void kickAndMove(Place at, BodyColumns bodies, double* tiles, Vector<S> t_W,
                                   M turns, double before_s, double h, double after_s) {
  recallSpins(at, bodies, tiles);
  if (!all(turns)) {
    kickMomenta(at, bodies, tiles, before_s * t_W, turns);
    moveKnownSpins(at, bodies, tiles, h);
    if (after_s != 0) kickMomenta(at, bodies, tiles, after_s * t_W, turns);
    return;
  }
  // The same in one go.
  const auto tile = inTile<kSpinNumbers>(at, tiles);
  Spin<S> x = {tile.loadQuaternion(kSpinQ), loadVector(at, bodies.L_WBcm_W, bodies.stride),
               momentumAfterCoasting(tile, turns)};
  kick(x, before_s * t_W);
  const auto spins = !isZero(x.L_W);
  if (h != 0 && any(spins)) rotate(at, bodies, tile, spins, h, x);
  if (after_s != 0) kick(x, after_s * t_W);
  tile.storeVector(kSpinM, x.m_B);
  tile.store(kSpinDrift, after_s != 0 ? S(0.0) : select(spins, S(h), S(0.0)));
  tile.storeVector(kSpinL, x.L_W);
  storeVector(at, bodies.L_WBcm_W, bodies.stride, x.L_W);
  turnTo(x.q_WB, at, bodies, tile);
}

/// A kick of `before_s`, a drift of h, and unless it is 0 a kick of `after_s` [s].
template <class S>
void flySpins(const BodyColumns& of, const WrenchColumns& by, double* tiles, double before_s,
              double h, double after_s, Range range) {
  const BodyColumns bodies = of;
  const WrenchColumns wrenches = by;
  forPacks<S>(range.begin, range.end, [=](const auto& at) {
    using T = NumberOf<decltype(at)>;
    const Vector<T> f_W = loadVector(at, wrenches.f_W, wrenches.stride);
    const Vector<T> t_W = loadVector(at, wrenches.t_Bcm_W, wrenches.stride);
    const auto turns = !isZero(t_W);
    Vector<T> P_WB = loadVector(at, bodies.P_WB, bodies.stride) + before_s * f_W;
    driftPosition(at, bodies, P_WB, h);
    if (after_s != 0) P_WB = P_WB + after_s * f_W;
    storeVector(at, bodies.P_WB, bodies.stride, P_WB);
    if (!any(turns)) return moveSpins(at, bodies, tiles, h);
    kickAndMove(at, bodies, tiles, t_W, turns, before_s, h, after_s);
  });
}

}  // namespace
}  // namespace rigid_body_sim::batch

#pragma once

#include "integrators/batch/coasting.hpp"
#include "integrators/batch/tiles.hpp"

namespace rigid_body_sim::batch {
namespace {

/// What `exact` remembers of a body, by its place in the tile. What a body that coasts needs comes
/// first.
enum SpinNumber {
  kSpinQ = 0,  // attitude and angular momentum that the method left behind
  kSpinL = 4,
  kSpinCoasts = 7,  // [s] steps of a body that coasts; 0 of others
  kSpinMoving = 8,  // of Coasting, as are the constants
  kSpinConstants = 12,
  kSpinM = 29,        // m_B; not up to date while coasting
  kSpinInverse = 32,  // InverseMoments
  kSpinDrift = 36     // [s] the latest drift; 0 if something turned the momentum since
};

/// Calls `f` for what moves in a Coasting.
template <class AnyCoasting, class F>
RBS_INLINE void forMoving(AnyCoasting& x, F f) {
  f(x.s);
  f(x.c);
  f(x.psi.cos);
  f(x.psi.sin);
}
template <class AnyCoasting, class F>
RBS_INLINE void forConstants(AnyCoasting& x, F f) {
  f(x.q_WE.x);
  f(x.q_WE.y);
  f(x.q_WE.z);
  f(x.q_WE.w);
  f(x.turn.cos);
  f(x.turn.sin);
  f(x.of_step.sn);
  f(x.of_step.cn);
  f(x.of_step.dn);
  f(x.kc2);
  f(x.num);
  f(x.den);
  f(x.length);
  f(x.root_dd);
  f(x.B_2);
  f(x.B_d);
  f(x.G);
}

/// The mask of all bodies.
struct All {};

/// Stores where `mask`.
template <class Tile, class M, class S>
RBS_INLINE void storeWhere(const Tile& tile, M mask, int number, const S& x) {
  tile.store(number, select(mask, x, tile.load(number)));
}
template <class Tile, class S>
RBS_INLINE void storeWhere(const Tile& tile, All, int number, const S& x) {
  tile.store(number, x);
}

/// Functions for forMoving() and forConstants(), of the numbers from `number` on.
template <class Tile>
struct Load {
  const Tile& tile;
  int number;

  RBS_INLINE void operator()(typename Tile::S& x) { x = tile.load(number++); }
};
template <class Tile, class M>
struct Store {
  const Tile& tile;
  M mask;
  int number;

  RBS_INLINE void operator()(const typename Tile::S& x) { storeWhere(tile, mask, number++, x); }
};

template <class Tile>
RBS_INLINE auto loadCoasting(const Tile& tile) {
  Coasting<typename Tile::S> x;
  forMoving(x, Load<Tile>{tile, kSpinMoving});
  forConstants(x, Load<Tile>{tile, kSpinConstants});
  return x;
}
template <class Tile, class M, class S>
RBS_INLINE void storeMoved(const Tile& tile, M mask, const Coasting<S>& x) {
  forMoving(x, Store<Tile, M>{tile, mask, kSpinMoving});
}
template <class Tile, class M, class S>
RBS_INLINE void storeCoasting(const Tile& tile, M mask, const Coasting<S>& x) {
  storeMoved(tile, mask, x);
  forConstants(x, Store<Tile, M>{tile, mask, kSpinConstants});
}

/// What a body has that does not coast: steps of it beside bodies that do are harmless.
template <class S>
RBS_INLINE Coasting<S> standingStill() {
  const S one(1.0), none(0.0);
  Coasting<S> x;
  forConstants(x, [&](S& number) { number = none; });
  for (S* number : {&x.q_WE.w, &x.turn.cos, &x.of_step.cn, &x.of_step.dn, &x.kc2, &x.length,
                    &x.root_dd, &x.B_d})
    *number = one;
  x.s = none;
  x.c = one;
  x.psi = {one, none};
  return x;
}

}  // namespace
}  // namespace rigid_body_sim::batch

#pragma once

#include <cstddef>

namespace rigid_body_sim::batch {

/// Some of the bodies: from `begin` up to, but without, `end`.
struct Range {
  std::ptrdiff_t begin;
  std::ptrdiff_t end;
};

/// The columns of Bodies. Those of one quantity are `stride` numbers apart.
struct BodyColumns {
  std::ptrdiff_t stride;
  const double* mass;  ///< [kg]
  const double* I_BBcm_B;
  double* p_WBcm;
  double* q_WB;
  double* P_WB;
  double* L_WBcm_W;
  double* p_low;
};

/// The columns of Wrenches.
struct WrenchColumns {
  std::ptrdiff_t stride;
  const double* f_W;
  const double* t_Bcm_W;
};

/// Numbers that a method keeps of each body for itself, in tiles of eight bodies: all their first
/// numbers, all their second, and so on. A step reads one stretch of memory, whose columns cannot
/// push each other out of the cache. Ranges begin at a multiple of
/// eight, or end within the tile that they begin in.
constexpr std::ptrdiff_t kTile = 8;

/// How many numbers the tiles of `count` bodies take.
constexpr std::ptrdiff_t tileSize(std::ptrdiff_t count, int numbers) {
  return (count + kTile - 1) / kTile * kTile * numbers;
}

/// What rk4 keeps of a body from stage to stage.
constexpr int kRk4Numbers = 38;

/// What `exact` remembers of a body, see spin_tile.hpp. Tiles of zeros remember nothing.
constexpr int kSpinNumbers = 37;

}  // namespace rigid_body_sim::batch

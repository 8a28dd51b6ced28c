#pragma once

#include "integrators/batch/columns.hpp"
#include "integrators/batch/vectors.hpp"

namespace rigid_body_sim::batch {
namespace {

/// A pack's place in tiles of `numbers` a body, see kTile.
template <class Place, int numbers>
class InTile {
 public:
  using S = typename Place::Number;

  RBS_INLINE InTile(const Place& at, double* tiles)
      : at_(at), first_(tiles + at.begin / kTile * kTile * numbers + at.begin % kTile) {}

  RBS_INLINE S load(int number) const {
    if constexpr (kIsPair<S>) return at_.loadFrom(first_ + kTile * number, kGap);
    return at_.loadFrom(first_ + kTile * number);
  }
  RBS_INLINE void store(int number, S x) const {
    if constexpr (kIsPair<S>) return at_.storeTo(first_ + kTile * number, x, kGap);
    at_.storeTo(first_ + kTile * number, x);
  }
  RBS_INLINE Vector<S> loadVector(int number) const {
    return {load(number), load(number + 1), load(number + 2)};
  }
  RBS_INLINE void storeVector(int number, const Vector<S>& v) const {
    store(number, v.x);
    store(number + 1, v.y);
    store(number + 2, v.z);
  }
  RBS_INLINE Quaternion<S> loadQuaternion(int number) const {
    return {load(number), load(number + 1), load(number + 2), load(number + 3)};
  }
  RBS_INLINE void storeQuaternion(int number, const Quaternion<S>& q) const {
    store(number, q.x);
    store(number + 1, q.y);
    store(number + 2, q.z);
    store(number + 3, q.w);
  }

 private:
  /// From a pair's first pack to its second, which may be in the next tile.
  static constexpr std::ptrdiff_t kGap = kTile < kWidth<S> ? numbers * kTile : kWidth<S> / 2;

  Place at_;
  double* first_;
};

template <int numbers, class Place>
RBS_INLINE InTile<Place, numbers> inTile(const Place& at, double* tiles) {
  return {at, tiles};
}

}  // namespace
}  // namespace rigid_body_sim::batch

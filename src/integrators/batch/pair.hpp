#pragma once

#include "integrators/batch/pack.hpp"

namespace rigid_body_sim::batch {
namespace {

/// Two packs side by side, as one number. Each operation is one on either pack: while the first
/// waits for what came before, the processor has the second to work on. It looks ahead by itself,
/// but not as far as from one pack's step to the next one's.
template <class P>
struct Pair {
  P first, second;

  Pair() = default;
  RBS_INLINE Pair(P f, P s) : first(f), second(s) {}
  RBS_INLINE Pair(double all) : first(all), second(all) {}
};

template <class P>
struct MaskPair {
  typename MaskOf<P>::Type first, second;
};

template <class S>
constexpr bool kIsPair = false;
template <class P>
constexpr bool kIsPair<Pair<P>> = true;

template <class P>
constexpr int kWidth<Pair<P>> = 2 * kWidth<P>;
template <class P>
struct MaskOf<Pair<P>> {
  using Type = MaskPair<P>;
};

#define RBS_OPERATOR(op)                                 \
  template <class P>                                     \
  RBS_INLINE Pair<P> operator op(Pair<P> a, Pair<P> b) { \
    return {a.first op b.first, a.second op b.second};   \
  }                                                      \
  template <class P>                                     \
  RBS_INLINE Pair<P> operator op(double a, Pair<P> b) {  \
    return {a op b.first, a op b.second};                \
  }                                                      \
  template <class P>                                     \
  RBS_INLINE Pair<P> operator op(Pair<P> a, double b) {  \
    return {a.first op b, a.second op b};                \
  }
RBS_OPERATOR(+)
RBS_OPERATOR(-)
RBS_OPERATOR(*)
RBS_OPERATOR(/)
#undef RBS_OPERATOR

#define RBS_COMPARISON(op)                                   \
  template <class P>                                         \
  RBS_INLINE MaskPair<P> operator op(Pair<P> a, Pair<P> b) { \
    return {a.first op b.first, a.second op b.second};       \
  }                                                          \
  template <class P>                                         \
  RBS_INLINE MaskPair<P> operator op(Pair<P> a, double b) {  \
    return {a.first op b, a.second op b};                    \
  }
RBS_COMPARISON(<)
RBS_COMPARISON(<=)
RBS_COMPARISON(>)
RBS_COMPARISON(>=)
RBS_COMPARISON(==)
#undef RBS_COMPARISON

template <class P>
RBS_INLINE Pair<P> operator-(Pair<P> a) {
  return {-a.first, -a.second};
}
template <class P>
RBS_INLINE MaskPair<P> operator&(MaskPair<P> a, MaskPair<P> b) {
  return {a.first & b.first, a.second & b.second};
}
template <class P>
RBS_INLINE MaskPair<P> operator|(MaskPair<P> a, MaskPair<P> b) {
  return {a.first | b.first, a.second | b.second};
}
template <class P>
RBS_INLINE MaskPair<P> operator!(MaskPair<P> a) {
  return {!a.first, !a.second};
}

template <class P>
RBS_INLINE Pair<P> select(MaskPair<P> mask, Pair<P> a, Pair<P> b) {
  return {select(mask.first, a.first, b.first), select(mask.second, a.second, b.second)};
}
template <class P>
RBS_INLINE unsigned bits(MaskPair<P> mask) {
  return bits(mask.first) | bits(mask.second) << kWidth<P>;
}
template <class P>
RBS_INLINE bool any(MaskPair<P> mask) {
  return any(mask.first | mask.second);
}
template <class P>
RBS_INLINE bool all(MaskPair<P> mask) {
  return all(mask.first & mask.second);
}

template <class P>
RBS_INLINE Pair<P> root(Pair<P> x) {
  return {root(x.first), root(x.second)};
}
template <class P>
RBS_INLINE Pair<P> magnitude(Pair<P> x) {
  return {magnitude(x.first), magnitude(x.second)};
}
template <class P>
RBS_INLINE Pair<P> withSign(Pair<P> x, Pair<P> sign) {
  return {withSign(x.first, sign.first), withSign(x.second, sign.second)};
}
template <class P>
RBS_INLINE Pair<P> mirroredPower(Pair<P> x) {
  return {mirroredPower(x.first), mirroredPower(x.second)};
}

template <class P>
RBS_INLINE double lane(const Pair<P>& x, int i) {
  return i < kWidth<P> ? lane(x.first, i) : lane(x.second, i - kWidth<P>);
}
template <class P>
RBS_INLINE void setLane(Pair<P>& x, int i, double value) {
  if (i < kWidth<P>)
    setLane(x.first, i, value);
  else
    setLane(x.second, i - kWidth<P>, value);
}

template <class P>
struct At<Pair<P>, false> {
  using Number = Pair<P>;
  std::ptrdiff_t begin;

  RBS_INLINE Pair<P> load(const double* column) const { return loadFrom(column + begin); }
  RBS_INLINE void store(double* column, Pair<P> x) const { storeTo(column + begin, x); }
  /// The second pack is `gap` numbers behind the first.
  RBS_INLINE Pair<P> loadFrom(const double* from, std::ptrdiff_t gap = kWidth<P>) const {
    const At<P, false> one = {};
    return {one.loadFrom(from), one.loadFrom(from + gap)};
  }
  RBS_INLINE void storeTo(double* to, Pair<P> x, std::ptrdiff_t gap = kWidth<P>) const {
    const At<P, false> one = {};
    one.storeTo(to, x.first);
    one.storeTo(to + gap, x.second);
  }
};

/// What is left of the last pair as one pack after the other.
template <class P>
struct Packs<Pair<P>> {
  template <class Work>
  RBS_INLINE static void forAll(std::ptrdiff_t begin, std::ptrdiff_t end, const Work& work) {
    constexpr int width = kWidth<Pair<P>>;
    for (; begin + width <= end; begin += width) work(At<Pair<P>, false>{begin});
    Packs<P>::forAll(begin, end, work);
  }
};

}  // namespace
}  // namespace rigid_body_sim::batch

#pragma once

// Numbers of several bodies side by side, and the same operations for a single double, so that one
// formula serves both with the same bits.
//
// By the vector types of GCC and Clang: + - * / and comparisons are the language's own, so that
// only root, absolute value and the question "any?" need to know the processor. xsimd says the same
// in more words, and Ubuntu 20.04 has another version of it with another interface.
//
// Each instruction set is one source file that includes all this. Everything is in a namespace
// without a name, and nothing of the standard library or Eigen is called: a function that the
// linker could share between files would bring instructions into the portable ones that not every
// processor has.

#include <cstddef>
#if defined(__SSE2__)
#include <immintrin.h>
#endif

#define RBS_INLINE [[gnu::always_inline]] inline

namespace rigid_body_sim::batch {
namespace {

/// The compiler's own types; one by one, as it does not take a size that depends on a parameter
/// where it overloads functions.
template <int width>
struct Register;
template <>
struct Register<2> {
  typedef double Reals __attribute__((vector_size(16)));
  typedef long long Bits __attribute__((vector_size(16)));
};
template <>
struct Register<4> {
  typedef double Reals __attribute__((vector_size(32)));
  typedef long long Bits __attribute__((vector_size(32)));
};
template <>
struct Register<8> {
  typedef double Reals __attribute__((vector_size(64)));
  typedef long long Bits __attribute__((vector_size(64)));
};

/// A question's answers: all bits of a lane, or none.
template <int width>
struct Mask {
  using Lanes = typename Register<width>::Bits;
  Lanes lanes;
};

template <int width>
struct Pack {
  using Lanes = typename Register<width>::Reals;
  Lanes lanes;

  Pack() = default;
  RBS_INLINE Pack(Lanes l) : lanes(l) {}
  RBS_INLINE Pack(double all) : lanes(all - Lanes{}) {}  // -0 stays -0, other than in all + 0
};

template <class S>
constexpr int kWidth = 1;
template <int width>
constexpr int kWidth<Pack<width>> = width;

/// What comparisons of S give.
template <class S>
struct MaskOf {
  using Type = bool;
};
template <int width>
struct MaskOf<Pack<width>> {
  using Type = Mask<width>;
};

// One operator for two packs, and for a pack and a constant.
#define RBS_OPERATOR(op)                                 \
  template <int w>                                       \
  RBS_INLINE Pack<w> operator op(Pack<w> a, Pack<w> b) { \
    return {a.lanes op b.lanes};                         \
  }                                                      \
  template <int w>                                       \
  RBS_INLINE Pack<w> operator op(double a, Pack<w> b) {  \
    return {Pack<w>(a).lanes op b.lanes};                \
  }                                                      \
  template <int w>                                       \
  RBS_INLINE Pack<w> operator op(Pack<w> a, double b) {  \
    return {a.lanes op Pack<w>(b).lanes};                \
  }
RBS_OPERATOR(+)
RBS_OPERATOR(-)
RBS_OPERATOR(*)
RBS_OPERATOR(/)
#undef RBS_OPERATOR

#define RBS_COMPARISON(op)                               \
  template <int w>                                       \
  RBS_INLINE Mask<w> operator op(Pack<w> a, Pack<w> b) { \
    return {a.lanes op b.lanes};                         \
  }                                                      \
  template <int w>                                       \
  RBS_INLINE Mask<w> operator op(Pack<w> a, double b) {  \
    return {a.lanes op Pack<w>(b).lanes};                \
  }
RBS_COMPARISON(<)
RBS_COMPARISON(<=)
RBS_COMPARISON(>)
RBS_COMPARISON(>=)
RBS_COMPARISON(==)
#undef RBS_COMPARISON

template <int w>
RBS_INLINE Pack<w> operator-(Pack<w> a) {
  return {-a.lanes};
}
template <int w>
RBS_INLINE Mask<w> operator&(Mask<w> a, Mask<w> b) {
  return {a.lanes & b.lanes};
}
template <int w>
RBS_INLINE Mask<w> operator|(Mask<w> a, Mask<w> b) {
  return {a.lanes | b.lanes};
}
template <int w>
RBS_INLINE Mask<w> operator!(Mask<w> a) {
  return {~a.lanes};
}

RBS_INLINE double select(bool mask, double a, double b) { return mask ? a : b; }
template <int w>
RBS_INLINE Pack<w> select(Mask<w> mask, Pack<w> a, Pack<w> b) {
  return {mask.lanes ? a.lanes : b.lanes};
}

RBS_INLINE bool any(bool mask) { return mask; }
RBS_INLINE bool all(bool mask) { return mask; }
RBS_INLINE unsigned bits(bool mask) { return mask ? 1 : 0; }

RBS_INLINE double root(double x) { return __builtin_sqrt(x); }
RBS_INLINE double magnitude(double x) { return __builtin_fabs(x); }
RBS_INLINE double withSign(double x, double sign) { return __builtin_copysign(x, sign); }

// A mask's lanes as the bits of a number, and the roots of lanes.
#if defined(__SSE2__)
RBS_INLINE unsigned bits(Mask<2> mask) {
  return static_cast<unsigned>(_mm_movemask_pd(reinterpret_cast<__m128d>(mask.lanes)));
}
RBS_INLINE Pack<2> root(Pack<2> x) { return {_mm_sqrt_pd(x.lanes)}; }
#else
RBS_INLINE unsigned bits(Mask<2> mask) {
  return (mask.lanes[0] ? 1u : 0u) | (mask.lanes[1] ? 2u : 0u);
}
RBS_INLINE Pack<2> root(Pack<2> x) {
  return {Pack<2>::Lanes{__builtin_sqrt(x.lanes[0]), __builtin_sqrt(x.lanes[1])}};
}
#endif
#if defined(__AVX__)
RBS_INLINE unsigned bits(Mask<4> mask) {
  return static_cast<unsigned>(_mm256_movemask_pd(reinterpret_cast<__m256d>(mask.lanes)));
}
RBS_INLINE Pack<4> root(Pack<4> x) { return {_mm256_sqrt_pd(x.lanes)}; }
#endif
#if defined(__AVX512F__) && defined(__AVX512DQ__)
RBS_INLINE unsigned bits(Mask<8> mask) {
  return _mm512_movepi64_mask(reinterpret_cast<__m512i>(mask.lanes));
}
// The plain form makes GCC 12 warn of an operand that is not used.
RBS_INLINE Pack<8> root(Pack<8> x) { return {_mm512_maskz_sqrt_pd(0xff, x.lanes)}; }
#endif

template <int w>
RBS_INLINE bool any(Mask<w> mask) {
  return bits(mask) != 0;
}
template <int w>
RBS_INLINE bool all(Mask<w> mask) {
  return bits(mask) == (1u << w) - 1;
}

template <int w>
RBS_INLINE Pack<w> ofBits(typename Mask<w>::Lanes lanes) {
  return {reinterpret_cast<typename Pack<w>::Lanes>(lanes)};
}
template <int w>
RBS_INLINE typename Mask<w>::Lanes bitsOf(Pack<w> x) {
  return reinterpret_cast<typename Mask<w>::Lanes>(x.lanes);
}
constexpr long long kSignBit = static_cast<long long>(1ull << 63);
template <int w>
RBS_INLINE Pack<w> magnitude(Pack<w> x) {
  return ofBits<w>(bitsOf(x) & ~kSignBit);
}
/// The size of x, and the sign of `sign`.
template <int w>
RBS_INLINE Pack<w> withSign(Pack<w> x, Pack<w> sign) {
  return ofBits<w>((bitsOf(x) & ~kSignBit) | (bitsOf(sign) & kSignBit));
}

/// 2^(1023 - n) with 2^n <= |x| < 2^(n+1), for -1022 <= n <= 1022.
template <int w>
RBS_INLINE Pack<w> mirroredPower(Pack<w> x) {
  return ofBits<w>(0x7fe0000000000000 - (bitsOf(x) & 0x7ff0000000000000));
}
RBS_INLINE double mirroredPower(double x) {
  long long lanes;
  __builtin_memcpy(&lanes, &x, sizeof(x));
  lanes = 0x7fe0000000000000 - (lanes & 0x7ff0000000000000);
  __builtin_memcpy(&x, &lanes, sizeof(x));
  return x;
}
/// 1 / 2^n with 2^n <= |x| < 2^(n+1); for subnormal x, of the smallest normal one.
template <class S>
RBS_INLINE S inversePower(S x) {
  return 0.5 * mirroredPower(0.5 * x);
}

#if defined(__AVX2__)
/// The first `count` lanes.
RBS_INLINE Register<4>::Bits firstLanes(int count) {
  const Register<4>::Bits index = {0, 1, 2, 3};
  return index < count;
}
#endif

/// The first `count` numbers; the other lanes repeat the first one.
template <class S>
RBS_INLINE S loadPart(const double* from, int count) {
#if defined(__AVX512F__)
  if constexpr (kWidth<S> == 8)
    return S(_mm512_mask_loadu_pd(S(*from).lanes, (1u << count) - 1, from));
#endif
#if defined(__AVX2__)
  if constexpr (kWidth<S> == 4) {
    const auto which = firstLanes(count);
    const __m256d loaded = _mm256_maskload_pd(from, (__m256i)which);
    return S(_mm256_blendv_pd(S(*from).lanes, loaded, (__m256d)which));
  }
#endif
  S x;
  for (int i = 0; i < kWidth<S>; ++i) x.lanes[i] = from[i < count ? i : 0];
  return x;
}
template <class S>
RBS_INLINE void storePart(double* to, S x, int count) {
#if defined(__AVX512F__)
  if constexpr (kWidth<S> == 8) return _mm512_mask_storeu_pd(to, (1u << count) - 1, x.lanes);
#endif
#if defined(__AVX2__)
  if constexpr (kWidth<S> == 4) return _mm256_maskstore_pd(to, (__m256i)firstLanes(count), x.lanes);
#endif
  for (int i = 0; i < count; ++i) to[i] = x.lanes[i];
}

/// Which numbers of the columns a pack is: those from `begin` on. With is_part only the first
/// `count` of them; the other lanes then repeat the first, so that they cannot take a longer way.
template <class S, bool is_part>
struct At {
  using Number = S;
  std::ptrdiff_t begin;
  int count = kWidth<S>;

  RBS_INLINE S load(const double* column) const { return loadFrom(column + begin); }
  RBS_INLINE void store(double* column, S x) const { storeTo(column + begin, x); }

  RBS_INLINE S loadFrom(const double* from) const {
    if constexpr (kWidth<S> == 1) {
      return *from;
    } else if constexpr (is_part) {
      return loadPart<S>(from, count);
    } else {
      S x;
      __builtin_memcpy(&x.lanes, from, sizeof(x.lanes));
      return x;
    }
  }

  RBS_INLINE void storeTo(double* to, S x) const {
    if constexpr (kWidth<S> == 1) {
      *to = x;
    } else if constexpr (is_part) {
      storePart(to, x, count);
    } else {
      __builtin_memcpy(to, &x.lanes, sizeof(x.lanes));
    }
  }
};

/// Of a place that a function got by reference.
template <class Place>
struct NumberOfPlace;
template <class S, bool is_part>
struct NumberOfPlace<const At<S, is_part>&> {
  using Type = S;
};
template <class Place>
using NumberOf = typename NumberOfPlace<Place>::Type;

/// A lane's number.
RBS_INLINE double lane(double x, int) { return x; }
RBS_INLINE void setLane(double& x, int, double value) { x = value; }
template <int w>
RBS_INLINE double lane(const Pack<w>& x, int i) {
  return x.lanes[i];
}
template <int w>
RBS_INLINE void setLane(Pack<w>& x, int i, double value) {
  x.lanes[i] = value;
}

/// Calls `work` for all numbers from `begin` to `end`, a pack at a time. A single one is worked on
/// as a plain double, which costs it least.
template <class S>
struct Packs {
  template <class Work>
  RBS_INLINE static void forAll(std::ptrdiff_t begin, std::ptrdiff_t end, const Work& work) {
    constexpr int width = kWidth<S>;
    for (; begin + width <= end; begin += width) work(At<S, false>{begin});
    if (width == 1 || begin == end) return;
    if (begin + 1 == end)
      work(At<double, false>{begin});
    else
      work(At<S, true>{begin, static_cast<int>(end - begin)});
  }
};
template <class S, class Work>
RBS_INLINE void forPacks(std::ptrdiff_t begin, std::ptrdiff_t end, const Work& work) {
  Packs<S>::forAll(begin, end, work);
}

}  // namespace
}  // namespace rigid_body_sim::batch

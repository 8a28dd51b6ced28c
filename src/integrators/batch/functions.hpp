#pragma once

#include "integrators/batch/pair.hpp"
#include "integrators/batch/rare.hpp"

// Sine and cosine of our own, as those of the C library have no form for packs, and other last bits
// on other processors.
namespace rigid_body_sim::batch {
namespace {

template <class S>
struct SinCos {
  S sin;
  S cos;
};

/// sin(x)/x - 1 and cos(x) - 1 + x^2/2, by z = x^2 <= (pi/4)^2, each over the power of z that they
/// begin with. Minimax polynomials of fdlibm (Sun Microsystems 1993, k_sin.c and k_cos.c), good to
/// 2^-58. Evaluated in two halves (Estrin), as a chain of all would keep a single body waiting.
template <class S>
RBS_INLINE S sincTail(S z) {
  const S z2 = z * z;
  const S low = -1.66666666666666324348e-01 + z * 8.33333333332248946124e-03;
  const S middle = -1.98412698298579493134e-04 + z * 2.75573137070700676789e-06;
  const S high = -2.50507602534068634195e-08 + z * 1.58969099521155010221e-10;
  return low + z2 * (middle + z2 * high);
}
template <class S>
RBS_INLINE S cosTail(S z) {
  const S z2 = z * z;
  const S low = 4.16666666666666019037e-02 + z * -1.38888888888741095749e-03;
  const S middle = 2.48015872894767294178e-05 + z * -2.75573143513906633035e-07;
  const S high = 2.08757232129817482790e-09 + z * -1.13596475577881948265e-11;
  return low + z2 * (middle + z2 * high);
}

/// cos of the x with x^2 = z; the rounding of 1 - z/2 is put back.
template <class S>
RBS_INLINE S cosOfSquare(S z) {
  const S half = 0.5 * z;
  const S w = 1 - half;
  return w + (((1 - w) - half) + z * z * cosTail(z));
}

constexpr double kRounder = 6755399441055744.0;  // 1.5 * 2^52: adding it rounds to whole numbers

/// Beyond this, n in sinCos() has more than 20 bits, and n times a part of pi/2 is rounded.
constexpr double kLargestAngle = 1 << 20;

/// sin and cos for |x| <= kLargestAngle. x - n pi/2 with pi/2 in three parts of 33 bits and the
/// rest (Cody and Waite 1980; the parts are fdlibm's, e_rem_pio2.c).
template <class S>
RBS_INLINE SinCos<S> sinCosOfModerate(S x) {
  const S n = (x * 6.36619772367581382433e-01 + kRounder) - kRounder;
  const S first = x - n * 1.57079632673412561417e+00;  // exact, as is the next product
  const S second = n * 6.07710050630396597660e-11;
  const S coarse = first - second;
  const S fine = n * 2.02226624879595063154e-21 - ((first - coarse) - second);
  const S r = coarse - fine;
  const S tail = (coarse - r) - fine;
  const S z = r * r;
  const S c0 = cosOfSquare(z);
  const S s = r + (r * z * sincTail(z) + tail);
  const S c = c0 - r * tail;
  // Which quarter: -2 ... 2, where both 2 and -2 are half a turn.
  const S quarter = n - 4 * ((0.25 * n + kRounder) - kRounder);
  const S size = magnitude(quarter);
  const auto is_odd = size == 1;
  return {select(is_odd, quarter * c, (1 - size) * s),
          select(is_odd, -(quarter * s), (1 - size) * c)};
}

RBS_INLINE void setOfHuge(double x, double& sin, double& cos) { sinCosOfHuge(x, &sin, &cos); }
template <class S>
[[gnu::cold, gnu::noinline]] void replaceHuge(const S& x, SinCos<S>& f) {
  for (int i = 0; i < kWidth<S>; ++i) {
    if (__builtin_fabs(lane(x, i)) <= kLargestAngle) continue;
    double s, c;
    setOfHuge(lane(x, i), s, c);
    setLane(f.sin, i, s);
    setLane(f.cos, i, c);
  }
}
RBS_INLINE void replaceHuge(double x, SinCos<double>& f) { setOfHuge(x, f.sin, f.cos); }

/// Below this n is 0 in any case.
constexpr double kLargestSmallAngle = 0.785;

/// sin and cos of x [rad]. The short way for small angles has the same bits as the long one.
template <class S>
RBS_INLINE SinCos<S> sinCos(S x) {
  if (all(magnitude(x) <= kLargestSmallAngle)) {
    const S z = x * x;
    return {x + x * z * sincTail(z), cosOfSquare(z)};
  }
  const auto is_moderate = magnitude(x) <= kLargestAngle;
  if (__builtin_expect(all(is_moderate), 1)) return sinCosOfModerate(x);
  SinCos<S> f = sinCosOfModerate(select(is_moderate, x, S(0.0)));
  replaceHuge(x, f);
  return f;
}

/// cos(x) and sin(x)/x for x^2 >= 0.
template <class S>
struct CosSinc {
  S cos;
  S sinc;
};

/// The polynomials' range, (pi/4)^2. There neither root nor division is needed.
constexpr double kLargestSquare = 0.6168;

template <class S>
RBS_INLINE CosSinc<S> cosSincOfSmall(S x2) {
  return {cosOfSquare(x2), 1 + x2 * sincTail(x2)};
}

template <class S>
RBS_INLINE CosSinc<S> cosSinc(S x2) {
  const auto is_small = x2 <= kLargestSquare;
  if (all(is_small)) return cosSincOfSmall(x2);
  // The others' numbers must not overflow in the polynomials, nor zeros be divided by.
  const CosSinc<S> f = cosSincOfSmall(select(is_small, x2, S(0.0)));
  const S x = root(select(is_small, S(1.0), x2));
  const SinCos<S> g = sinCos(x);
  return {select(is_small, f.cos, g.cos), select(is_small, f.sinc, g.sin / x)};
}

}  // namespace
}  // namespace rigid_body_sim::batch

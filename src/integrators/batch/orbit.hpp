#pragma once

#include "integrators/batch/vectors.hpp"

// Free rotation by Jacobi's elliptic functions. The momentum circles around the body axis d, 1 or
// 3, whose component never changes sign; c is the other outer axis, 2 the middle one. So that packs
// need no cases, everything is worked out as if d were body axis 3, see fromOrbit(), and a long
// step is halved until the series hold, and doubled again by the addition theorems.
namespace rigid_body_sim::batch {
namespace {

/// What free rotation needs of the principal moments I1 <= I2 <= I3 [kg m^2].
template <class S>
struct InverseMoments {
  S a2;   ///< 1/I2 [1/(kg m^2)]
  S a13;  ///< 1/I1 - 1/I3 [1/(kg m^2)]
  S d12;  ///< (1/I1 - 1/I2) / a13, zero for a sphere
  S d23;  ///< (1/I2 - 1/I3) / a13, zero for a sphere
};

template <class S>
RBS_INLINE InverseMoments<S> inverseMoments(const Vector<S>& I) {
  const auto is_sphere = !(I.z > I.x);
  const S range = select(is_sphere, S(1.0), I.z - I.x);
  const S none(0.0);
  return {1 / I.y, (I.z - I.x) / I.x / I.z,
          select(is_sphere, none, (I.y - I.x) / range * (I.z / I.y)),
          select(is_sphere, none, (I.z - I.y) / range * (I.x / I.y))};
}

/// 1 / root(x), where the division need not wait for the root; 1 / x must not overflow.
template <class S>
RBS_INLINE S inverseRoot(S x) {
  return root(x) * (1 / x);
}

/// Length and direction of a vector of any size; without direction for zero.
template <class S>
struct Direction {
  S G;
  Vector<S> m;
};

template <class S>
RBS_INLINE Direction<S> directionOf(const Vector<S>& v) {
  const S square = dot(v, v);
  const auto is_usual = (square > 1e-280) & (square < 1e280);
  const S usual = select(is_usual, square, S(1.0));
  Direction<S> d = {root(usual), inverseRoot(usual) * v};
  if (!all(is_usual)) {
    const S scale = inversePower(largest(v));
    const Vector<S> near_one = scale * v;
    const S size2 = dot(near_one, near_one);
    d.G = select(is_usual, d.G, root(size2) / scale);
    d.m = select(is_usual, d.m, inverseRoot(size2) * near_one);
  }
  return d;
}

/// Constants of a free rotation, for momentum of unit length and time in units of 1/(a13 |L|), so
/// that they are pure numbers of moderate size.
template <class S>
struct Orbit {
  using Question = typename MaskOf<S>::Type;
  Question is_around_1;
  Question is_fixed_axis;  ///< the others' numbers are then those of no orbit, but finite
  S about;                 ///< -1 around axis 1, 1 around axis 3
  S md, mc, m2;            ///< the momentum
  S dc, dd;          ///< differences of inverse moments: the middle one's to that of c and of d
  S W, R;            ///< conserved; R = 0 on a principal axis
  S lambda;          ///< rate of the elliptic argument
  S inverse_lambda;  ///< 1 / lambda
  S k2, kc2;         ///< modulus
  S one_minus_n;     ///< |S| / W
  S n;               ///< dc / W
};

template <class S>
RBS_INLINE Orbit<S> orbitOf(const Vector<S>& m, const InverseMoments<S>& a) {
  const S one(1.0);
  Orbit<S> o;
  const S side = m.x * m.x * a.d12 - m.z * m.z * a.d23;
  o.is_around_1 = (side > 0) | ((side == 0) & (a.d12 > a.d23));
  o.about = select(o.is_around_1, -one, one);
  o.md = select(o.is_around_1, m.x, m.z);
  o.mc = select(o.is_around_1, m.z, m.x);
  o.m2 = m.y;
  o.dc = select(o.is_around_1, a.d23, a.d12);
  o.dd = select(o.is_around_1, a.d12, a.d23);
  o.W = m.y * m.y * o.dc + o.md * o.md;
  o.R = o.mc * o.mc + m.y * m.y * o.dd;
  // A momentum that is off the axis by less than 1e-30 of it circles around it unseen; and an orbit
  // that slow stands still. Fourth powers of the one and inverses of the other stay in range.
  o.is_fixed_axis = !((o.dd * o.W > 1e-200) & (o.R > 1e-60));
  o.W = select(o.is_fixed_axis, one, o.W);
  o.dd = select(o.is_fixed_axis, one, o.dd);
  o.R = select(o.is_fixed_axis, one, o.R);
  const S square = o.dd * o.W;
  o.lambda = root(square);
  const S scale = 1 / square;
  o.inverse_lambda = o.lambda * scale;
  const S k2 = o.dc * o.R * scale, kc2 = magnitude(side) * scale;
  o.k2 = select(k2 < kc2, k2, 1 - kc2);
  o.kc2 = select(k2 < kc2, 1 - k2, kc2);
  const S inverse_W = o.dd * scale;
  // Of a sphere it would be 0, as would be the length of a complex number in doubled().
  o.one_minus_n = select(o.is_fixed_axis, one, magnitude(side) * inverse_W);
  o.n = o.dc * inverse_W;
  return o;
}

/// From the axes (c, 2, d) to those of the body. Around axis 3 they are the body's; around axis 1
/// two axes are swapped, which makes the system left-handed, and turns go the other way.
template <class S>
RBS_INLINE Quaternion<S> fromOrbit(typename MaskOf<S>::Type is_around_1, S about,
                                   const Quaternion<S>& q) {
  return {select(is_around_1, -q.z, q.x), about * q.y, select(is_around_1, -q.x, q.z), q.w};
}
template <class S>
RBS_INLINE Vector<S> momentumFromOrbit(typename MaskOf<S>::Type is_around_1, S mc, S m2, S md) {
  return {select(is_around_1, md, mc), m2, select(is_around_1, mc, md)};
}

template <class S>
RBS_INLINE HalfAngle<S> operator*(const HalfAngle<S>& a, const HalfAngle<S>& b) {
  return {a.cos * b.cos - a.sin * b.sin, a.cos * b.sin + a.sin * b.cos};
}
template <class S>
RBS_INLINE HalfAngle<S> normalized(const HalfAngle<S>& a) {
  const S scale = 1 / root(a.cos * a.cos + a.sin * a.sin);
  return {scale * a.cos, scale * a.sin};
}
/// Of a length from 0.7 to 2, without a rounding.
template <class S>
RBS_INLINE HalfAngle<S> nearOne(const HalfAngle<S>& a) {
  const S scale = inversePower(magnitude(a.cos) + magnitude(a.sin));
  return {scale * a.cos, scale * a.sin};
}

/// Half of the argument of a complex number, not zero, but for its length.
/// It is that of the root, which takes no trigonometric function: sqrt(z) is along z + |z|, and
/// where that cancels along i (|z| - re) + im.
template <class S>
RBS_INLINE HalfAngle<S> rootDirection(S re, S im, S length) {
  const S sum = length + magnitude(re);
  const auto is_right = re >= 0;
  return {select(is_right, sum, magnitude(im)), select(is_right, im, withSign(sum, im))};
}
template <class S>
RBS_INLINE HalfAngle<S> rootDirection(S re, S im) {
  return rootDirection(re, im, root(re * re + im * im));
}

/// sn, cn, dn of one argument.
template <class S>
struct Jacobi {
  S sn, cn, dn;
};

/// Where the series for sn holds, to 2e-17 of it (Abramowitz and Stegun 16.22.1, to u^11).
constexpr double kLargestArgument = 1.0 / 16;

template <class S>
RBS_INLINE Jacobi<S> jacobiOfSmall(S u, S k2) {
  const S c1 = (1 + k2) * (-1.0 / 6);
  const S c2 = (1 + k2 * (14 + k2)) * (1.0 / 120);
  const S c3 = (1 + k2 * (135 + k2 * (135 + k2))) * (-1.0 / 5040);
  const S c4 = (1 + k2 * (1228 + k2 * (5478 + k2 * (1228 + k2)))) * (1.0 / 362880);
  const S c5 =
      (1 + k2 * (11069 + k2 * (165826 + k2 * (165826 + k2 * (11069 + k2))))) * (-1.0 / 39916800);
  const S x = u * u, x2 = x * x;
  const S sn = u + u * x * (c1 + x * c2 + x2 * (c3 + x * c4 + x2 * c5));
  const S s2 = sn * sn;
  return {sn, root(1 - s2), root(1 - k2 * s2)};
}

/// Integral of sn^2 / (1 - n sn^2) from 0 to u, by its series in x = sn^2. At
/// sn = 1/16 the first term left out is 5e-15 of the integral, which is then 1e-3 of u.
template <class S>
RBS_INLINE S integralOfSmall(S sn, S k2, S n) {
  const S x = sn * sn, k = 1 + k2;
  const S p1 = 0.5 * k;
  const S p2 = 0.75 * k * p1 - 0.5 * k2;
  const S p3 = (5.0 / 6) * k * p2 - (2.0 / 3) * k2 * p1;
  const S p4 = (7.0 / 8) * k * p3 - (3.0 / 4) * k2 * p2;
  const S p5 = (9.0 / 10) * k * p4 - (4.0 / 5) * k2 * p3;
  const S c1 = p1 + n, c2 = p2 + n * c1, c3 = p3 + n * c2, c4 = p4 + n * c3, c5 = p5 + n * c4;
  return sn * x *
         (1.0 / 3 +
          x * ((1.0 / 5) * c1 +
               x * ((1.0 / 7) * c2 +
                    x * ((1.0 / 9) * c3 + x * ((1.0 / 11) * c4 + x * ((1.0 / 13) * c5))))));
}

/// What a step of an orbit takes.
template <class S>
struct OrbitStep {
  Jacobi<S> f;         ///< of its elliptic argument
  S linear;            ///< [rad] part of the slow angle that is left as an angle
  HalfAngle<S> other;  ///< and the rest of it, but for its length
};

/// The step of twice the argument. sn, cn, dn: Abramowitz and Stegun 16.18, with k^2 eliminated so
/// that every sum but that of cn is of one sign. The integral of the third kind: P.F. Byrd and M.D.
/// Friedman, Handbook of Elliptic Integrals (1971), 116.03; its angle is atan2(im, re).
template <class S>
RBS_INLINE OrbitStep<S> doubled(const OrbitStep<S>& half, const Orbit<S>& o) {
  const Jacobi<S>& f = half.f;
  const S s2 = f.sn * f.sn, c2 = f.cn * f.cn, d2 = f.dn * f.dn;
  const S scale = 1 / (c2 + s2 * d2);
  OrbitStep<S> whole;
  S sn = 2 * f.sn * f.cn * f.dn * scale;
  S cn = (c2 * c2 - o.kc2 * s2 * s2) * scale;
  const S unit = 1.5 - 0.5 * (sn * sn + cn * cn);
  sn = unit * sn;
  cn = unit * cn;
  whole.f = {sn, cn, (c2 * d2 + o.kc2 * s2) * scale};
  const S re = o.one_minus_n + o.n * cn * c2;
  const S im = o.one_minus_n * o.dc * o.inverse_lambda * s2 * sn;
  whole.linear = 2 * half.linear;
  whole.other = nearOne((half.other * half.other) * rootDirection(re, im));
  return whole;
}

/// @param time the step in the orbit's own unit, any sign
template <class S>
RBS_INLINE OrbitStep<S> orbitStep(const Orbit<S>& o, S time) {
  S u = select(o.is_fixed_axis, S(0.0), o.lambda * time);
  // Beyond 1e16 a double has no phase any more.
  u = select(magnitude(u) > 1e16, withSign(S(1e16), u), u);
  S doublings_left(1.0);  // as a power of two
  for (auto is_long = magnitude(u) > kLargestArgument; any(is_long);
       is_long = magnitude(u) > kLargestArgument) {
    u = select(is_long, 0.5 * u, u);
    doublings_left = select(is_long, 2 * doublings_left, doublings_left);
  }
  OrbitStep<S> step;
  step.f = jacobiOfSmall(u, o.k2);
  step.linear = o.one_minus_n * o.dc * o.inverse_lambda * integralOfSmall(step.f.sn, o.k2, o.n);
  step.other = {S(1.0), S(0.0)};
  for (auto goes_on = doublings_left > 1; any(goes_on); goes_on = doublings_left > 1) {
    const OrbitStep<S> next = doubled(step, o);
    step.linear = select(goes_on, next.linear, step.linear);
    // On the separatrix the momentum has come to the middle axis when dn = cn is that small, and
    // stays; their squares would leave the range of numbers.
    const auto moves = goes_on & (step.f.dn > 1e-30);
    step.f = {select(moves, next.f.sn, step.f.sn), select(moves, next.f.cn, step.f.cn),
              select(moves, next.f.dn, step.f.dn)};
    step.other = {select(moves, next.other.cos, step.other.cos),
                  select(moves, next.other.sin, step.other.sin)};
    doublings_left = 0.5 * doublings_left;
  }
  step.other =
      step.other * rootDirection(step.f.dn, o.dc * o.inverse_lambda * step.f.sn * step.f.cn);
  return step;
}

}  // namespace
}  // namespace rigid_body_sim::batch

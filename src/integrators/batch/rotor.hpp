#pragma once

#include "integrators/batch/orbit.hpp"

namespace rigid_body_sim::batch {
namespace {

/// What a torque-free body does in some time.
template <class S>
struct FreeRotation {
  Quaternion<S> q_BBnext;  ///< attitude after, in the axes before: q_WB' = q_WB q_BBnext
  Vector<S> m_B;           ///< angular momentum after, in the body's axes after [kg m^2/s]
};

/// Half of the angle by which a body turns about its momentum, as seen along axis d and in orbit's
/// axes, but for its length and the angle between the momenta.
template <class S>
RBS_INLINE HalfAngle<S> slowTurn(const Orbit<S>& o, const InverseMoments<S>& a, const S& G,
                                 double h, const OrbitStep<S>& step) {
  return halfAngle(o.about * (h * (a.a2 * G)) + step.linear) * step.other;
}

/// The free rotation of a body with the principal moments I1 <= I2 <= I3 [kg m^2] and the angular
/// momentum m_B [kg m^2/s] in its axes, not zero, for h [s] (any sign): exact up to rounding.
///
/// Jacobi's solution in addition-theorem form: momentum and attitude after h follow from those
/// before and sn, cn, dn of one argument, without ever inverting for the phase. It works on the
/// momentum of unit length, so that nothing over- or underflows. Every sum in it is of terms of one
/// sign or of order one, so its error is a few roundings of the inputs' own sensitivity. Elliptic
/// solution: Jacobi 1849; R. van Zon and J. Schofield, J. Comput. Phys. 225 (2007) 145; E.
/// Celledoni, F. Fasso, N. Safstrom and A. Zanna, SIAM J. Sci. Comput. 30 (2008) 2084.
template <class S>
RBS_INLINE FreeRotation<S> exactRotation(const Vector<S>& m_B, const Vector<S>& I,
                                         const InverseMoments<S>& a, double h) {
  const Direction<S> momentum = directionOf(m_B);
  Orbit<S> o = orbitOf(momentum.m, a);
  const S one(1.0);
  const auto turns = !o.is_fixed_axis;
  o.md = select(turns, o.md, one);  // lest a momentum across d divides by zero
  const OrbitStep<S> step = orbitStep(o, h * (a.a13 * momentum.G));
  const Jacobi<S>& f = step.f;
  const S s = f.sn * o.inverse_lambda;
  const S q = o.W / (o.md * o.md + o.m2 * o.m2 * o.dc * (f.cn * f.cn));
  const S md = (o.md * f.dn - o.dc * s * o.mc * o.m2 * f.cn) * q;
  const S mc = (o.mc * f.cn - o.dd * s * o.m2 * o.md * f.dn) * q;
  const S m2 = (o.m2 * f.cn * f.dn + s * o.mc * o.md) * q;

  // The angle between the momenta as seen along d, as the argument of a complex number.
  const S sign_d = withSign(one, o.md);
  const S num = -(s * o.dc * o.m2 * m2);
  const S den = o.R + o.dc * m2 * m2 - o.dc * s * o.m2 * mc * md;
  const S cross = sign_d * (o.mc * m2 - o.m2 * mc);
  const S dot = o.mc * mc + o.m2 * m2;
  const S re = den * dot + num * cross, im = num * dot - den * cross;
  // |re + i im|, as in nextPsi(): of either factor the root of these sums, but for a constant.
  const S length =
      root(1 + o.dc * o.W * (s * s)) * ((o.mc * o.mc + o.m2 * o.m2) * (mc * mc + m2 * m2));
  HalfAngle<S> seen = rootDirection(re, im, length);
  S seen_square = 2 * length * (length + magnitude(re));
  seen.cos = select(turns, seen.cos, one);  // on the axis there is nothing to see
  seen_square = select(turns, seen_square, one);
  const HalfAngle<S> slow = slowTurn(o, a, momentum.G, h, step);
  HalfAngle<S> spin = slow * seen;
  spin.sin = sign_d * spin.sin;

  // P^-1 (spin about d) P', with P the shortest rotation of the momentum before to the axis d, P'
  // of that after; |P|^2 = 2 (1 + |md|).
  const S before = 1 + magnitude(o.md), after = 1 + magnitude(md);
  const S slow_square = slow.cos * slow.cos + slow.sin * slow.sin;
  const S C = spin.cos, D = spin.sin;
  const S x = sign_d * mc, y = sign_d * m2;
  const Quaternion<S> first = {-(sign_d * o.m2), sign_d * o.mc, S(0.0), before};
  const Quaternion<S> then = {C * y + D * x, D * y - C * x, D * after, C * after};
  const S scale = inverseRoot(4 * before * after * slow_square * seen_square);
  const Quaternion<S> turn = fromOrbit(o.is_around_1, o.about, scaled(scale, first * then));
  const Vector<S> next = momentum.G * momentumFromOrbit(o.is_around_1, mc, m2, md);
  if (all(turns)) return {turn, next};
  const S none(0.0);
  const Vector<S> m_fixed = select(turns, Vector<S>{none, none, none}, m_B);
  const Quaternion<S> about_axis = rotationExp(h * quotient(m_fixed, I));
  return {select(turns, turn, about_axis), select(turns, next, m_B)};
}

}  // namespace
}  // namespace rigid_body_sim::batch

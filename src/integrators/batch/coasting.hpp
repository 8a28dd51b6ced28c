#pragma once

#include "integrators/batch/rotor.hpp"

namespace rigid_body_sim::batch {
namespace {

/// sn, cn and dn of a coasting body's phase.
template <class S>
struct Phase {
  S s, c, d;
};

/// Free rotation in equal steps. All of exactRotation() but the phase depends only on |m|, energy
/// and step: that is worked out once, and a step is one addition theorem of sn, cn, dn and one
/// product of complex numbers, without any trigonometric or elliptic function.
///
/// What is stepped is the phase on the orbit, not the momentum: the map of the momentum is unstable
/// off its own orbit, that of the phase is brought back to it. Nothing is read back from the
/// attitude, so its rounding does not add up. Axes are the orbit's; E is the momentum's axis there,
/// that of d with the momentum's sign. Turns about it are counted as in a right-handed orbit, whose
/// d is the momentum's way, and the phase's dn is positive; signs are put back where attitude and
/// momentum are made. A body that turns about a fixed axis is one whose phase stands still.
template <class S>
struct Coasting {
  // Constants.
  Quaternion<S> q_WE;       ///< attitude without psi and with the momentum along d
  HalfAngle<S> turn;        ///< a step's about E, but for the angle between the momenta
  Jacobi<S> of_step;        ///< sn = 0: fixed axis
  S kc2, num, den, length;  ///< see nextPsi()
  S root_dd;                ///< negative around axis 1
  S B_2;                    ///< largest size of m2; negative around axis 1
  S B_d;                    ///< md = B_d dn of the phase
  S G;
  // What moves.
  S s, c;            ///< of the phase
  HalfAngle<S> psi;  ///< of a length near one, but not one: that would take a root
};

/// dn is worked out from the other two, so that they stay those of one argument.
template <class S>
RBS_INLINE Phase<S> phaseOf(const Coasting<S>& x) {
  return {x.s, x.c, root(x.c * x.c + x.kc2 * (x.s * x.s))};
}

/// The momentum along c, 2 and d, for G = 1.
template <class S>
struct OrbitMomentum {
  S c, two, d;
};

template <class S>
RBS_INLINE OrbitMomentum<S> momentumOf(const Coasting<S>& x) {
  return {x.B_2 * x.root_dd * x.c, withSign(x.B_2, x.B_d) * x.s, x.B_d * phaseOf(x).d};
}
template <class S>
RBS_INLINE Vector<S> bodyMomentumOf(const Coasting<S>& x) {
  const OrbitMomentum<S> m = momentumOf(x);
  return x.G * momentumFromOrbit(x.root_dd < 0, m.c, m.two, m.d);
}

/// Puts what a body that turns about a fixed axis needs where `is_fixed`.
template <class S>
RBS_INLINE void setFixedAxis(typename MaskOf<S>::Type is_fixed, const Orbit<S>& o, const S& angle,
                             Coasting<S>& x) {
  const S one(1.0), none(0.0);
  x.of_step = {select(is_fixed, none, x.of_step.sn), select(is_fixed, one, x.of_step.cn),
               select(is_fixed, one, x.of_step.dn)};
  x.kc2 = select(is_fixed, one, x.kc2);
  x.num = select(is_fixed, none, x.num);
  x.den = select(is_fixed, none, x.den);
  x.length = select(is_fixed, one, x.length);
  x.root_dd = select(is_fixed, o.about, x.root_dd);
  const S across = root(o.mc * o.mc + o.m2 * o.m2);
  const auto is_along = across == 0;
  const S safe = select(is_along, one, across);
  const S sign_d = withSign(one, o.md);
  x.B_2 = select(is_fixed, o.about * across, x.B_2);
  x.B_d = select(is_fixed, o.md, x.B_d);
  x.s = select(is_fixed, sign_d * o.m2 / safe, x.s);
  x.c = select(is_fixed, select(is_along, one, o.mc / safe), x.c);
  const HalfAngle<S> turn = halfAngle(o.about * angle);
  x.turn = {select(is_fixed, turn.cos, x.turn.cos), select(is_fixed, turn.sin, x.turn.sin)};
}

/// @param m_B not zero
template <class S>
RBS_INLINE Coasting<S> coastingOf(const Quaternion<S>& q_WB, const Vector<S>& m_B,
                                  const Vector<S>& I, const InverseMoments<S>& a, double h) {
  const S one(1.0);
  const Direction<S> momentum = directionOf(m_B);
  const Orbit<S> o = orbitOf(momentum.m, a);
  const OrbitStep<S> step = orbitStep(o, h * (a.a13 * momentum.G));
  Coasting<S> x;
  x.turn = normalized(slowTurn(o, a, momentum.G, h, step));
  x.of_step = step.f;
  x.kc2 = o.kc2;
  x.num = -(o.about * (o.dc / (o.lambda * o.dd)) * step.f.sn);
  x.den = o.dc / o.dd;
  x.length = root(1 + x.den * (step.f.sn * step.f.sn)) / o.dd;
  const S root_dd = root(o.dd);
  x.root_dd = o.about * root_dd;
  x.B_2 = o.about * (root(o.R) / root_dd);
  x.B_d = withSign(root(o.W), o.md);
  x.G = momentum.G;
  const S sign_d = withSign(one, o.md);
  x.s = sign_d * o.m2 / magnitude(x.B_2);
  x.c = o.mc / (magnitude(x.B_2) * root_dd);
  if (any(o.is_fixed_axis)) {
    const Vector<S> w = quotient(momentum.m, I);
    setFixedAxis(o.is_fixed_axis, o, h * (momentum.G * dot(momentum.m, w)), x);
  }
  x.turn.sin = o.about * x.turn.sin;
  const S scale = 1 / root(x.s * x.s + x.c * x.c);
  x.s = scale * x.s;
  x.c = scale * x.c;
  x.psi = {one, S(0.0)};
  // The inverse of the shortest rotation that takes the momentum to axis d.
  const OrbitMomentum<S> m = momentumOf(x);
  const S w = 1 + magnitude(m.d);
  const Quaternion<S> back = {-(sign_d * m.two), sign_d * m.c, S(0.0), w};
  const Quaternion<S> q_WE = q_WB * fromOrbit(o.is_around_1, o.about, back);
  x.q_WE = scaled(1 / root(squaredNorm(q_WE)), q_WE);
  return x;
}

/// The phase a step on, by the addition theorems.
template <class S>
RBS_INLINE Phase<S> nextPhase(const Phase<S>& x, const Jacobi<S>& f, const S& kc2) {
  const S k2 = 1 - kc2;
  // 1 - k^2 s^2 sn^2 as a sum of positive terms.
  const S i = 1 / (x.c * x.c + (kc2 + k2 * (f.cn * f.cn)) * (x.s * x.s));
  return {(x.s * (f.cn * f.dn) + x.c * x.d * f.sn) * i,
          (x.c * f.cn - x.s * x.d * (f.sn * f.dn)) * i,
          (x.d * f.dn - x.s * x.c * (k2 * (f.sn * f.cn))) * i};
}

/// What the body has turned about E, when its phase goes from `x` to `next`. Its length is another
/// one then, by up to 1e91: dd is above R / 2, and R above 1e-60.
template <class S>
RBS_INLINE HalfAngle<S> nextPsi(const Coasting<S>& of, const Phase<S>& x, const Phase<S>& next) {
  const S sn = of.of_step.sn;
  const S a = of.root_dd * x.c, a_next = of.root_dd * next.c;
  const S num = of.num * (x.s * next.s);
  const S den = 1 + of.den * (next.s * next.s - sn * x.s * (next.c * next.d));
  const S cross = a * next.s - x.s * a_next;
  const S dot = a * a_next + x.s * next.s;
  // Of (den + i num) (dot - i cross), without a root: dot^2 + cross^2 is the product of the sums
  // here, and den^2 + num^2 the same times a constant.
  const S length = of.length * ((a * a + x.s * x.s) * (a_next * a_next + next.s * next.s));
  const HalfAngle<S> between =
      rootDirection(den * dot + num * cross, num * dot - den * cross, length);
  const auto stays = sn == 0;  // the phase's roundings are no turn
  return of.psi * of.turn *
         HalfAngle<S>{select(stays, S(1.0), between.cos), select(stays, S(0.0), between.sin)};
}

/// exp(psi about E) P with P along (1 + |md|, m x E), the shortest rotation of m to E.
template <class S>
RBS_INLINE Quaternion<S> attitudeOf(const Coasting<S>& x, const Phase<S>& phase) {
  const S a = x.root_dd * phase.c, s = phase.s;
  const S C = x.psi.cos, D = x.psi.sin;
  const S w = 1 + magnitude(x.B_d) * phase.d;
  // Around axis 3; around axis 1 the outer axes change places.
  const Quaternion<S> turn = {x.B_2 * (C * s + D * a), withSign(x.B_2, x.B_d) * (D * s - C * a),
                              withSign(w, x.B_d) * D, w * C};
  const S scale = 1 / root(squaredNorm(turn));
  const auto is_around_1 = x.root_dd < 0;
  return x.q_WE * scaled(scale, {select(is_around_1, turn.z, turn.x), turn.y,
                                 select(is_around_1, turn.x, turn.z), turn.w});
}

/// Moves a body on by a step. @returns its attitude then
template <class S>
RBS_INLINE Quaternion<S> nextAttitude(Coasting<S>& x) {
  const Phase<S> phase = phaseOf(x), next = nextPhase(phase, x.of_step, x.kc2);
  x.psi = nextPsi(x, phase, next);
  const Quaternion<S> q_WB = attitudeOf(x, next);
  // For the next step; the attitude need not wait for it. A step turns an error of the phase's
  // length, s^2 + c^2, into the opposite one, and equal steps would add up their roundings.
  const S unit = 1.5 - 0.5 * (next.s * next.s + next.c * next.c);
  x.s = unit * next.s;
  x.c = unit * next.c;
  x.psi = nearOne(x.psi);
  return q_WB;
}

}  // namespace
}  // namespace rigid_body_sim::batch

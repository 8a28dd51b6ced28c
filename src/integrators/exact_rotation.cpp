#include "integrators/exact_rotation.hpp"

#include <cmath>

#include "integrators/jacobi.hpp"
#include "rigid_body_sim/rotation.hpp"

namespace rigid_body_sim {
namespace {

/// Constants of the motion, for momentum of unit length. The momentum circles around the body axis
/// d (1 or 3), whose component never changes sign; c is the other outer axis, 2 the middle one.
struct Orbit {
  int d, c;            // indices 0 or 2
  double Dc, Dd, D13;  // differences of inverse moments, times |m|
  double S;            // m1^2 D12 - m3^2 D23: on which side of the separatrix
  double W, R;         // conserved; R = 0 on a principal axis
  double lambda;       // rate of the elliptic argument [1/s]
  double k2, kc2;      // modulus
};

Orbit orbitOf(const Vector3d& m, const Vector3d& I, double G) {
  // From differences of moments: 1/I1 - 1/I2 would lose what nearly equal moments differ by.
  const double D12 = (I(1) - I(0)) / (I(0) * I(1)) * G;
  const double D23 = (I(2) - I(1)) / (I(1) * I(2)) * G;
  Orbit o;
  o.D13 = (I(2) - I(0)) / (I(0) * I(2)) * G;
  o.S = m(0) * m(0) * D12 - m(2) * m(2) * D23;
  const bool around_1 = o.S > 0 || (o.S == 0 && D12 > D23);
  o.d = around_1 ? 0 : 2;
  o.c = around_1 ? 2 : 0;
  o.Dc = around_1 ? D23 : D12;
  o.Dd = around_1 ? D12 : D23;
  o.W = m(1) * m(1) * o.Dc + m(o.d) * m(o.d) * o.D13;
  o.R = m(o.c) * m(o.c) * o.D13 + m(1) * m(1) * o.Dd;
  o.lambda = std::sqrt(o.Dd * o.W);
  // k^2 + k'^2 = 1: the smaller one directly, the other from it.
  const double k2 = o.Dc * o.R / (o.Dd * o.W);
  const double kc2 = o.D13 * std::abs(o.S) / (o.Dd * o.W);
  o.k2 = k2 < kc2 ? k2 : 1 - kc2;
  o.kc2 = k2 < kc2 ? 1 - k2 : kc2;
  return o;
}

/// Shortest rotation that takes the direction of m to the axis sign * e_d.
Quaterniond toAxis(const Vector3d& m, int d, double sign) {
  const Vector3d axis = sign * Vector3d::Unit(d);
  const Vector3d x = m.cross(axis);
  return Quaterniond(m.norm() + std::abs(m(d)), x.x(), x.y(), x.z()).normalized();
}

/// The elliptic argument for h, brought within half a period of zero.
struct Argument {
  double v;             // of the sign of h taken off
  double half_periods;  // taken away: v |-> v - 2 K half_periods
};

Argument argumentOf(const Orbit& o, double h) {
  Argument x = {o.lambda * std::abs(h), 0};
  if (x.v <= 1.5 || !(o.kc2 > 0)) return x;
  const double K = quarterPeriod(o.kc2);
  x.half_periods = std::round(x.v / (2 * K));
  x.v -= 2 * x.half_periods * K;
  return x;
}

/// The slow angle: what the body turns about L beyond a2 |m| h and the angle between momenta.
double phase(const Orbit& o, const Argument& x, const Jacobi& f) {
  const double p = o.Dc / o.lambda;
  double angle = std::atan2(p * f.sn * f.cn, f.dn) - x.half_periods * M_PI;
  if (o.S == 0) return angle;
  const double one_minus_n = std::abs(o.S) / o.W;
  double integral = integralOfThirdKind(f, o.k2, o.Dc / o.W, one_minus_n);
  if (x.half_periods != 0)
    integral += 2 * x.half_periods * completeIntegralOfThirdKind(o.kc2, one_minus_n);
  return angle + std::abs(o.S) * o.Dc / (o.lambda * o.W) * integral;
}

FreeRotation aboutFixedAxis(const Vector3d& m_B, const Vector3d& I, double h) {
  return {rotationExp(h * m_B.cwiseQuotient(I)), m_B};
}

}  // namespace

FreeRotation exactRotation(const Vector3d& m_B, const Vector3d& I, double h) {
  const double G = m_B.stableNorm();
  if (G == 0) return {Quaterniond::Identity(), m_B};
  Vector3d m = m_B / G;
  m.normalize();  // of subnormal components the quotient is not yet of unit length
  const Orbit o = orbitOf(m, I, G);
  if (o.lambda == 0 || o.R == 0) return aboutFixedAxis(m_B, I, h);

  const Argument x = argumentOf(o, h);
  const Jacobi f = jacobi(x.v, o.k2, o.kc2);
  const double sign_h = h < 0 ? -1 : 1;
  const double s = sign_h * f.sn / o.lambda;
  const double md = m(o.d), mc = m(o.c), m2 = m(1);
  const double q = o.W / (md * md * o.D13 + m2 * m2 * o.Dc * f.cn * f.cn);
  const double md_next = (md * f.dn - o.Dc * s * mc * m2 * f.cn) * q;
  const double mc_next = (mc * f.cn - o.Dd * s * m2 * md * f.dn) * q;
  const double m2_next = (m2 * f.cn * f.dn + o.D13 * s * mc * md) * q;

  // The angle between the two momenta as seen along d, as the argument of a complex number.
  const double sign_d = md < 0 ? -1 : 1;
  const double num = -o.D13 * s * o.Dc * m2 * m2_next;
  const double den = o.R + o.Dc * m2_next * m2_next - o.Dc * o.D13 * s * m2 * mc_next * md_next;
  const double cross = sign_d * (mc * m2_next - m2 * mc_next);
  const double dot = mc * mc_next + m2 * m2_next;
  const double between = std::atan2(num * dot - den * cross, den * dot + num * cross);
  const double turn = sign_h * phase(o, x, f) + between;
  const double psi = G / I(1) * h + (o.d == 2 ? turn : -turn);

  const double half_turn = std::fmod(x.half_periods, 2) != 0 ? -1 : 1;
  Vector3d next;
  next(o.d) = md_next;
  next(o.c) = half_turn * mc_next;
  next(1) = half_turn * m2_next;
  const Quaterniond spin = rotationExp(psi * sign_d * Vector3d::Unit(o.d));
  return {toAxis(m, o.d, sign_d).conjugate() * spin * toAxis(next, o.d, sign_d), G * next};
}

}  // namespace rigid_body_sim

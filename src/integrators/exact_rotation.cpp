#include "integrators/exact_rotation.hpp"

#include <cmath>

namespace rigid_body_sim {
namespace {

/// The rotation of the frames between which the momentum is along its axis d: the quaternion
/// P^-1 (spin about d) P', with P the shortest rotation that takes m to the axis sign_d e_d, P'
/// that of m'.
Quaterniond between(const Vector3d& m, const Vector3d& next, int d, double sign_d,
                    const HalfAngle& spin) {
  const double a = 1 + std::abs(m(d)), b = 1 + std::abs(next(d));
  const double scale = 1 / std::sqrt(4 * a * b);  // |(a, m x e)|^2 = 2 a
  const Vector3d axis = sign_d * Vector3d::Unit(d);
  const Vector3d v = m.cross(axis), v_next = next.cross(axis);
  Quaterniond turn(spin.cos, 0, 0, 0);
  turn.coeffs()(d) = spin.sin;
  const Quaterniond product = Quaterniond(a, -v.x(), -v.y(), -v.z()) *
                              (turn * Quaterniond(b, v_next.x(), v_next.y(), v_next.z()));
  return Quaterniond(Eigen::Vector4d(scale * product.coeffs()));
}

}  // namespace

FreeRotation exactRotation(const Vector3d& m_B, const Vector3d& I, double h) {
  return exactRotation(m_B, I, InverseMoments(I), h);
}

FreeRotation exactRotation(const Vector3d& m_B, const Vector3d& I, const InverseMoments& a,
                           double h) {
  const Direction momentum(m_B);
  const double G = momentum.G;
  if (G == 0) return {Quaterniond::Identity(), m_B};
  const Vector3d& m = momentum.m;
  const Orbit o = orbitOf(m, a);
  if (o.isFixedAxis()) return {rotationExp(h * m_B.cwiseQuotient(I)), m_B};

  const OrbitStep f = orbitStep(o, h * (a.a13 * G));
  const double s = f.sn / o.lambda;
  const double md = m(o.d), mc = m(o.c), m2 = m(1);
  const double q = o.W / (md * md + m2 * m2 * o.dc * f.cn * f.cn);
  const double md_next = (md * f.dn - o.dc * s * mc * m2 * f.cn) * q;
  const double mc_next = (mc * f.cn - o.dd * s * m2 * md * f.dn) * q;
  const double m2_next = (m2 * f.cn * f.dn + s * mc * md) * q;

  // The angle between the two momenta as seen along d, as the argument of a complex number.
  const double sign_d = md < 0 ? -1 : 1;
  const double num = -s * o.dc * m2 * m2_next;
  const double den = o.R + o.dc * m2_next * m2_next - o.dc * s * m2 * mc_next * md_next;
  const double cross = sign_d * (mc * m2_next - m2 * mc_next);
  const double dot = mc * mc_next + m2 * m2_next;
  HalfAngle turn =
      f.slow * normalized(rootDirection(den * dot + num * cross, num * dot - den * cross));
  if (o.d == 0) turn.sin = -turn.sin;
  HalfAngle spin = halfAngle(a.a2 * G * h) * turn;
  spin.sin *= sign_d;

  Vector3d next;
  next(o.d) = md_next;
  next(o.c) = mc_next;
  next(1) = m2_next;
  return {between(m, next, o.d, sign_d, spin), G * next};
}

}  // namespace rigid_body_sim

#include "integrators/coasting.hpp"

#include <cmath>

namespace rigid_body_sim {
namespace {

/// Brings a pair that is within rounding of unit length back to it.
double unitScale(double a, double b) { return 1.5 - 0.5 * (a * a + b * b); }

HalfAngle renormalized(const HalfAngle& a) {
  const double scale = unitScale(a.cos, a.sin);
  return {scale * a.cos, scale * a.sin};
}

/// Shortest rotation that takes the unit vector m to the axis sign_d e_d, unless d is 1.
Quaterniond toAxis(const Vector3d& m, int d, double sign_d) {
  const Vector3d v = m.cross(Vector3d(sign_d * Vector3d::Unit(d)));
  return Quaterniond(1 + std::abs(m(d)), v.x(), v.y(), v.z()).normalized();
}

}  // namespace

Coasting::Coasting(const Quaterniond& q_WB, const Vector3d& m_B, const Vector3d& I, double h)
    : q_WE_(q_WB) {
  const Direction momentum(m_B);
  const Vector3d& m = momentum.m;
  G_ = momentum.G;
  const InverseMoments a(I);
  const Orbit o = orbitOf(m, a);
  if (o.isFixedAxis()) {
    axis_B_ = m;
    turn_ = halfAngle(h * (G_ * m.cwiseProduct(m).cwiseQuotient(I).sum()));
    return;
  }
  d_ = o.d;
  sign_d_ = m(d_) < 0 ? -1 : 1;
  q_WE_ = q_WB * toAxis(m, d_, sign_d_).conjugate();

  const OrbitStep f = orbitStep(o, h * (a.a13 * G_));
  sn_ = f.sn;
  cn_ = f.cn;
  dn_ = f.dn;
  k2cn2_ = o.k2 * f.cn * f.cn;
  kc2_ = o.kc2;
  B_d_ = sign_d_ * std::sqrt(o.W);
  B_c_ = std::sqrt(o.R);
  B_2_ = sign_d_ * std::sqrt(o.R / o.dd);

  // The angle between the momenta before and after, as seen along d, is the argument of a complex
  // number as in exactRotation(), here without its positive common factors.
  const double about = o.d == 2 ? 1 : -1;
  turn_ = halfAngle(a.a2 * G_ * h) * HalfAngle{f.slow.cos, about * f.slow.sin};
  turn_.sin *= sign_d_;
  num_ = -o.dc / (o.lambda * o.dd) * sn_;
  den_ = o.dc / o.dd;
  cross_ = std::sqrt(o.dd);
  dot_ = o.dd;

  const int c = o.c;
  s_ = m(1) / B_2_;
  c_ = m(c) / B_c_;
  const double scale = 1 / std::sqrt(s_ * s_ + c_ * c_);
  s_ *= scale;
  c_ *= scale;
  d1_ = std::sqrt(c_ * c_ + kc2_ * s_ * s_);
}

Quaterniond Coasting::step() {
  if (d_ == 1) {
    psi_ = renormalized(psi_ * turn_);
    return rigid_body_sim::renormalized(q_WE_ * turned());
  }
  // Addition theorem; the denominator 1 - k^2 s^2 sn^2 as a sum of positive terms.
  const double i = 1 / (d1_ * d1_ + k2cn2_ * s_ * s_);
  double s = (s_ * cn_ * dn_ + sn_ * c_ * d1_) * i;
  double c = (c_ * cn_ - s_ * d1_ * sn_ * dn_) * i;
  const double scale = unitScale(s, c);
  s *= scale;
  c *= scale;
  const double d = std::sqrt(c * c + kc2_ * s * s);

  const double num = num_ * s_ * s;
  const double den = 1 + den_ * (s * s - sn_ * s_ * c * d);
  const double cross = cross_ * (c_ * s - s_ * c);
  const double dot = dot_ * c_ * c + s_ * s;
  HalfAngle between = halfArgument(den * dot + num * cross, num * dot - den * cross);
  if ((d_ == 0) != (sign_d_ < 0)) between.sin = -between.sin;
  psi_ = renormalized(psi_ * (turn_ * between));
  s_ = s;
  c_ = c;
  d1_ = d;
  return rigid_body_sim::renormalized(q_WE_ * turned());
}

Quaterniond Coasting::turned() const {
  const double C = psi_.cos, S = psi_.sin;
  if (d_ == 1) return {C, S * axis_B_.x(), S * axis_B_.y(), S * axis_B_.z()};
  // P is (1 + |m_d|, m x E), of length sqrt(2 (1 + |m_d|)).
  const double w = 1 + std::abs(B_d_) * d1_;
  const double scale = 1 / std::sqrt(2 * w);
  const double c = scale * sign_d_ * B_c_ * c_, s = scale * sign_d_ * B_2_ * s_;
  if (d_ == 2) return {scale * w * C, C * s + S * c, S * s - C * c, scale * w * S};
  return {scale * w * C, scale * w * S, C * c + S * s, S * c - C * s};
}

Vector3d Coasting::m_B() const {
  if (d_ == 1) return G_ * axis_B_;
  if (d_ == 2) return G_ * Vector3d(B_c_ * c_, B_2_ * s_, B_d_ * d1_);
  return G_ * Vector3d(B_d_ * d1_, B_2_ * s_, B_c_ * c_);
}

}  // namespace rigid_body_sim

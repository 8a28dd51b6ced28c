#include "integrators/coasting.hpp"

#include <cmath>

namespace rigid_body_sim {
namespace {

/// Shortest rotation that takes the unit vector m to the axis sign_d e_d, unless d is 1.
Quaterniond toAxis(const Vector3d& m, int d, double sign_d) {
  const Vector3d v = m.cross(Vector3d(sign_d * Vector3d::Unit(d)));
  return Quaterniond(1 + std::abs(m(d)), v.x(), v.y(), v.z()).normalized();
}

/// q = a (w, x, y, z), of unit length. Number by number: a quaternion put together in memory and
/// read back as a whole would wait for its parts to get there.
inline void setProduct(const Quaterniond& a, double w, double x, double y, double z,
                       Quaterniond& q) {
  const double qw = a.w() * w - a.x() * x - a.y() * y - a.z() * z;
  const double qx = a.w() * x + a.x() * w + a.y() * z - a.z() * y;
  const double qy = a.w() * y + a.y() * w + a.z() * x - a.x() * z;
  const double qz = a.w() * z + a.z() * w + a.x() * y - a.y() * x;
  const double scale = 1 / std::sqrt(qw * qw + qx * qx + qy * qy + qz * qz);
  q.w() = scale * qw;
  q.x() = scale * qx;
  q.y() = scale * qy;
  q.z() = scale * qz;
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

void Coasting::step(Quaterniond& q_WB) {
  if (d_ == 1) {
    psi_ = normalized(psi_ * turn_);
    const Vector3d v = psi_.sin * axis_B_;
    setProduct(q_WE_, psi_.cos, v.x(), v.y(), v.z(), q_WB);
    return;
  }
  // Addition theorem; the denominator 1 - k^2 s^2 sn^2 as a sum of positive terms.
  const double i = 1 / (d1_ * d1_ + k2cn2_ * s_ * s_);
  double s = (s_ * cn_ * dn_ + sn_ * c_ * d1_) * i;
  double c = (c_ * cn_ - s_ * d1_ * sn_ * dn_) * i;
  // Back to s^2 + c^2 = 1 by a Newton step.
  const double scale = 1.5 - 0.5 * (s * s + c * c);
  s *= scale;
  c *= scale;
  const double d = std::sqrt(c * c + kc2_ * s * s);

  const double num = num_ * s_ * s;
  const double den = 1 + den_ * (s * s - sn_ * s_ * c * d);
  const double cross = cross_ * (c_ * s - s_ * c);
  const double dot = dot_ * c_ * c + s_ * s;
  HalfAngle between = rootDirection(den * dot + num * cross, num * dot - den * cross);
  if ((d_ == 0) != (sign_d_ < 0)) between.sin = -between.sin;
  psi_ = normalized(psi_ * (turn_ * between));
  s_ = s;
  c_ = c;
  d1_ = d;

  // exp(psi about E) P with P along (1 + |m_d|, m x E), the shortest rotation of m to E.
  const double C = psi_.cos, S = psi_.sin;
  const double w = 1 + std::abs(B_d_) * d;
  const double x = sign_d_ * B_c_ * c, y = sign_d_ * B_2_ * s;
  if (d_ == 2)
    setProduct(q_WE_, w * C, C * y + S * x, S * y - C * x, w * S, q_WB);
  else
    setProduct(q_WE_, w * C, w * S, C * x + S * y, S * x - C * y, q_WB);
}

Vector3d Coasting::m_B() const {
  if (d_ == 1) return G_ * axis_B_;
  if (d_ == 2) return G_ * Vector3d(B_c_ * c_, B_2_ * s_, B_d_ * d1_);
  return G_ * Vector3d(B_d_ * d1_, B_2_ * s_, B_c_ * c_);
}

}  // namespace rigid_body_sim

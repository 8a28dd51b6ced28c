#include "integrators/orbit.hpp"

#include <cmath>

namespace rigid_body_sim {
namespace {

/// The elliptic argument for a time, brought within half a period of zero.
struct Argument {
  double v;             // the sign of the time taken off
  double half_periods;  // taken away: v |-> v - 2 K half_periods
};

Argument argumentOf(const Orbit& o, double time) {
  Argument x = {o.lambda * std::abs(time), 0};
  if (x.v <= 1.5 || !(o.kc2 > 0)) return x;
  const double K = quarterPeriod(o.kc2);
  x.half_periods = std::round(x.v / (2 * K));
  x.v -= 2 * x.half_periods * K;
  return x;
}

/// The part of the slow angle that grows with time, but for half a turn back each half period,
/// which the folded signs of sn and cn account for.
double secularAngle(const Orbit& o, const Argument& x, const Jacobi& f) {
  if (o.S == 0) return 0;
  const double inverse_W = 1 / o.W;
  const double one_minus_n = std::abs(o.S) * inverse_W;
  double integral = integralOfThirdKind(f, o.k2, o.dc * inverse_W, one_minus_n);
  if (x.half_periods != 0)
    integral += 2 * x.half_periods * completeIntegralOfThirdKind(o.kc2, one_minus_n);
  return one_minus_n * o.dc / o.lambda * integral;
}

}  // namespace

InverseMoments::InverseMoments(const Vector3d& I)
    // From differences of moments: 1/I1 - 1/I2 would lose what nearly equal moments differ by.
    // Divided one by one: the product of two moments may leave the range of numbers.
    : a2(1 / I(1)), a13((I(2) - I(0)) / I(0) / I(2)), d12(0), d23(0) {
  if (!(I(2) > I(0))) return;
  d12 = (I(1) - I(0)) / (I(2) - I(0)) * (I(2) / I(1));
  d23 = (I(2) - I(1)) / (I(2) - I(0)) * (I(0) / I(1));
}

Orbit orbitOf(const Vector3d& m, const InverseMoments& a) {
  const double m1 = m(0) * m(0), m2 = m(1) * m(1), m3 = m(2) * m(2);
  Orbit o;
  o.S = m1 * a.d12 - m3 * a.d23;
  const bool around_1 = o.S > 0 || (o.S == 0 && a.d12 > a.d23);
  o.d = around_1 ? 0 : 2;
  o.c = around_1 ? 2 : 0;
  o.dc = around_1 ? a.d23 : a.d12;
  o.dd = around_1 ? a.d12 : a.d23;
  o.W = m2 * o.dc + (around_1 ? m1 : m3);
  o.R = (around_1 ? m3 : m1) + m2 * o.dd;
  o.lambda = std::sqrt(o.dd * o.W);
  o.k2 = o.kc2 = 0;
  if (o.isFixedAxis()) return o;
  const double scale = 1 / (o.dd * o.W);
  // k^2 + k'^2 = 1: the smaller one directly, the other from it.
  const double k2 = o.dc * o.R * scale;
  const double kc2 = std::abs(o.S) * scale;
  o.k2 = k2 < kc2 ? k2 : 1 - kc2;
  o.kc2 = k2 < kc2 ? 1 - k2 : kc2;
  return o;
}

Direction::Direction(const Vector3d& vector) {
  const double square = vector.squaredNorm();
  if (square > 1e-280 && square < 1e280) {
    G = std::sqrt(square);
    m = vector / G;
    return;
  }
  G = vector.stableNorm();
  m = G == 0 ? vector : vector / G;
  m.normalize();  // of subnormal components the quotient is not yet of unit length
}

OrbitStep orbitStep(const Orbit& o, double time) {
  const Argument x = argumentOf(o, time);
  const Jacobi f = jacobi(x.v, o.k2, o.kc2);
  const double fold = x.half_periods != 0 && std::fmod(x.half_periods, 2) != 0 ? -1 : 1;
  const double sign = time < 0 ? -1 : 1;
  // The periodic part is the argument of this complex number.
  const HalfAngle periodic = normalized(rootDirection(f.dn, sign * o.dc / o.lambda * f.sn * f.cn));
  return {sign * fold * f.sn, fold * f.cn, f.dn,
          periodic * halfAngle(sign * secularAngle(o, x, f))};
}

}  // namespace rigid_body_sim

#include "integrators/jacobi.hpp"

#include <algorithm>
#include <array>
#include <boost/math/special_functions/ellint_rj.hpp>
#include <cmath>

namespace rigid_body_sim {
namespace {

constexpr double kPi = 3.14159265358979323846;

/// Maclaurin's series of sn to v^11 (Abramowitz and Stegun 16.22.1): for |v| <= 1/16 the first term
/// left out is below 2e-17 of sn.
double snSeries(double v, double k2) {
  const double k4 = k2 * k2, k6 = k4 * k2, k8 = k4 * k4, k10 = k8 * k2;
  const double c1 = -(1 + k2) / 6;
  const double c2 = (1 + 14 * k2 + k4) / 120;
  const double c3 = -(1 + 135 * k2 + 135 * k4 + k6) / 5040;
  const double c4 = (1 + 1228 * k2 + 5478 * k4 + 1228 * k6 + k8) / 362880;
  const double c5 = -(1 + 11069 * k2 + 165826 * k4 + 165826 * k6 + 11069 * k8 + k10) / 39916800;
  const double v2 = v * v;
  return v * (1 + v2 * (c1 + v2 * (c2 + v2 * (c3 + v2 * (c4 + v2 * c5)))));
}

/// Twice the argument (Abramowitz and Stegun 16.18).
Jacobi doubled(const Jacobi& f, double k2) {
  const double s2 = f.sn * f.sn, c2 = f.cn * f.cn, d2 = f.dn * f.dn;
  const double scale = 1 / (1 - k2 * s2 * s2);
  return {2 * f.sn * f.cn * f.dn * scale, (c2 - s2 * d2) * scale, (d2 - k2 * s2 * c2) * scale};
}

Jacobi jacobiNearZero(double v, double k2) {
  const bool is_tiny = std::abs(v) <= 1.0 / 16;
  const double u = is_tiny ? v : v / 4;
  const double s = snSeries(u, k2);
  const Jacobi f = {s, std::sqrt(1 - s * s), std::sqrt(1 - k2 * s * s)};
  return is_tiny ? f : doubled(doubled(f, k2), k2);
}

/// Descending Landen transformation by the arithmetic-geometric mean (Abramowitz and Stegun 16.4).
Jacobi jacobiByAgm(double v, double k2, double kc2) {
  constexpr int kMaxSteps = 16;  // it converges quadratically: 8 suffice for k'^2 = 1e-300
  std::array<double, kMaxSteps + 1> a, c;
  double b = std::sqrt(kc2);
  a[0] = 1;
  c[0] = std::sqrt(k2);
  int n = 0;
  for (; n < kMaxSteps && c[n] > 1e-17 * a[n]; ++n) {
    a[n + 1] = 0.5 * (a[n] + b);
    c[n + 1] = 0.5 * std::abs(a[n] - b);
    b = std::sqrt(a[n] * b);
  }
  double phi = std::ldexp(a[n] * v, n);
  for (; n > 0; --n)
    phi = 0.5 * (phi + std::asin(std::clamp(c[n] / a[n] * std::sin(phi), -1.0, 1.0)));
  const double s = std::sin(phi);
  const double cosine = std::cos(phi);
  return {s, cosine, std::sqrt(cosine * cosine + kc2 * s * s)};
}

/// Numbers of the series in integralOfThirdKind(), so that it divides nothing.
struct Ratios {
  double weight;  // 1 / (2 j + 3)
  double now;     // (j + 1/2) / (j + 1)
  double before;  // j / (j + 1)
};

constexpr std::array<Ratios, 11> kRatios = [] {
  std::array<Ratios, 11> ratios = {};
  for (int j = 1; j <= 11; ++j)
    ratios[static_cast<std::size_t>(j - 1)] = {1.0 / (2 * j + 3), (j + 0.5) / (j + 1),
                                               static_cast<double>(j) / (j + 1)};
  return ratios;
}();

}  // namespace

Jacobi jacobi(double v, double k2, double kc2) {
  if (std::abs(v) <= 0.25) return jacobiNearZero(v, k2);
  if (kc2 > 0) return jacobiByAgm(v, k2, kc2);
  const double sech = 1 / std::cosh(v);
  return {std::tanh(v), sech, sech};
}

double quarterPeriod(double kc2) {
  double a = 1;
  double b = std::sqrt(kc2);
  while (std::abs(a - b) > 4e-16 * a) {
    const double mean = 0.5 * (a + b);
    b = std::sqrt(a * b);
    a = mean;
  }
  return kPi / (2 * a);
}

double integralOfThirdKind(const Jacobi& f, double k2, double n, double one_minus_n) {
  const double s2 = f.sn * f.sn;
  if (s2 >= 0.03) {  // Carlson's symmetric form, Numer. Algorithms 10 (1995) 13
    return f.sn * s2 / 3 *
           boost::math::ellint_rj(f.cn * f.cn, f.dn * f.dn, 1.0, one_minus_n + n * f.cn * f.cn);
  }
  // Series in x = sn^2: 1/sqrt((1 - x)(1 - k^2 x)) = sum p_j x^j, divided by 1 - n x and
  // integrated. At its worst, n = k = 1 and x = 0.03, the first term left out is 8e-19 of the sum.
  double p_before = 1, p = 0.5 * (1 + k2);  // p_0, p_1
  double c = 1, power = 1, sum = 1.0 / 3;
  for (const Ratios& ratio : kRatios) {
    c = p + n * c;
    power *= s2;
    const double term = c * power * ratio.weight;
    sum += term;
    if (std::abs(term) < 1e-18) break;  // sum is above 1/3, and later terms are smaller still
    const double p_after = ratio.now * (1 + k2) * p - ratio.before * k2 * p_before;
    p_before = p;
    p = p_after;
  }
  return f.sn * s2 * sum;
}

double completeIntegralOfThirdKind(double kc2, double one_minus_n) {
  return boost::math::ellint_rj(0.0, kc2, 1.0, one_minus_n) / 3;
}

}  // namespace rigid_body_sim

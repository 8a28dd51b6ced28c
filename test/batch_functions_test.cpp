// Sine and cosine of the batch kernels, against the C library in long double.
#include <algorithm>
#include <cmath>

#include "generic.hpp"
#include "integrators/batch/vectors.hpp"

namespace rigid_body_sim::batch {
namespace {

/// Distance in units in the last place of `exact`.
double ulps(double value, long double exact) {
  const double rounded = std::abs(static_cast<double>(exact));
  const double ulp = std::nextafter(rounded, kInf) - rounded;
  return static_cast<double>(std::abs(value - exact) / ulp);
}

double worstUlps(double low, double high, int count) {
  Sampler sample(7);
  double worst = 0;
  for (int i = 0; i < count; ++i) {
    const double x = sample.between(low, high);
    const SinCos<double> f = sinCos(x);
    worst = std::max({worst, ulps(f.sin, std::sin(static_cast<long double>(x))),
                      ulps(f.cos, std::cos(static_cast<long double>(x)))});
  }
  return worst;
}

TEST(BatchSinCos, IsAccurateToAnUlp) {
  EXPECT_LE(worstUlps(-0.785, 0.785, 200000), 1);
  // With the tail of the reduced angle: measured 1.05.
  EXPECT_LE(worstUlps(-10, 10, 200000), 1.1);
  EXPECT_LE(worstUlps(-1e5, 1e5, 200000), 1.1);
  EXPECT_LE(worstUlps(-kLargestAngle, kLargestAngle, 200000), 1.1);
}

TEST(BatchSinCos, IsAccurateToAnUlpBesideEveryZero) {
  double worst = 0;
  for (int n = 1; n < 60000; ++n)
    for (const double x : {n * kPi / 2, std::nextafter(n * kPi / 2, 0), -n * kPi / 2}) {
      const SinCos<double> f = sinCos(x);
      worst = std::max({worst, ulps(f.sin, std::sin(static_cast<long double>(x))),
                        ulps(f.cos, std::cos(static_cast<long double>(x)))});
    }
  // Long double itself is off by 5e-20 of the angle there, in a result of 1e-12 and more.
  RecordProperty("ulps", std::to_string(worst));
  EXPECT_LE(worst, 1);
}

TEST(BatchSinCos, OfHugeAnglesIsTheCLibrarys) {
  for (const double x : {1.1e6, -3e9, 1e22, -1e300}) {
    EXPECT_EQ(sinCos(x).sin, std::sin(x));
    EXPECT_EQ(sinCos(x).cos, std::cos(x));
  }
  EXPECT_TRUE(std::isnan(sinCos(kInf).sin) && std::isnan(sinCos(kNaN).cos));
}

TEST(BatchSinCos, OfNothingIsExact) {
  EXPECT_EQ(sinCos(0.0).sin, 0);
  EXPECT_EQ(sinCos(0.0).cos, 1);
  EXPECT_EQ(sinCos(5e-324).sin, 5e-324);
}

TEST(BatchSinCos, DoesNotDependOnTheOtherLanes) {
  const double angles[] = {0.3, -0.784, 0.786, 2.9, -1e4, 3e7, kNaN, 0, -0.0, 1e-310};
  const auto same = [](double a, double b) { return (std::isnan(a) && std::isnan(b)) || a == b; };
  for (const double a : angles)
    for (const double b : angles) {
      const SinCos<Pack<2>> f = sinCos(Pack<2>(Pack<2>::Lanes{a, b}));
      EXPECT_TRUE(same(f.sin.lanes[0], sinCos(a).sin) && same(f.cos.lanes[0], sinCos(a).cos));
      EXPECT_TRUE(same(f.sin.lanes[1], sinCos(b).sin) && same(f.cos.lanes[1], sinCos(b).cos));
      const CosSinc<Pack<2>> g = cosSinc(Pack<2>(Pack<2>::Lanes{a * a, b * b}));
      EXPECT_TRUE(same(g.cos.lanes[0], cosSinc(a * a).cos));
      EXPECT_TRUE(same(g.sinc.lanes[1], cosSinc(b * b).sinc));
    }
}

double worstOfCosSinc(double low, double high) {
  long double worst = 0;
  for (int i = 0; i <= 100000; ++i) {
    const double x2 = low + (high - low) * i / 100000;
    const CosSinc<double> f = cosSinc(x2);
    const long double x = std::sqrt(static_cast<long double>(x2));
    const long double sinc = x == 0 ? 1 : std::sin(x) / x;
    worst = std::max({worst, std::abs(f.cos - std::cos(x)), std::abs(f.sinc - sinc)});
  }
  return static_cast<double>(worst);
}

TEST(BatchCosSinc, IsRoundedWellOnBothSidesOfTheSwitch) {
  RecordProperty("below_eps", std::to_string(worstOfCosSinc(0, kLargestSquare) / kEps));
  RecordProperty("above_eps", std::to_string(worstOfCosSinc(kLargestSquare, 10) / kEps));
  EXPECT_LE(worstOfCosSinc(0, kLargestSquare), 0.6 * kEps);
  // The root is off by half an ulp of up to 3.2, and the functions pass that on.
  EXPECT_LE(worstOfCosSinc(kLargestSquare, 10), 2 * kEps);
  const CosSinc<double> below = cosSinc(kLargestSquare);
  const CosSinc<double> above = cosSinc(std::nextafter(kLargestSquare, 1));
  EXPECT_LE(std::abs(below.cos - above.cos), kEps);
  EXPECT_LE(std::abs(below.sinc - above.sinc), kEps);
}

TEST(BatchCosSinc, IsExactAtZero) {
  EXPECT_EQ(cosSinc(0.0).cos, 1);
  EXPECT_EQ(cosSinc(0.0).sinc, 1);
  EXPECT_EQ(cosSinc(1e-320).cos, 1);
}

TEST(BatchRotationExp, IsThatOfOneBody) {
  Sampler sample(2);
  for (int i = 0; i < 10000; ++i) {
    const Vector3d r = 8 * sample.vector();
    const Quaternion<double> q = rotationExp(Vector<double>{r.x(), r.y(), r.z()});
    const Quaterniond expected = rigid_body_sim::rotationExp(r);
    EXPECT_LE(difference(Eigen::Vector4d(q.x, q.y, q.z, q.w), expected.coeffs()), 4 * kEps);
  }
}

}  // namespace
}  // namespace rigid_body_sim::batch

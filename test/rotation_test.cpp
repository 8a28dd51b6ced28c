#include "rigid_body_sim/rotation.hpp"

#include <algorithm>

#include "generic.hpp"

namespace rigid_body_sim {
namespace {

/// Worst error of CosSinc over `count` arguments from `low` to `high`, against long double.
double worstError(double low, double high, int count) {
  long double worst = 0;
  for (int i = 0; i <= count; ++i) {
    const double x2 = low + (high - low) * i / count;
    const CosSinc f(x2);
    const long double x = std::sqrt(static_cast<long double>(x2));
    const long double sinc = x == 0 ? 1 : std::sin(x) / x;
    worst = std::max({worst, std::abs(f.cos - std::cos(x)), std::abs(f.sinc - sinc)});
  }
  return static_cast<double>(worst);
}

TEST(CosSinc, IsRoundedWellBelowTheSwitchToTheSeries) {
  // A product and a difference near one: measured 0.28 kEps.
  EXPECT_LE(worstError(0, std::nextafter(0.1, 0.0), 100000), 0.5 * kEps);
}

TEST(CosSinc, IsRoundedWellAboveTheSwitchToTheSeries) {
  // The root is off by half an ulp of up to 3.2, and the functions pass that on: measured 1.1 kEps.
  EXPECT_LE(worstError(0.1, 10, 100000), 2 * kEps);
}

TEST(CosSinc, DoesNotJumpAtTheSwitch) {
  const CosSinc below(std::nextafter(0.1, 0.0)), above(0.1);
  EXPECT_LE(std::abs(below.cos - above.cos), kEps);
  EXPECT_LE(std::abs(below.sinc - above.sinc), kEps);
}

TEST(CosSinc, IsExactAtZero) {
  EXPECT_EQ(CosSinc(0).cos, 1);
  EXPECT_EQ(CosSinc(0).sinc, 1);
}

TEST(HalfAngle, IsCosineAndSineOfHalfTheAngleWithItsSign) {
  for (const double angle : {-7.0, -0.6, -1e-9, 0.0, 0.63, 0.64, 3.0, 12.0}) {
    const HalfAngle half = halfAngle(angle);
    EXPECT_NEAR(half.cos, std::cos(angle / 2), 2 * kEps);
    EXPECT_NEAR(half.sin, std::sin(angle / 2), 2 * kEps);
  }
}

TEST(RotationExp, TurnsByTheVectorsLengthAboutItsDirection) {
  // A third of a turn about the diagonal takes x to y to z.
  const Quaterniond q = rotationExp(2 * kPi / 3 / std::sqrt(3.0) * Vector3d::Ones());
  EXPECT_LE(difference(q * Vector3d(1, 2, 3), Vector3d(3, 1, 2)), 16 * kEps);
}

TEST(RotationExp, IsRodriguesFormula) {
  for (const double length : {1e-9, 0.3, 0.6324, 0.6325, 2.0, 6.0}) {  // on both sides of 0.63246
    const Vector3d u = Vector3d(0.48, -0.6, 0.64);
    Matrix3d cross;
    cross << 0, -u.z(), u.y(), u.z(), 0, -u.x(), -u.y(), u.x(), 0;
    const Matrix3d expected =
        Matrix3d::Identity() + std::sin(length) * cross + (1 - std::cos(length)) * cross * cross;
    EXPECT_LE(difference(rotationExp(length * u).toRotationMatrix(), expected), 8 * kEps);
  }
}

TEST(RotationExp, OfNothingIsExactlyTheIdentity) {
  EXPECT_EQ(rotationExp(Vector3d::Zero()).coeffs(), Quaterniond::Identity().coeffs());
  EXPECT_EQ(rotationExp(Vector3d(1e-310, 0, -1e-310)).w(), 1);
}

TEST(RotationExp, IsOfUnitLength) {
  Sampler sample(3);
  for (int i = 0; i < 10000; ++i) EXPECT_NEAR(rotationExp(4 * sample.vector()).norm(), 1, 2 * kEps);
}

TEST(RotationExp, OfParallelVectorsAdds) {
  const Vector3d r(0.7, -1.1, 0.4);
  EXPECT_LE(angleBetween(rotationExp(0.3 * r) * rotationExp(1.9 * r), rotationExp(2.2 * r)),
            8 * kEps);
}

TEST(RotationExp, SolvesTheEquationsOfAttitude) {
  // q' = w q / 2 and R' = w x R (founding text, sections 2 and 6), by central differences
  // extrapolated once: what is left is kEps / h.
  const Vector3d w(0.7, -1.1, 0.4);
  const Quaterniond q = genericAttitude();
  const auto at = [&](double t) { return rotationExp(t * w) * q; };
  const double h = 1e-3;
  const auto q_slope = [&](double d) {
    return Eigen::Vector4d((at(d).coeffs() - at(-d).coeffs()) / (2 * d));
  };
  const Quaterniond half_w_q = Quaterniond(0, 0.5 * w.x(), 0.5 * w.y(), 0.5 * w.z()) * q;
  EXPECT_LE(difference((4 * q_slope(h / 2) - q_slope(h)) / 3, half_w_q.coeffs()), 4 * kEps / h);
  const auto R_slope = [&](double d) {
    return Matrix3d((at(d).toRotationMatrix() - at(-d).toRotationMatrix()) / (2 * d));
  };
  Matrix3d w_cross_R;
  for (int i = 0; i < 3; ++i) w_cross_R.col(i) = w.cross(q.toRotationMatrix().col(i));
  EXPECT_LE(difference((4 * R_slope(h / 2) - R_slope(h)) / 3, w_cross_R), 8 * kEps / h);
}

TEST(RotationLog, IsTheInverseOfExp) {
  Sampler sample(5);
  for (const double length : {1e-150, 1e-20, 1e-8, 0.1, 0.63, 0.64, 1.0, 2.0, 3.0, 3.1415}) {
    for (int i = 0; i < 100; ++i) {
      const Vector3d r = length * sample.attitude().vec().normalized();
      EXPECT_LE(difference(rotationLog(rotationExp(r)), r), 4 * kEps * length);
    }
  }
}

TEST(RotationLog, IsTheSameForBothSignsOfTheQuaternion) {
  const Quaterniond q = genericAttitude();
  EXPECT_EQ(rotationLog(Quaterniond(-q.coeffs())), rotationLog(q));
}

TEST(RotationLog, TakesTheShorterWay) {
  const Vector3d u(0.48, -0.6, 0.64);
  EXPECT_LE(difference(rotationLog(rotationExp(4 * u)), (4 - 2 * kPi) * u), 16 * kEps);
}

TEST(RotationLog, OfTheIdentityIsZero) {
  EXPECT_EQ(rotationLog(Quaterniond::Identity()), Vector3d::Zero());
  EXPECT_EQ(rotationLog(Quaterniond(-1, 0, 0, 0)), Vector3d::Zero());
}

TEST(Renormalized, LeavesThreeHalvesOfTheErrorsSquare) {
  for (const double error : {1e-4, -1e-4, 1e-6}) {
    Quaterniond q = genericAttitude();
    q.coeffs() *= 1 + error;
    // Newton's step for 1/sqrt leaves -3/2 error^2 (and -1/2 error^3).
    EXPECT_NEAR(renormalized(q).norm() - 1, -1.5 * error * error,
                std::abs(error * error * error) + 2 * kEps);
  }
}

TEST(Renormalized, NeverLetsALongProductDrift) {
  Quaterniond q = genericAttitude();
  const Quaterniond turn = rotationExp({0.013, -0.021, 0.008});
  for (int i = 0; i < 100000; ++i) q = renormalized(turn * q);
  EXPECT_NEAR(q.norm(), 1, 2 * kEps);
}

}  // namespace
}  // namespace rigid_body_sim

#include "integrators/exact_rotation.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "generic.hpp"
#include "integrators/jacobi.hpp"
#include "reference/flight.hpp"

namespace rigid_body_sim {
namespace {

/// Attitude and momentum after h, by the reference.
FreeRotation flown(const Vector3d& m_B, const Vector3d& I, double h) {
  BodyState start;
  start.L_WBcm_W = m_B;
  const BodyState end = reference::fly(start, 1, I, reference::nothing, h).end;
  return {end.q_WB, end.q_WB.conjugate() * m_B};
}

double difference(const FreeRotation& a, const FreeRotation& b) {
  return angleBetween(a.q_BBnext, b.q_BBnext) + (a.m_B - b.m_B).norm() / b.m_B.norm();
}

/// Moments of a random solid box with edges from 1 to 20, ascending.
Vector3d boxMoments(Sampler& sample) {
  Vector3d s;
  for (int i = 0; i < 3; ++i) s(i) = std::pow(20, 2 * std::abs(sample.vector()(0)));
  Vector3d I(s(1) + s(2), s(0) + s(2), s(0) + s(1));
  std::sort(I.data(), I.data() + 3);
  return I;
}

TEST(ExactRotation, AgreesWithTheReferenceOverRandomBodies) {
  Sampler sample(11);
  std::vector<double> errors;  // in roundings of the angle turned through
  for (int i = 0; i < 300; ++i) {
    const Vector3d I = boxMoments(sample);
    const Vector3d w = 3 * sample.vector();
    const double h = std::pow(10, -1.5 + 2 * std::abs(sample.vector()(0)));  // 0.03 to 3 s
    const Vector3d m = I.cwiseProduct(w);
    const double error = difference(exactRotation(m, I, h), flown(m, I, h));
    errors.push_back(error / (kEps * (1 + 3 * h * w.norm())));
  }
  std::sort(errors.begin(), errors.end());
  RecordProperty("median_eps", std::to_string(errors[150]));
  RecordProperty("max_eps", std::to_string(errors.back()));
  EXPECT_LT(errors[150], 2);
  EXPECT_LT(errors[296], 10);
  // Beside the separatrix an ulp of the inputs counts more than that.
  EXPECT_LT(errors.back(), 100);
}

TEST(ExactRotation, IsTheTurnAboutAFixedAxisOfASphereAndOnAPrincipalAxis) {
  const Vector3d w(0.3, -1.7, 0.9);
  const FreeRotation sphere = exactRotation(2 * w, Vector3d(2, 2, 2), 1.3);
  EXPECT_LE(angleBetween(sphere.q_BBnext, rotationExp(1.3 * w)), 4 * kEps);
  const Vector3d I(1, 2, 3);
  for (int axis = 0; axis < 3; ++axis) {
    const Vector3d spin = -4 * Vector3d::Unit(axis);
    const FreeRotation turned = exactRotation(I.cwiseProduct(spin), I, 0.7);
    EXPECT_LE(angleBetween(turned.q_BBnext, rotationExp(0.7 * spin)), 4 * kEps) << axis;
  }
}

TEST(ExactRotation, LeavesABodyAtRestAlone) {
  const FreeRotation rest = exactRotation(Vector3d::Zero(), Vector3d(1, 2, 3), 5);
  EXPECT_EQ(rest.q_BBnext.coeffs(), Quaterniond::Identity().coeffs());
  EXPECT_EQ(rest.m_B, Vector3d(0, 0, 0));
}

TEST(ExactRotation, HoldsForEveryKindOfTensorAndStart) {
  const std::vector<std::pair<Vector3d, Vector3d>> cases = {
      {{1, 1, 1.8}, {0.4, -0.3, 2}},           // oblate
      {{0.2, 1, 1}, {0.4, -0.3, 2}},           // prolate
      {{1, 1 + 1e-15, 1 + 3e-15}, {1, 2, 3}},  // almost a sphere
      {{1, 1 + 1e-9, 2}, {1, 2, 0.1}},         // almost symmetric
      {{1, 2, 3}, {0, 1, 0.2}},                // no component along 1
      {{1, 2, 3}, {0.5, 0, 0.2}},              // none along 2
      {{1, 2, 3}, {0.5, 1, 0}},                // none along 3
      {{1, 2, 3}, {-0.5, 1, -1e-3}},           // around -1
      {{1, 1.9, 2.8}, {0.1, 0.2, -3}},         // around -3
      {{1e-3, 1, 1}, {300, 0.4, 0.2}},         // a rod
  };
  for (const auto& [I, w] : cases)
    for (const double h : {0.02, 0.3, 2.0}) {
      const Vector3d m = I.cwiseProduct(w);
      // Rounding of the angle turned through; of a rod's, its own spin is the angle.
      EXPECT_LE(difference(exactRotation(m, I, h), flown(m, I, h)),
                16 * kEps * (1 + 3 * h * w.norm()))
          << I.transpose() << " | " << w.transpose() << " | " << h;
    }
}

TEST(ExactRotation, OnTheSeparatrixIsAsGoodAsItsInputs) {
  // m1^2 D12 = m3^2 D23 to an ulp: a change of the inputs by one ulp moves the end by `moved`.
  const Vector3d I(1, 2, 3);
  const double D12 = 0.5, D23 = 1.0 / 6;
  const Vector3d m(0.3, 2, 0.3 * std::sqrt(D12 / D23));
  for (const double h : {0.5, 3.0, 8.0}) {
    Vector3d beside = m;
    beside(2) = std::nextafter(m(2), 10);
    const double moved =
        difference(exactRotation(beside, I, h), exactRotation(m, I, h)) + 4 * kEps * (1 + 6 * h);
    EXPECT_LE(difference(exactRotation(m, I, h), flown(m, I, h)), 30 * moved) << h;
  }
}

TEST(ExactRotation, TwoHalvesAreAWholeAndBackIsTheStart) {
  Sampler sample(12);
  for (int i = 0; i < 2000; ++i) {
    const Vector3d I = boxMoments(sample);
    const Vector3d w = 5 * sample.vector();
    const Vector3d m = I.cwiseProduct(w);
    const double h = 0.5 * sample.vector()(0);
    const FreeRotation whole = exactRotation(m, I, h);
    const FreeRotation half = exactRotation(m, I, h / 2);
    const FreeRotation second = exactRotation(half.m_B, I, h / 2);
    const double bound = 64 * kEps * (1 + 3 * std::abs(h) * w.norm());
    ASSERT_LE(angleBetween(half.q_BBnext * second.q_BBnext, whole.q_BBnext), bound) << i;
    const FreeRotation back = exactRotation(whole.m_B, I, -h);
    ASSERT_LE(angleBetween(whole.q_BBnext * back.q_BBnext, Quaterniond::Identity()), bound) << i;
    ASSERT_LE((whole.q_BBnext * whole.m_B - m).norm(), 32 * kEps * m.norm()) << i;
  }
}

TEST(ExactRotation, IsBitEqualAtEveryScaleByPowersOfTwo) {
  const Vector3d I(1, 2.3, 3.1), m(0.4, 5, -0.7);
  const FreeRotation one = exactRotation(m, I, 0.37);
  for (const int power : {-500, -40, 40, 500}) {
    const double scale = std::ldexp(1, power);
    const FreeRotation scaled = exactRotation(scale * m, scale * I, 0.37);
    EXPECT_EQ(scaled.q_BBnext.coeffs(), one.q_BBnext.coeffs()) << power;
    EXPECT_EQ(scaled.m_B, scale * one.m_B) << power;
  }
}

TEST(Jacobi, KeepsItsIdentitiesOnBothSidesOfTheSwitch) {
  for (const double k2 : {0.0, 0.1, 0.7, 1 - 1e-12, 1.0})
    for (const double v :
         {-1.2, -0.2501, -0.2499, -0.01, 0.0, 0.0624, 0.0626, 0.2499, 0.2501, 1.4}) {
      const Jacobi f = jacobi(v, k2, 1 - k2);
      EXPECT_NEAR(f.sn * f.sn + f.cn * f.cn, 1, 8 * kEps) << k2 << " " << v;
      EXPECT_NEAR(f.dn * f.dn + k2 * f.sn * f.sn, 1, 8 * kEps) << k2 << " " << v;
      if (k2 == 0) {
        EXPECT_NEAR(f.sn, std::sin(v), 4 * kEps) << v;
      }
      if (k2 == 1) {
        EXPECT_NEAR(f.sn, std::tanh(v), 4 * kEps) << v;
      }
    }
}

TEST(Jacobi, ReachesOneAtTheQuarterPeriod) {
  for (const double k2 : {0.0, 0.3, 0.99}) {
    const Jacobi f = jacobi(quarterPeriod(1 - k2), k2, 1 - k2);
    EXPECT_NEAR(f.sn, 1, 4 * kEps) << k2;
    EXPECT_NEAR(f.cn, 0, 8 * kEps) << k2;
  }
}

TEST(IntegralOfThirdKind, IsTheSameFromTheSeriesAndFromCarlsonsForm) {
  // The switch is at sn^2 = 0.03: continuity across it, and the derivative sn^2 / (1 - n sn^2).
  for (const double n : {0.0, 0.5, 0.99})
    for (const double k2 : {0.2, 0.95}) {
      const double v = std::asin(std::sqrt(0.03));
      const double d = 1e-3;
      const Jacobi below = jacobi(v - d, k2, 1 - k2), above = jacobi(v + d, k2, 1 - k2);
      const Jacobi at = jacobi(v, k2, 1 - k2);
      const auto slope = [&](const Jacobi& f) { return f.sn * f.sn / (1 - n * f.sn * f.sn); };
      const double simpson = 2 * d / 6 * (slope(below) + 4 * slope(at) + slope(above));
      const double step =
          integralOfThirdKind(above, k2, n, 1 - n) - integralOfThirdKind(below, k2, n, 1 - n);
      EXPECT_NEAR(step, simpson, 1e-15) << n << " " << k2;  // Simpson's own error: d^5 / 90
    }
}

}  // namespace
}  // namespace rigid_body_sim

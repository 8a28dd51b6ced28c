// Exact free rotation of the batch kernels, against the equations of motion in long double.
#include <algorithm>
#include <cfenv>
#include <cmath>

#include "integrators/batch/coasting.hpp"
#include "reference/flight.hpp"
#include "rotor.hpp"

namespace rigid_body_sim::batch {
namespace {

Rotation flown(const Vector3d& m_B, const Vector3d& I, double h) {
  BodyState start;
  start.L_WBcm_W = m_B;
  const BodyState end = reference::fly(start, 1, I, reference::nothing, h).end;
  return {end.q_WB, end.q_WB.conjugate() * m_B};
}

double difference(const Rotation& a, const Rotation& b) {
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

TEST(BatchRotor, AgreesWithTheReferenceOverRandomBodies) {
  Sampler sample(11);
  std::vector<double> errors;  // in roundings of the angle turned through
  for (int i = 0; i < 300; ++i) {
    const Vector3d I = boxMoments(sample);
    const Vector3d w = 3 * sample.vector();
    const double h = std::pow(10, -1.5 + 2 * std::abs(sample.vector()(0)));  // 0.03 to 3 s
    const Vector3d m = I.cwiseProduct(w);
    const Rotation truth = flown(m, I, h);
    const double unit = kEps * (1 + 3 * h * w.norm());
    errors.push_back(difference(turned(m, I, h), truth) / unit);
  }
  std::sort(errors.begin(), errors.end());
  RecordProperty("errors", std::to_string(errors[150]) + " " + std::to_string(errors[296]) + " " +
                               std::to_string(errors.back()));
  EXPECT_LT(errors[150], 2);
  EXPECT_LT(errors[296], 10);
  // Beside the separatrix an ulp of the inputs counts more than that.
  EXPECT_LT(errors.back(), 100);
}

/// Moments and rates of every kind of tensor and start.
std::vector<std::pair<Vector3d, Vector3d>> kinds() {
  return {
      {{2, 2, 2}, {0.3, -1.7, 0.9}},  // sphere
      {{1, 2, 3}, {-4, 0, 0}},        // principal axes
      {{1, 2, 3}, {0, -4, 0}},         {{1, 2, 3}, {0, 0, 4}},
      {{1, 1, 1.8}, {0.4, -0.3, 2}},                                            // oblate
      {{1, 1, 1.8}, {0.4, -0.3, 0}},   {{0.2, 1, 1}, {0.4, -0.3, 2}},           // prolate
      {{0.2, 1, 1}, {0, -0.3, 2}},     {{1, 1 + 1e-15, 1 + 3e-15}, {1, 2, 3}},  // almost a sphere
      {{1, 1 + 1e-9, 2}, {1, 2, 0.1}},                                          // almost symmetric
      {{1, 2, 3}, {0, 1, 0.2}},                                          // no component along 1
      {{1, 2, 3}, {0.5, 0, 0.2}},                                        // none along 2
      {{1, 2, 3}, {0.5, 1, 0}},                                          // none along 3
      {{1, 2, 3}, {-0.5, 1, -1e-3}},                                     // around -1
      {{1, 1.9, 2.8}, {0.1, 0.2, -3}},                                   // around -3
      {{1, 2, 3}, {1e-20, 0, -3}},                                       // hardly off an axis
      {{1, 2, 3}, {1e-50, 1e-60, -3}}, {{1e-3, 1, 1}, {300, 0.4, 0.2}},  // a rod
  };
}

TEST(BatchRotor, HoldsForEveryKindOfTensorAndStart) {
  for (const auto& [I, w] : kinds())
    for (const double h : {0.02, -0.02, 0.3, 2.0, 40.0}) {
      const Vector3d m = I.cwiseProduct(w);
      if (h * w.norm() > 700) continue;
      // Rounding of the angle turned through; of a rod's, its own spin is the angle.
      EXPECT_LE(difference(turned(m, I, h), flown(m, I, h)),
                16 * kEps * (1 + 3 * std::abs(h) * w.norm()))
          << I.transpose() << " | " << w.transpose() << " | " << h;
    }
}

TEST(BatchRotor, OnTheSeparatrixIsAsGoodAsItsInputs) {
  const Vector3d I(1, 2, 3);
  const double D12 = 0.5, D23 = 1.0 / 6;
  const Vector3d m(0.3, 2, 0.3 * std::sqrt(D12 / D23));
  for (const double h : {0.5, 3.0, 8.0}) {
    Vector3d beside = m;
    beside(2) = std::nextafter(m(2), 10);
    const double moved = difference(turned(beside, I, h), turned(m, I, h)) + 4 * kEps * (1 + 6 * h);
    EXPECT_LE(difference(turned(m, I, h), flown(m, I, h)), 30 * moved) << h;
  }
  // exactly on it, until long after the momentum has come to the middle axis
  for (const double h : {1.0, 100.0, 1e4, 1e9}) {
    const Vector3d exactly(1, 2, std::sqrt(3.0));
    const Rotation end = turned(exactly, Vector3d(1, 2, 3), h);
    EXPECT_NEAR(end.m_B.norm(), exactly.norm(), 1e-7 * exactly.norm()) << h;
    EXPECT_NEAR(end.q_BBnext.norm(), 1, 4 * kEps) << h;
  }
}

TEST(BatchRotor, TwoHalvesAreAWholeAndBackIsTheStart) {
  Sampler sample(12);
  for (int i = 0; i < 2000; ++i) {
    const Vector3d I = boxMoments(sample);
    const Vector3d w = 5 * sample.vector();
    const Vector3d m = I.cwiseProduct(w);
    const double h = 0.5 * sample.vector()(0);
    const auto whole = turned(m, I, h);
    const auto half = turned(m, I, h / 2);
    const auto second = turned(half.m_B, I, h / 2);
    const double bound = 64 * kEps * (1 + 3 * std::abs(h) * w.norm());
    ASSERT_LE(angleBetween(half.q_BBnext * second.q_BBnext, whole.q_BBnext), bound) << i;
    const auto back = turned(whole.m_B, I, -h);
    ASSERT_LE(angleBetween(whole.q_BBnext * back.q_BBnext, Quaterniond::Identity()), bound) << i;
    ASSERT_LE((whole.q_BBnext * whole.m_B - m).norm(), 32 * kEps * m.norm()) << i;
  }
}

TEST(BatchRotor, IsBitEqualAtEveryScaleByPowersOfTwo) {
  const Vector3d I(1, 2.3, 3.1), m(0.4, 5, -0.7);
  const auto one = turned(m, I, 0.37);
  for (const int power : {-500, -40, 40, 500}) {
    const double scale = std::ldexp(1, power);
    const auto scaled = turned(scale * m, scale * I, 0.37);
    EXPECT_EQ(scaled.q_BBnext.coeffs(), one.q_BBnext.coeffs()) << power;
    EXPECT_EQ(scaled.m_B, scale * one.m_B) << power;
  }
}

/// Attitude and momentum after some coasted steps.
Rotation coasted(const Vector3d& m_B, const Vector3d& I, double h, int steps) {
  const Vector<double> moments = toBatch(I);
  const Quaternion<double> start = {0, 0, 0, 1};
  Coasting<double> coasting = coastingOf(start, toBatch(m_B), moments, inverseMoments(moments), h);
  Quaternion<double> q_WB = {0, 0, 0, 1};
  for (int i = 0; i < steps; ++i) q_WB = nextAttitude(coasting);
  return {fromBatch(q_WB), fromBatch(bodyMomentumOf(coasting))};
}

TEST(BatchRotor, RaisesNoFloatingPointExceptionAtAnySize) {
  for (const auto& [I, w] : kinds())
    for (const double size : {1.0, 1e-100, 1e-150, 1e-200, 1e-300, 1e-320}) {
      const Vector3d m = size * I.cwiseProduct(w);
      std::feclearexcept(FE_ALL_EXCEPT);
      turned(m, I, 0.02);
      coasted(m, I, 0.02, 3);
      EXPECT_EQ(std::fetestexcept(FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW), 0)
          << I.transpose() << " | " << m.transpose();
    }
}

TEST(BatchCoasting, KeepsThePhaseOnTheOrbitInSmallSteps) {
  const Vector3d I(1, 2, 2.9), w(0.5e-6, 0.6e-6, 0.3e-6);
  const Vector<double> moments = toBatch(I), m_B = toBatch(I.cwiseProduct(w));
  Coasting<double> coasting =
      coastingOf<double>({0, 0, 0, 1}, m_B, moments, inverseMoments(moments), 0.02);
  for (int i = 0; i < 200000; ++i) nextAttitude(coasting);
  // Without its correction: 1e-12.
  EXPECT_NEAR(coasting.s * coasting.s + coasting.c * coasting.c, 1, 4 * kEps);
}

/// A needle that turns about its third axis, where the numbers of an orbit go furthest apart: as
/// one turn after the other says that does not coast.
TEST(BatchCoasting, OfANeedleIsTheExactRotation) {
  for (const double thickness : {1e-6, 1e-20, 1e-40, 1e-50, 1e-58}) {
    const Vector3d I(thickness, 1, 1.5);
    const double h = 0.3 * std::sqrt(thickness);
    const Vector3d m(0.2 * std::sqrt(thickness), 0.3, 0.8);
    Rotation one_by_one = {Quaterniond::Identity(), m};
    for (int i = 0; i < 20; ++i) {
      const Rotation next = turned(one_by_one.m_B, I, h);
      one_by_one = {one_by_one.q_BBnext * next.q_BBnext, next.m_B};
    }
    const Rotation end = coasted(m, I, h, 20);
    EXPECT_NEAR(end.q_BBnext.norm(), 1, 4 * kEps) << thickness;
    EXPECT_LT(difference(end, one_by_one), 1e-13) << thickness;
  }
}

TEST(BatchCoasting, IsTheExactRotationStepByStep) {
  Sampler sample(13);
  double worst = 0;
  for (int i = 0; i < 300; ++i) {
    const Vector3d I = i % 10 == 0 ? Vector3d(2, 2, 2) : boxMoments(sample);
    Vector3d w = 3 * sample.vector();
    if (i % 7 == 0) w(i % 3) = 0;
    if (i % 11 == 0) w = Vector3d(2 * Vector3d::Unit(i % 3));
    const Vector3d m = I.cwiseProduct(w);
    const double h = 0.05 + 0.1 * std::abs(sample.number());
    const int steps = 40;
    const double error = difference(coasted(m, I, h, steps), flown(m, I, steps * h)) /
                         (kEps * (1 + 3 * steps * h * w.norm()));
    worst = std::max(worst, error);
    EXPECT_LT(error, 30) << i << " " << I.transpose() << " | " << w.transpose();
  }
  RecordProperty("worst_eps", std::to_string(worst));
}

}  // namespace
}  // namespace rigid_body_sim::batch

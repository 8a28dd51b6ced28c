// The exact rotation is as good as its inputs: its error, over a thousand bodies of every kind,
// against what one unit in the last place of an input does to the true answer.
#include <algorithm>
#include <cmath>
#include <functional>

#include "reference/free_rotation.hpp"
#include "rotor.hpp"

namespace rigid_body_sim {
namespace {

struct Inputs {
  Vector3d I_BBcm_B;
  Vector3d m_B;
  double h;
};

reference::Quaternionr truth(const Inputs& inputs) {
  return reference::freeAttitudes(inputs.I_BBcm_B, Quaterniond::Identity(), inputs.m_B, inputs.h, 1)
      .back();
}

double angle(const reference::Quaternionr& a, const reference::Quaternionr& b) {
  return static_cast<double>(2 * (a.conjugate() * b).vec().norm());
}

/// The largest turn of the answer when one of the seven inputs changes by one unit in its last
/// place.
double effectOfOneUlp(const Inputs& inputs) {
  const reference::Quaternionr q = truth(inputs);
  double worst = 0;
  for (int i = 0; i < 7; ++i) {
    Inputs changed = inputs;
    double& x = i < 3 ? changed.I_BBcm_B(i) : i < 6 ? changed.m_B(i - 3) : changed.h;
    x = std::nextafter(x, kInf);
    worst = std::max(worst, angle(q, truth(changed)));
  }
  return worst;
}

enum Kind { kGeneric, kSphere, kProlate, kOblate, kAlmostSphere, kRod, kSeparatrix, kKindCount };

/// Momenta in every direction, |w| h from 0.001 to 10.
Inputs inputsOf(int kind, std::mt19937& generator) {
  std::uniform_real_distribution<double> u(0, 1);
  std::normal_distribution<double> normal;
  const double a = 0.5 + u(generator), b = a * (1 + u(generator));
  Vector3d I(a, b, b + a * u(generator));
  if (kind == kSphere) I.setConstant(a);
  if (kind == kProlate) I << a, b, b;
  if (kind == kOblate) I << a, a, a * (1 + u(generator));
  if (kind == kAlmostSphere) I << a, a * (1 + 1e-15), a * (1 + 3e-15);
  if (kind == kRod) {
    const double thin = a * std::pow(10, -6 * u(generator));
    I << thin, a, a + thin * u(generator);
  }
  std::sort(I.data(), I.data() + 3);
  Vector3d w(normal(generator), normal(generator), normal(generator));
  // m1^2 (1/I1 - 1/I2) = m3^2 (1/I2 - 1/I3), up to rounding.
  if (kind == kSeparatrix) w.z() = w.x() * std::sqrt(I(0) * (I(1) - I(0)) / (I(2) * (I(2) - I(1))));
  const double h = 0.02;
  w *= std::pow(10, -3 + 4 * u(generator)) / (w.norm() * h);
  return {I, I.cwiseProduct(w), h};
}

TEST(ExactCondition, ErrorIsThatOfRoundingTheInputs) {
  std::mt19937 generator(7);
  std::vector<double> ratios;
  for (int i = 0; i < 1001; ++i) {
    const Inputs inputs = inputsOf(i % kKindCount, generator);
    const batch::Rotation found = batch::turned(inputs.m_B, inputs.I_BBcm_B, inputs.h);
    const double error = angle(found.q_BBnext.cast<reference::Real>().normalized(), truth(inputs));
    // A turn of a thousandth of a radian changes by 1e-19 with its inputs; no double has that.
    ratios.push_back(error / std::max(effectOfOneUlp(inputs), kEps / 2));
  }
  std::sort(ratios.begin(), ratios.end());
  RecordProperty("median", std::to_string(ratios[500]));
  RecordProperty("percentile_99", std::to_string(ratios[990]));
  RecordProperty("worst", std::to_string(ratios[1000]));
  EXPECT_LT(ratios[500], 1);
  EXPECT_LT(ratios[990], 30);
}

}  // namespace
}  // namespace rigid_body_sim

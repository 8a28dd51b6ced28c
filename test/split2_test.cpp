// What is promised of split2 beyond the laws of every row.
#include <cmath>

#include "generic.hpp"
#include "reference/free_rotation.hpp"

namespace rigid_body_sim {
namespace {

Bodies bodiesOf(const reference::Case& one) {
  Bodies bodies(1);
  bodies.mass << one.mass;
  bodies.I_BBcm_B.row(0) = one.I_BBcm_B;
  BodyState start;
  start.q_WB = genericAttitude();
  start.L_WBcm_W = start.q_WB * one.I_BBcm_B.cwiseProduct(one.w_WB_B);
  bodies.setState(0, start);
  return bodies;
}

void fly(Bodies& bodies, int steps) {
  const auto integrator = integratorNamed("split2").make({});
  ActiveEffects none;
  for (int i = 0; i < steps; ++i) integrator->step(bodies, none, i * 0.02, 0.02);
}

TEST(Split2, PromisesWhatTheReadmeSays) {
  // The laws measure what a row states: a row that states less would pass them all.
  const IntegratorRow& row = integratorNamed("split2");
  EXPECT_EQ(row.order, 2);
  EXPECT_TRUE(row.keeps_angular_momentum);
  EXPECT_TRUE(row.bounded_energy);
  EXPECT_EQ(row.evaluations, 2);
}

TEST(Split2, IsExactForSymmetricBodies) {
  for (const char* name : {"prolate_top", "oblate_top", "sphere"}) {
    const reference::Case& top = reference::caseNamed(name);
    Bodies bodies = bodiesOf(top);
    const int steps = 500;
    fly(bodies, steps);
    const auto exact =
        reference::symmetricTop(top.I_BBcm_B, {genericAttitude(), top.w_WB_B}, steps * 0.02);
    // Some kEps a step, and each step's error of the own spin turns the body ever after; measured:
    // 333 kEps.
    EXPECT_LE(angleBetween(bodies.state(0).q_WB, exact.q_WB), 2 * steps * kEps) << name;
  }
}

TEST(Split2, TurnsAThinRodByTheRoundingOfItsSmallestMoment) {
  // The attitude walks by half a kEps a step, sqrt(n) / 2 kEps in n steps and 2/3 of it on average.
  // That tilts m = R^T L: its component along the rod is off by |L| times as much, and over I1 that
  // is the rate at which the rod turns wrongly. Measured: 1.3e-8 rad of the bound's 3.7e-8 after
  // 10 s, 5.9e-7 rad of 1.2e-6 after 100 s.
  const reference::Case& rod = reference::caseNamed("thin_rod");
  for (const int steps : {500, 5000}) {
    Bodies bodies = bodiesOf(rod);
    fly(bodies, steps);
    const double T = steps * 0.02;
    const auto exact = reference::symmetricTop(rod.I_BBcm_B, {genericAttitude(), rod.w_WB_B}, T);
    const double L = rod.I_BBcm_B.cwiseProduct(rod.w_WB_B).norm();
    const double rate = L * (std::sqrt(steps) / 3) * kEps / rod.I_BBcm_B(0);
    EXPECT_LE(angleBetween(bodies.state(0).q_WB, exact.q_WB), T * rate) << steps;
  }
}

TEST(Split2, GivesTheSameBitsWhateverTheUnitOfMass) {
  // Moments and momenta times a power of two: every product is, too. Beyond 2^511 the product of
  // two moments is no number any more.
  const reference::Case& one = reference::caseNamed("dzhanibekov");
  Bodies unit = bodiesOf(one);
  fly(unit, 500);
  for (const int power : {-560, -500, -1, 1, 500, 560}) {
    Bodies scaled = bodiesOf(one);
    scaled.I_BBcm_B *= std::exp2(power);
    scaled.L_WBcm_W *= std::exp2(power);
    fly(scaled, 500);
    EXPECT_TRUE(sameBits(scaled.state(0).q_WB.coeffs(), unit.state(0).q_WB.coeffs())) << power;
  }
}

}  // namespace
}  // namespace rigid_body_sim

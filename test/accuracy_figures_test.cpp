// The README's table of accuracy, and NASA's brick: every figure that is written down, measured
// again, from both sides.
#include <algorithm>
#include <cmath>
#include <map>

#include "generic.hpp"
#include "reference/free_rotation.hpp"
#include "rigid_body_sim/conserved.hpp"

namespace rigid_body_sim {
namespace {

const reference::Case& dzhanibekov() { return reference::caseNamed("dzhanibekov"); }

Simulator simulatorOf(const reference::Case& one, const std::string& integrator,
                      Gyroscopic gyroscopic = Gyroscopic::kOn) {
  Scene scene = sceneOf(sceneBodyOf(one), integrator);
  scene.gyroscopic = gyroscopic;
  return Simulator(scene);
}

/// The true attitudes at 0, 0.02 s, ... 100 s.
std::vector<Quaterniond> trueAttitudes(const reference::Case& one) {
  const BodyState start = simulatorOf(one, "exact").state(0);
  std::vector<Quaterniond> attitudes;
  for (const reference::Quaternionr& q :
       reference::freeAttitudes(one.I_BBcm_B, start.q_WB, start.L_WBcm_W, 0.02, 5000))
    attitudes.push_back(q.cast<double>());
  return attitudes;
}

/// The largest error of the attitude [rad] at any tick.
double worstAngle(const reference::Case& one, const std::string& integrator, Gyroscopic gyroscopic,
                  int seconds) {
  static std::map<std::string, std::vector<Quaterniond>> truth;
  if (!truth.count(one.name)) truth[one.name] = trueAttitudes(one);
  Simulator simulator = simulatorOf(one, integrator, gyroscopic);
  double worst = 0;
  for (int tick = 1; tick <= 50 * seconds; ++tick) {
    simulator.step();
    worst = std::max(worst, angleBetween(simulator.state(0).q_WB, truth[one.name][tick]));
  }
  return worst;
}

double worstAngle(const std::string& integrator, Gyroscopic gyroscopic, int seconds) {
  return worstAngle(dzhanibekov(), integrator, gyroscopic, seconds);
}

/// What ten minutes leave of energy and angular momentum, and by how much the latter is off.
struct AfterTenMinutes {
  double energy;
  double momentum;
  double momentum_off;
};

AfterTenMinutes afterTenMinutes(const std::string& integrator, Gyroscopic gyroscopic) {
  Simulator simulator = simulatorOf(dzhanibekov(), integrator, gyroscopic);
  const BodyState start = simulator.state(0);
  for (int i = 0; i < 30000; ++i) simulator.step();
  const BodyState end = simulator.state(0);
  const Vector3d& I = dzhanibekov().I_BBcm_B;
  const double L = start.L_WBcm_W.norm();
  return {kineticEnergy(end, 1, I) / kineticEnergy(start, 1, I), end.L_WBcm_W.norm() / L,
          (end.L_WBcm_W - start.L_WBcm_W).norm() / L};
}

TEST(AccuracyFigures, OfATumblingBody) {
  struct Row {
    const char* integrator;
    double in_10_s, in_100_s;
  };
  // Within 3 %: truncation. Rounding, of `rk8` and `exact`, may differ: at most twice as much.
  for (const Row& row : {Row{"split2", 3.62e-4, 6.55e-3}, Row{"rk4", 2.29e-6, 2.09e-5}}) {
    EXPECT_NEAR(worstAngle(row.integrator, Gyroscopic::kOn, 10), row.in_10_s, 0.03 * row.in_10_s);
    EXPECT_NEAR(worstAngle(row.integrator, Gyroscopic::kOn, 100), row.in_100_s,
                0.03 * row.in_100_s);
  }
  for (const Row& row : {Row{"rk8", 6.4e-13, 1.5e-10}, Row{"exact", 1.6e-14, 1.7e-13}}) {
    EXPECT_LE(worstAngle(row.integrator, Gyroscopic::kOn, 10), 2 * row.in_10_s);
    EXPECT_LE(worstAngle(row.integrator, Gyroscopic::kOn, 100), 2 * row.in_100_s);
  }
}

TEST(AccuracyFigures, OfAFastSpinner) {
  // 1.9 rad a step; measured: 6.0e-13 for `exact`, for all that do not refuse it 3.14.
  const reference::Case& spinner = reference::caseNamed("fast_spinner");
  // The C library's sine is in its constants, whose last bit differs by the processor: ten times.
  EXPECT_LE(worstAngle(spinner, "exact", Gyroscopic::kOn, 100), 10 * 6.0e-13);
  for (const char* name : {"split2", "semi_implicit", "semi_implicit_newton"})
    EXPECT_GE(worstAngle(spinner, name, Gyroscopic::kOn, 100), 3) << name;
}

TEST(AccuracyFigures, TheOthersLoseTheAttitudeInTenSeconds) {
  struct Row {
    const char* integrator;
    Gyroscopic gyroscopic;
    int seconds;
    double angle;
  };
  const auto off = Gyroscopic::kOff, on = Gyroscopic::kOn;
  for (const Row& row :
       {Row{"semi_implicit_velocity", on, 10, 3.135}, Row{"semi_implicit_velocity", off, 10, 3.124},
        Row{"semi_implicit_velocity", off, 100, 3.138}, Row{"semi_implicit_newton", on, 100, 3.138},
        Row{"semi_implicit", on, 100, 3.141}, Row{"explicit_euler", on, 100, 3.141},
        Row{"explicit_euler_velocity", on, 10, 3.139},
        Row{"explicit_euler_velocity", on, 100, 3.138}}) {
    EXPECT_NEAR(worstAngle(row.integrator, row.gyroscopic, row.seconds), row.angle, 0.01)
        << row.integrator << ", " << row.seconds << " s";
  }
}

TEST(AccuracyFigures, WithoutTheGyroscopicTermAngularMomentumIsOff) {
  const AfterTenMinutes left = afterTenMinutes("semi_implicit_velocity", Gyroscopic::kOff);
  EXPECT_NEAR(left.energy, 1, 30000 * 4 * kEps);
  EXPECT_NEAR(left.momentum_off, 0.025, 0.0005);
}

TEST(AccuracyFigures, ExplicitEulerLosesEnergyAndAngularMomentum) {
  const AfterTenMinutes left = afterTenMinutes("explicit_euler_velocity", Gyroscopic::kOn);
  EXPECT_NEAR(1 - left.energy, 0.23, 0.005);
  EXPECT_NEAR(1 - left.momentum, 0.38, 0.005);
}

TEST(AccuracyFigures, SemiImplicitEulerIsInfiniteAfter54Seconds) {
  Simulator simulator = simulatorOf(dzhanibekov(), "semi_implicit_velocity");
  while (simulator.frozenBodies().empty() && simulator.tick() < 30000) simulator.step();
  ASSERT_EQ(simulator.frozenBodies().size(), 1u);
  // Rounding alone moves the end: 53.3 s to 54.2 s in twenty attitudes, 53.6 s here.
  EXPECT_NEAR(static_cast<double>(simulator.frozenBodies()[0].tick) * 0.02, 53.8, 0.7);
}

TEST(AccuracyFigures, EnergyOfTheOthersAfterTenMinutes) {
  const auto energy = [](const char* name) {
    return afterTenMinutes(name, Gyroscopic::kOn).energy - 1;
  };
  EXPECT_NEAR(energy("exact"), 0, 3e-15);
  EXPECT_NEAR(energy("rk8"), 0, 1.7e-14);
  EXPECT_NEAR(energy("rk4"), -3.1e-9, 0.2e-9);
  EXPECT_NEAR(energy("semi_implicit"), 1, 0.01);  // all about the smallest axis: L^2 / 2 I1
  EXPECT_NEAR(energy("explicit_euler"), 1, 0.01);
  EXPECT_NEAR(energy("semi_implicit_newton"), -0.95, 0.01);
  EXPECT_NEAR(afterTenMinutes("semi_implicit_newton", Gyroscopic::kOn).momentum_off, 0.72, 0.01);
}

TEST(AccuracyFigures, NasasBrickEndsWithinNasasDigits) {
  const reference::Case& brick = reference::caseNamed("nesc_brick");
  Simulator simulator(sceneOf(sceneBodyOf(brick), "exact"));
  const BodyState start = simulator.state(0);
  simulator.advance(1500);
  const BodyState end = simulator.state(0);
  const reference::Quaternionr truth =
      reference::freeAttitudes(brick.I_BBcm_B, start.q_WB, start.L_WBcm_W, 30, 1).back();
  const auto off = 2 * (truth.conjugate() * end.q_WB.cast<reference::Real>()).vec().norm();
  RecordProperty("off", std::to_string(static_cast<double>(off) * 1e15) + "e-15");
  // As of any free flight, 16 roundings of the 19.6 rad turned through: measured 1.5e-14 rad, 9e-13
  // degrees. Wanted: 1e-8 degrees.
  EXPECT_LE(off, 16 * kEps * (1 + 19.6));
  const double angle = angleBetween(end.q_WB, brick.published->q_B0B.normalized());
  const double rate =
      difference(angularVelocityInBody(end, brick.I_BBcm_B), brick.published->w_WB_B);
  RecordProperty("angle", std::to_string(angle * 1e9) + "e-9");
  EXPECT_LE(angle, brick.published->attitude_rounding);
  EXPECT_LE(rate, brick.published->rate_rounding);
}

}  // namespace
}  // namespace rigid_body_sim

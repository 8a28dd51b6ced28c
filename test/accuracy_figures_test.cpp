// The README's table of accuracy, and NASA's brick: every figure that is written down, measured
// again, from both sides.
#include <algorithm>
#include <cmath>

#include "generic.hpp"
#include "reference/flight.hpp"
#include "rigid_body_sim/conserved.hpp"

namespace rigid_body_sim {
namespace {

const reference::Case& dzhanibekov() { return reference::caseNamed("dzhanibekov"); }

Simulator simulatorOf(const std::string& integrator, Gyroscopic gyroscopic = Gyroscopic::kOn) {
  Scene scene = sceneOf(sceneBodyOf(dzhanibekov()), integrator);
  scene.gyroscopic = gyroscopic;
  return Simulator(scene);
}

/// The true attitudes at 0.2 s, 0.4 s ... 100 s. In pieces of a second, as one flight of 100 s
/// would take thousands of steps.
const std::vector<Quaterniond>& trueAttitudes() {
  static const std::vector<Quaterniond> attitudes = [] {
    std::vector<Quaterniond> found;
    const reference::Case& one = dzhanibekov();
    BodyState start = simulatorOf("split2").state(0);
    for (int second = 0; second < 100; ++second) {
      BodyState end;
      for (int fifth = 1; fifth <= 5; ++fifth) {
        end = reference::fly(start, one.mass, one.I_BBcm_B, reference::nothing, 0.2 * fifth).end;
        found.push_back(end.q_WB);
      }
      start = end;
    }
    return found;
  }();
  return attitudes;
}

double worstAngle(const std::string& integrator, Gyroscopic gyroscopic, int seconds) {
  Simulator simulator = simulatorOf(integrator, gyroscopic);
  double worst = 0;
  for (int i = 0; i < 5 * seconds; ++i) {
    for (int tick = 0; tick < 10; ++tick) simulator.step();
    worst = std::max(worst, angleBetween(simulator.state(0).q_WB, trueAttitudes()[i]));
  }
  return worst;
}

/// What ten minutes leave of energy and angular momentum, and by how much the latter is off.
struct AfterTenMinutes {
  double energy;
  double momentum;
  double momentum_off;
};

AfterTenMinutes afterTenMinutes(const std::string& integrator, Gyroscopic gyroscopic) {
  Simulator simulator = simulatorOf(integrator, gyroscopic);
  const BodyState start = simulator.state(0);
  for (int i = 0; i < 30000; ++i) simulator.step();
  const BodyState end = simulator.state(0);
  const Vector3d& I = dzhanibekov().I_BBcm_B;
  const double L = start.L_WBcm_W.norm();
  return {kineticEnergy(end, 1, I) / kineticEnergy(start, 1, I), end.L_WBcm_W.norm() / L,
          (end.L_WBcm_W - start.L_WBcm_W).norm() / L};
}

TEST(AccuracyFigures, Split2IsOffByAThirdOfAMilliradianInTenSeconds) {
  EXPECT_NEAR(worstAngle("split2", Gyroscopic::kOn, 10), 3.59e-4, 0.03 * 3.59e-4);
  EXPECT_NEAR(worstAngle("split2", Gyroscopic::kOn, 100), 6.53e-3, 0.03 * 6.53e-3);
}

TEST(AccuracyFigures, ExactIsOffByRoundingOnly) {
  // Spread by the unstable axis; measured: 1.9e-11 and 3.3e-10.
  EXPECT_LE(worstAngle("exact", Gyroscopic::kOn, 10), 1e-10);
  EXPECT_LE(worstAngle("exact", Gyroscopic::kOn, 100), 2e-9);
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
        Row{"semi_implicit_velocity", off, 100, 3.138},
        Row{"explicit_euler_velocity", on, 10, 3.043},
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
  Simulator simulator = simulatorOf("semi_implicit_velocity");
  while (simulator.frozenBodies().empty() && simulator.tick() < 30000) simulator.step();
  ASSERT_EQ(simulator.frozenBodies().size(), 1u);
  // Rounding alone moves the end: 53.3 s to 54.2 s in twenty attitudes, 53.6 s here.
  EXPECT_NEAR(static_cast<double>(simulator.frozenBodies()[0].tick) * 0.02, 53.8, 0.7);
}

TEST(AccuracyFigures, NasasBrickIsInsideTheSpreadOfNasasTools) {
  const reference::Case& brick = reference::caseNamed("nesc_brick");
  Simulator simulator(sceneOf(sceneBodyOf(brick)));
  for (int i = 0; i < 1500; ++i) simulator.step();
  const BodyState end = simulator.state(0);
  const double degree = kPi / 180;
  const double angle = angleBetween(end.q_WB, brick.published->q_B0B.normalized()) / degree;
  const double rate =
      difference(angularVelocityInBody(end, brick.I_BBcm_B), brick.published->w_WB_B) / degree;
  // The tools of the report differ by 0.0104 deg and 0.0047 deg/s.
  EXPECT_NEAR(angle, 3.6e-4, 0.4e-4);
  EXPECT_NEAR(rate, 2.2e-4, 0.3e-4);
}

}  // namespace
}  // namespace rigid_body_sim

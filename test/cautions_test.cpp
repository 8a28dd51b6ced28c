// What is said of errors that a method makes where it is stable.
#include "generic.hpp"

namespace rigid_body_sim {
namespace {

/// Under gravity and this, from rest.
std::string fallingUnder(const std::string& friction, int substeps = 1) {
  return "{substeps: " + std::to_string(substeps) +
         ", effects: {gravity: {acceleration: [0, 0, -9.8]}, " + friction +
         "}, bodies: {flake: {point_mass: 1.0e-6}}}";
}

TEST(Caution, ThatFrictionStopsABodyWithinAStepSaysHowSlowlyItMoves) {
  for (const int substeps : {1, 2}) {
    const double x = 400 * 0.02 / substeps;
    Simulator simulator(sceneFrom(fallingUnder("damping: {linear: 400}", substeps)));
    std::ostringstream share;
    share << 100 * 0.5 * x / std::sinh(0.5 * x) << " % of the right speed";
    ASSERT_EQ(simulator.scene().warnings.size(), 1u);
    EXPECT_TRUE(contains(simulator.scene().warnings[0],
                         {"'flake'", "'damping'", share.str(), "with 16 substeps", "rk4"}));
    for (int k = 0; k < 100; ++k) simulator.step();
    const double before = simulator.state(0).p_WBcm.z();
    simulator.step();
    EXPECT_NEAR((before - simulator.state(0).p_WBcm.z()) / 0.02 / (9.8 / 400),
                0.5 * x / std::sinh(0.5 * x), 1e-6);
  }
}

TEST(Caution, OfWhatKicksWithinFrictionKnowsNoShare) {
  const std::string friction = fallingUnder("damping: {linear: 60}").substr(1);
  const Simulator momenta(sceneFrom("{" + friction));
  EXPECT_TRUE(contains(momenta.scene().warnings.at(0), {"as little as"}));
  const Simulator velocities(sceneFrom("{integrator: semi_implicit_velocity, " + friction));
  EXPECT_TRUE(contains(velocities.scene().warnings.at(0), {"a wrong speed"}));
}

TEST(Caution, ThatNoSubstepsCanMendSaysSo) {
  const Simulator simulator(sceneFrom(fallingUnder("damping: {linear: 1.0e+7}")));  // 1e7 1/s
  ASSERT_EQ(simulator.scene().warnings.size(), 1u);
  EXPECT_TRUE(contains(simulator.scene().warnings[0], {"no number of substeps", "step_s"}));
  EXPECT_FALSE(contains(simulator.scene().warnings[0], {"rk4"}));
}

TEST(Caution, ThatDragStopsABodyWithinAStepComesWhenItDoes) {
  // From rest there is no drag; at the terminal 0.1 m/s its rate is 2 g / v = 196 1/s.
  Simulator simulator(sceneFrom(fallingUnder("drag: {air_density: 1.225, drag_area: 1.6e-3}")));
  EXPECT_FALSE(simulator.stiffBody());
  for (int k = 0; k < 100; ++k) simulator.step();
  const auto stiff = simulator.stiffBody();
  ASSERT_TRUE(stiff);
  EXPECT_EQ(stiff->body, 0);
  EXPECT_TRUE(contains(stiff->why, {"'drag' slows it down", "a wrong speed"}));
}

// A dashpot of 30 1/s, so long that its direction does not change.
const std::string kDashpot =
    "spring: [{body: flake, anchor: [0, 0, -1.0e+6], stiffness: 0, damping: 3.0e-5}]";

TEST(Caution, FrictionsOfABodyCountTogether) {
  EXPECT_TRUE(Simulator(sceneFrom(fallingUnder("damping: {linear: 30}"))).scene().warnings.empty());
  EXPECT_TRUE(Simulator(sceneFrom(fallingUnder(kDashpot))).scene().warnings.empty());
  Simulator simulator(sceneFrom(fallingUnder("damping: {linear: 30}, " + kDashpot)));
  ASSERT_EQ(simulator.scene().warnings.size(), 1u);
  EXPECT_TRUE(contains(simulator.scene().warnings[0],
                       {"'flake'", "'damping' and 'spring_damping' together", "at up to 60 1/s",
                        "a wrong speed", "with 3 substeps"}));
  EXPECT_TRUE(simulator.stiffBody());
  // Along the line itself it is as for one friction of both.
  const double x = 60 * 0.02, share = 0.5 * x / std::sinh(0.5 * x);
  simulator.advance(1000);
  const double before = simulator.state(0).p_WBcm.z();
  simulator.step();
  EXPECT_NEAR((before - simulator.state(0).p_WBcm.z()) / 0.02 / (9.8 / 60), share, 1e-6);
}

TEST(Caution, FrictionThatLeavesNothingOfASpeedSaysSoWithoutDigits) {
  const Simulator simulator(sceneFrom(fallingUnder("damping: {linear: 4000}")));
  ASSERT_EQ(simulator.scene().warnings.size(), 1u);
  EXPECT_TRUE(contains(simulator.scene().warnings[0], {"less than 0.01 % of the right speed"}));
}

TEST(Caution, FrictionsCountOnTheBodyThatHasMost) {
  const std::string two =
      "effects: {damping: {linear: 30}, spring: [{body: b, anchor: [0, 0, -1.0e+6], stiffness: 0, "
      "damping: 30}]}, bodies: {a: {point_mass: 1}, b: {point_mass: 1}}}";
  const Simulator simulator(sceneFrom("{" + two));
  ASSERT_EQ(simulator.scene().warnings.size(), 1u);
  EXPECT_TRUE(contains(simulator.scene().warnings[0], {"'b'", "up to 60 1/s"}));
  EXPECT_EQ(simulator.stiffBody()->body, 1);
}

TEST(Caution, FrictionsOfDifferentBodiesDoNot) {
  const Simulator simulator(
      sceneFrom("{effects: {damping: {linear: 30}, " + kDashpot +
                "}, bodies: {flake: {point_mass: 1.0e-6, damping: false}, b: {point_mass: 1}}}"));
  EXPECT_TRUE(simulator.scene().warnings.empty());
}

TEST(Caution, IsNotSaidUnderABudgetThatCoversIt) {
  Scene scene = sceneFrom(fallingUnder("damping: {linear: 60}"));
  EXPECT_EQ(Simulator(scene).scene().warnings.size(), 1u);
  scene.accuracy.emplace();  // loose enough for a method that the caution is of
  scene.accuracy->position_m = 1;
  scene.accuracy->over_s = 2;
  const Simulator simulator(scene);
  const Method& method = simulator.scene().methods.at(0).method;
  EXPECT_TRUE(integratorNamed(method.integrator).has_drifts);
  EXPECT_EQ(method.substeps, 1);
  EXPECT_TRUE(simulator.scene().warnings.empty());
}

TEST(Caution, OfASwitchComesAfterTheScenesOwn) {
  Simulator simulator(sceneFrom(fallingUnder("damping: {linear: 400}")));
  const std::vector<std::string> at_start = simulator.scene().warnings;
  ASSERT_EQ(at_start.size(), 1u);
  const std::vector<std::string> both = {at_start[0], at_start[0]};
  for (int times = 0; times < 2; ++times) {
    simulator.switchEffect("damping", false);
    EXPECT_EQ(simulator.scene().warnings, at_start);
    simulator.switchEffect("damping", true);
    EXPECT_EQ(simulator.scene().warnings, both);
  }
  simulator.reset();
  EXPECT_EQ(simulator.scene().warnings, at_start);
}

// ---- The start looks ahead

std::vector<std::string> warningsOf(const std::string& scene) {
  return Simulator(sceneFrom(scene)).scene().warnings;
}

TEST(LookAhead, FindsDragThatWillStopABodyWithinAStep) {
  // v' = g at first, so that the rate 2 k v / m is above one a step when v = m / (2 k h) = 0.0255
  // m/s: in the first tick.
  const auto warnings = warningsOf(fallingUnder("drag: {air_density: 1.225, drag_area: 1.6e-3}"));
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_TRUE(contains(warnings[0], {"'flake', 0.02 s after the start", "'drag' slows it down"}));
}

TEST(LookAhead, FindsACloseEncounter) {
  // Falls 1 m in pi/2 sqrt(r^3 / 2 mu) = 0.351 s, and sqrt(mu/r^3) exceeds half a radian a step
  // below 0.253 m; the last 0.253 m take less than 0.05 s.
  const std::string comet =
      "{effects: {central_gravity: {mu: 10}}, bodies: {comet: {point_mass: 1, position: [1, 0, 0], "
      "linear_velocity: [0, 0.1, 0]}}}";
  const auto warnings = warningsOf(comet);
  ASSERT_EQ(warnings.size(), 1u);
  double when_s = 0;
  ASSERT_EQ(std::sscanf(warnings[0].c_str(), "body 'comet', %lf s after the start", &when_s), 1);
  EXPECT_GE(when_s, 0.30);
  EXPECT_LE(when_s, 0.36);
  EXPECT_TRUE(contains(warnings[0], {"'central_gravity' is too stiff", "substeps"}));
}

TEST(LookAhead, FindsAHeavyBodyThatWillHangOffItsCentre) {
  // m g e = 98 N m turn a moment of 0.01 kg m^2: 99 rad/s, once the spring is stretched.
  const std::string hung =
      "{effects: {gravity: {acceleration: [0, 0, -9.8]}, spring: [{body: bob, point: [0, 0, 1], "
      "anchor: [0, 0, 1], stiffness: 5}]}, bodies: {bob: {mass: 10, inertia: [0.01, 0.01, 0.01], "
      "orientation: [0.1, 0, 0, 0.995]}}}";
  const auto warnings = warningsOf(hung);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_TRUE(contains(warnings[0], {"'bob'", "s after the start", "'spring' is too stiff"}));
}

/// A force that is infinite from 0.5 s on.
class Bursts : public Effect {
 public:
  std::string name() const override { return "bursts"; }
  std::size_t bodyCount() const override { return 1; }
  void addWrenches(const Instant& now, Wrenches& wrenches) const override {
    if (now.time_s() > 0.495) wrenches.f_W(0, 0) += std::numeric_limits<double>::infinity();
  }
};

TEST(LookAhead, FindsAStateThatWillBeInfinite) {
  Scene scene = sceneFrom("{bodies: {a: {point_mass: 1}}}");
  scene.effects = {std::make_shared<Bursts>()};
  const Simulator simulator(scene);
  ASSERT_EQ(simulator.scene().warnings.size(), 1u);
  EXPECT_EQ(simulator.scene().warnings[0],
            "body 'a', 0.5 s after the start: its state becomes infinite");
  EXPECT_TRUE(simulator.frozenBodies().empty());
  EXPECT_EQ(simulator.tick(), 0);
}

TEST(LookAhead, LeavesNoTraceAndSaysNothingOfWhatStaysWithinTheLimits) {
  const std::string swing =
      "{effects: {gravity: {acceleration: [0, 0, -9.8]}, spring: [{body: bob, anchor: [0, 0, 1], "
      "stiffness: 50, damping: 1}]}, bodies: {bob: {mass: 1, inertia: [0.1, 0.1, 0.1]}}}";
  const Simulator simulator(sceneFrom(swing));
  EXPECT_TRUE(simulator.scene().warnings.empty());
  for (const EffectCount& count : simulator.effectCounts()) EXPECT_EQ(count.evaluations, 0u);
}

}  // namespace
}  // namespace rigid_body_sim

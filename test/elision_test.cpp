// What is not computed, as it would change nothing: to the bit, and said.
#include <cstring>

#include "generic.hpp"

namespace rigid_body_sim {
namespace {

bool sameBits(const Simulator& a, const Simulator& b, Eigen::Index body) {
  const BodyState x = a.state(body), y = b.state(body);
  return std::memcmp(x.p_WBcm.data(), y.p_WBcm.data(), sizeof(double) * 3) == 0 &&
         std::memcmp(x.q_WB.coeffs().data(), y.q_WB.coeffs().data(), sizeof(double) * 4) == 0 &&
         std::memcmp(x.P_WB.data(), y.P_WB.data(), sizeof(double) * 3) == 0 &&
         std::memcmp(x.L_WBcm_W.data(), y.L_WBcm_W.data(), sizeof(double) * 3) == 0;
}

/// A sphere and a stone, off-centre in their frames, turned and spinning.
std::string scene(const std::string& integrator, const std::string& effects) {
  return "integrator: " + integrator + "\neffects: {" + effects +
         "}\nbodies:\n"
         "  ball: {mass: 2, inertia: [0.3, 0.3, 0.3], com: [0.1, 0.2, 0.3],"
         " orientation: [-0.48, 0.6, 0.36, 0.5291502622129181], angular_velocity: [3, -2, 5]}\n"
         "  stone: {mass: 2, inertia: [0.1, 0.2, 0.25], angular_velocity: [1, 2, 3]}\n";
}

WrenchInput push(Eigen::Index body) {
  WrenchInput input;
  input.body = body;
  input.applied = {Axes::kBody, {{0.3, -0.4, 0.5}, {0.2, 0.1, -0.3}}, {0.1, -0.2, 0.3}};
  input.start = 20;
  input.ticks = 30;
  return input;
}

TEST(Elision, ASphereFliesTheSameToTheBitWithAndWithoutTheGyroscopicTerm) {
  const std::string gravity = "gravity: {acceleration: [0.1, 0.2, -9.8]}, damping: {angular: 0.1}";
  for (const IntegratorRow& row : integrators()) {
    const bool bears_damping = row.order_under_drag > 0 || row.order == 0;
    const std::string effects = bears_damping ? gravity : "gravity: {acceleration: [1, 2, 3]}";
    Simulator on(sceneFrom(scene(row.name, effects + ", gyroscopic: true")));
    Simulator off(sceneFrom(scene(row.name, effects + ", gyroscopic: false")));
    for (Simulator* simulator : {&on, &off})
      for (const Eigen::Index body : {0, 1}) simulator->apply(push(body));
    for (int i = 0; i < 100; ++i) {
      on.step();
      off.step();
      ASSERT_TRUE(sameBits(on, off, 0)) << row.name << ", tick " << i;
    }
    EXPECT_FALSE(sameBits(on, off, 1)) << row.name << ": the stone has the term";
  }
}

TEST(Elision, ABodysOwnWordOnTheGyroscopicTermCounts) {
  for (const std::string integrator : {"exact", "rk4", "semi_implicit"}) {
    const std::string text = scene(integrator, "gyroscopic: true");
    std::string own = text;
    own.replace(own.find("stone: {"), 8, "stone: {gyroscopic: false, ");
    Simulator all_off(sceneFrom(scene(integrator, "gyroscopic: false"))), one_off(sceneFrom(own)),
        on(sceneFrom(text));
    for (int i = 0; i < 50; ++i)
      for (Simulator* simulator : {&all_off, &one_off, &on}) simulator->step();
    EXPECT_TRUE(sameBits(all_off, one_off, 1)) << integrator;
    EXPECT_FALSE(sameBits(all_off, on, 1)) << integrator;
  }
  EXPECT_NE(summary(sceneFrom("effects: {gyroscopic: false}\nbodies: {a: {mass: 1, inertia: [1, 2, "
                              "2.5], gyroscopic: true}, b: {point_mass: 1}}"))
                .find("gyroscopic off (on for 1)"),
            std::string::npos);
}

TEST(Elision, BodiesAtRestStayToTheBitUntilTheyArePushed) {
  for (const IntegratorRow& row : integrators()) {
    Scene scene = sceneFrom("{integrator: " + row.name +
                            ", bodies: {a: {mass: 2, inertia: [0.1, 0.2, 0.25], com: [0.1, 0, 0], "
                            "position: [1, -2, 3]}, b: {point_mass: 1}}}");
    Simulator simulator(scene), start(scene);
    for (int i = 0; i < 1000; ++i) simulator.step();
    for (const Eigen::Index body : {0, 1})
      EXPECT_TRUE(sameBits(simulator, start, body)) << row.name;
    ImpulseInput kick;
    kick.applied = {Axes::kWorld, {{1, 0, 0}, {0, 0, 0}}, {0, 0.1, 0}};
    simulator.apply(kick);
    simulator.step();
    EXPECT_FALSE(sameBits(simulator, start, 0)) << row.name;
    EXPECT_TRUE(sameBits(simulator, start, 1)) << row.name;
    for (int i = 0; i < 10; ++i) simulator.step();
    EXPECT_NEAR(simulator.state(0).p_WBcm.x() - start.state(0).p_WBcm.x(), 11 * 0.02 * 0.5, 1e-14);
    simulator.reset();
    simulator.step();
    EXPECT_TRUE(sameBits(simulator, start, 0)) << row.name;
  }
}

TEST(Elision, IsSaidOnceWithItsReason) {
  const std::vector<std::string> lines =
      elisions(sceneFrom("effects: {gravity: {acceleration: [0, 0, 0]}, damping: {linear: 0}}\n"
                         "bodies:\n"
                         "  a: {sphere: {radius: 1, density: 1}}\n"
                         "  b: {point_mass: 1}\n"
                         "  c: {mass: 1, inertia: [1, 2, 2.5]}\n"));
  EXPECT_EQ(lines,
            (std::vector<std::string>{
                "gravity: all its parameters are zero", "damping: all its parameters are zero",
                "gyroscopic for 1 of 3: spherical", "rotation for 1 of 3: point masses"}));
}

TEST(Elision, OfAllMotionIsSaidIfNothingMovesAndNothingActs) {
  const auto said = [](const std::string& effects, const std::string& more) {
    const std::vector<std::string> lines = elisions(
        Simulator(sceneFrom("{effects: {" + effects + "}, bodies: {a: {mass: 1, inertia: [1, 2, " +
                            "2.5]}, b: {mass: 1, inertia: [1, 2, 2.5]" + more + "}}}"))
            .scene());
    return !lines.empty() && lines.back().find("nothing is computed until") != std::string::npos;
  };
  EXPECT_TRUE(said("", ""));
  EXPECT_TRUE(said("gravity: {acceleration: [0, 0, 0]}", ""));
  EXPECT_FALSE(said("gravity: {acceleration: [0, 0, 1]}", ""));
  EXPECT_FALSE(said("", ", linear_velocity: [0, 0, 1]"));
  EXPECT_FALSE(said("", ", angular_velocity: [0, 0, 1]"));
}

TEST(Evaluations, AreTicksTimesBodiesTimesStages) {
  const std::map<std::string, int> kicks = {
      {"semi_implicit", 1}, {"exact", 2}, {"rk4", 4}, {"rk8", 12}};
  for (const auto& [integrator, stages] : kicks) {
    Simulator simulator(sceneFrom(scene(
        integrator, "gravity: {acceleration: [0, 0, -9.8]}, damping: {linear: 0, angular: 0}")));
    for (int i = 0; i < 25; ++i) simulator.step();
    const std::vector<EffectCount> counts = simulator.effectCounts();
    ASSERT_EQ(counts.size(), 1u) << "an effect of zeros is not there";
    EXPECT_EQ(counts[0].name, "gravity");
    EXPECT_EQ(counts[0].evaluations, 25u * 2 * static_cast<unsigned>(stages)) << integrator;
    simulator.reset();
    EXPECT_EQ(simulator.effectCounts()[0].evaluations, 0u);
  }
}

TEST(SwitchEffect, ActsFromTheNextTickOnAndAResetUndoesIt) {
  const std::string text = scene("exact", "gravity: {acceleration: [0, 0, -9.8]}");
  Simulator simulator(sceneFrom(text));
  simulator.switchEffect("gravity", false);
  for (int i = 0; i < 10; ++i) simulator.step();
  EXPECT_EQ(simulator.state(0).P_WB, Vector3d::Zero());
  simulator.switchEffect("gravity", true);
  simulator.step();
  EXPECT_NEAR(simulator.state(0).P_WB.z(), -2 * 9.8 * 0.02, 1e-15);
  simulator.switchEffect("gravity", false);
  simulator.reset();
  simulator.step();
  EXPECT_NEAR(simulator.state(0).P_WB.z(), -2 * 9.8 * 0.02, 1e-15);
}

TEST(SwitchEffect, RefusesWhatIsNotThereAndChangesNothing) {
  Simulator simulator(sceneFrom(scene("exact", "gravity: {acceleration: [0, 0, -9.8]}")));
  const std::string why = refusal([&] { simulator.switchEffect("drag", true); });
  EXPECT_NE(why.find("'drag'; there are gyroscopic, gravity"), std::string::npos) << why;
  simulator.step();
  EXPECT_NEAR(simulator.state(0).P_WB.z(), -2 * 9.8 * 0.02, 1e-15);
}

TEST(SwitchEffect, OfAnEffectThatDoesNothingSaysWhy) {
  Simulator simulator(sceneFrom(scene("exact", "gravity: {acceleration: [0, 0, 0]}")));
  const std::string why = refusal([&] { simulator.switchEffect("gravity", true); });
  EXPECT_TRUE(contains(why, {"'gravity' does nothing", "zero"}));
}

TEST(SwitchEffect, OfTheSpringsIsOfTheirDashpotsToo) {
  Simulator simulator(
      sceneFrom("{effects: {spring: [{body: a, anchor: [0, 0, 0], stiffness: 1, damping: 1}]}, "
                "bodies: {a: {point_mass: 1, position: [0, 0, 1], linear_velocity: [0, 0, 1]}}}"));
  EXPECT_EQ(simulator.effectNames(), (std::vector<std::string>{"gyroscopic", "spring"}));
  simulator.step();
  EXPECT_TRUE(simulator.switchEffect("spring", false));
  const Vector3d P = simulator.state(0).P_WB;
  for (int i = 0; i < 10; ++i) simulator.step();
  EXPECT_EQ(simulator.state(0).P_WB, P);
  EXPECT_EQ(simulator.effectCounts().size(), 2u) << "what they did is still counted";
  EXPECT_TRUE(simulator.switchEffect("spring", true));
  EXPECT_EQ(simulator.scene().effects.size(), 2u);
}

TEST(SwitchEffect, SaysWhetherItChangedAnything) {
  Simulator simulator(sceneFrom(scene("exact", "gravity: {acceleration: [0, 0, -9.8]}")));
  for (const std::string name : {"gravity", "gyroscopic"}) {
    EXPECT_FALSE(simulator.switchEffect(name, true)) << name;
    EXPECT_TRUE(simulator.switchEffect(name, false)) << name;
    EXPECT_FALSE(simulator.switchEffect(name, false)) << name;
    EXPECT_TRUE(simulator.switchEffect(name, true)) << name;
  }
}

TEST(SwitchEffect, MayAlwaysEndWhatActs) {
  // Spun up beyond what rk4 bears: that is no reason to hold on to gravity.
  Simulator simulator(sceneFrom(scene("rk4", "gravity: {acceleration: [0, 0, -9.8]}")));
  ImpulseInput spin;
  spin.body = 1;
  spin.applied = {Axes::kWorld, {{0, 0, 0}, {20, 0, 0}}, {0, 0, 0}};
  simulator.apply(spin);
  simulator.step();
  ASSERT_TRUE(simulator.overTurnedBody());
  EXPECT_NO_THROW(simulator.switchEffect("gravity", false));
}

TEST(SwitchEffect, IsRefusedUnderABudget) {
  Simulator simulator(
      sceneFrom("accuracy: {attitude_rad: 1.0e-3, over_s: 1}\n"
                "effects: {damping: {angular: 0.1}}\nbodies: {a: {mass: 1, inertia: [1, 2, 2.5],"
                " angular_velocity: [1, 2, 3]}}"));
  const std::string why = refusal([&] { simulator.switchEffect("damping", false); });
  EXPECT_NE(why.find("keeps its effects"), std::string::npos) << why;
}

TEST(SwitchEffect, KeepsTheBooksOfEnergy) {
  Simulator simulator(
      sceneFrom(scene("exact", "gravity: {acceleration: [0, 0, -9.8]}") + "energy_audit: true\n"));
  for (int i = 0; i < 50; ++i) simulator.step();
  simulator.switchEffect("gravity", false);
  for (int i = 0; i < 50; ++i) simulator.step();
  simulator.switchEffect("gravity", true);
  EXPECT_NEAR(simulator.energy().unaccounted_J(), 0, 1e-10);  // of some 400 J: roundings
  simulator.reset();
  EXPECT_EQ(simulator.energy().unaccounted_J(), 0);
}

TEST(SwitchEffect, OfTheGyroscopicTermIsTheScenesParameter) {
  Simulator switched(sceneFrom(scene("exact", ""))),
      off(sceneFrom(scene("exact", "gyroscopic: false")));
  switched.switchEffect("gyroscopic", false);
  for (int i = 0; i < 20; ++i) {
    switched.step();
    off.step();
  }
  EXPECT_TRUE(sameBits(switched, off, 1));
}

}  // namespace
}  // namespace rigid_body_sim

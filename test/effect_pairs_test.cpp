// Effects that act together: where one has a flow it must see the bodies as the others leave them.
#include <cmath>

#include "effect_blocks.hpp"

namespace rigid_body_sim {
namespace {

const std::vector<std::string> kEffects = {"added_mass", "gravity",         "damping",
                                           "drag",       "central_gravity", "magnetic_dipole",
                                           "buoyancy",   "spring",          "rotating_frame"};

/// Two bodies under these effects; no effect is listed twice.
Scene sceneOf(const std::vector<std::string>& names) {
  Sampler sample(99);
  auto blocks = blocksOf(sample);
  std::string effects;
  for (const std::string& name : names) effects += "  " + name + ": " + blocks.at(name) + "\n";
  if (effects.find("added_mass") != std::string::npos) eraseWhatAddedMassRefuses(effects);
  return sceneFrom(
      "effects:\n" + effects +
      "bodies:\n"
      "  a: {mass: 1.3, inertia: [1.6, -0.3, 0.2, 2.1, 0.4, 1.8], com: [0.1, 0.05, 0.1],"
      " linear_velocity: [0.5, -0.4, 0.3], angular_velocity: [0.8, -0.6, 1.1]}\n"
      "  b: {mass: 2.1, inertia: [1.2, 1.9, 2.3], position: [1.5, 1, -0.5],"
      " linear_velocity: [-0.3, 0.2, 0.4], angular_velocity: [-0.5, 0.9, 0.4]}\n");
}

Bodies flown(Scene scene, const std::string& integrator, double step_s, double time_s = 1.6) {
  scene.integrator = integrator;
  scene.step_ns = std::llround(step_s * 1e9);
  Simulator simulator(scene);
  for (int i = 0; i < std::lround(time_s / step_s); ++i) simulator.step();
  EXPECT_TRUE(simulator.frozenBodies().empty());
  return simulator.bodies();
}

double difference(const Bodies& a, const Bodies& b) {
  double worst = 0;
  for (Eigen::Index i = 0; i < a.count(); ++i) {
    const double angle = a.state(i).q_WB.angularDistance(b.state(i).q_WB);
    worst = std::max({worst, angle, (a.p_WBcm.row(i) - b.p_WBcm.row(i)).norm(),
                      (a.P_WB.row(i) - b.P_WB.row(i)).norm(),
                      (a.L_WBcm_W.row(i) - b.L_WBcm_W.row(i)).norm()});
  }
  return worst;
}

TEST(EffectPairs, AreOfSecondOrderByKickAndDriftAndEndWhereRungeAndKuttaDo) {
  for (std::size_t i = 0; i < kEffects.size(); ++i) {
    for (std::size_t k = i + 1; k < kEffects.size(); ++k) {
      if (kEffects[i] == "added_mass" && kEffects[k] == "rotating_frame") continue;  // refused
      const Scene scene = sceneOf({kEffects[i], kEffects[k]});
      const Bodies truth = flown(scene, "rk8", 0.01);
      for (const std::string integrator : {"exact", "split2"}) {
        const double whole = difference(flown(scene, integrator, 0.02), truth);
        const double half = difference(flown(scene, integrator, 0.01), truth);
        const std::string pair = integrator + ": " + kEffects[i] + " and " + kEffects[k];
        EXPECT_LE(whole, 3e-3) << pair;  // measured: at most 1e-3
        if (half < 1e-9) continue;       // solved exactly
        EXPECT_NEAR(std::log2(whole / half), 2, 0.1) << pair;
      }
    }
  }
}

TEST(EffectPairs, ALightBodyInAHeavyFluidIsBrakedWhereItIs) {
  // 10 g that carry 990 g along: a flow that saw where the drift with P/m alone would lead, a
  // hundred times too far, would be off by 0.07 m.
  const Scene scene = sceneFrom(
      "effects:\n"
      "  added_mass: {linear: [0.99, 0.99, 0.99]}\n"
      "  spring: [{body: a, anchor: [0, 0, 0], stiffness: 4, damping: 0.5, rest_length: 1}]\n"
      "bodies: {a: {mass: 0.01, inertia: [0.1, 0.1, 0.1], position: [1.2, 0.3, -0.2],"
      " linear_velocity: [0.3, -0.8, 0.5]}}\n");
  const Bodies truth = flown(scene, "rk8", 0.005, 4);
  const double whole = difference(flown(scene, "exact", 0.02, 4), truth);
  const double half = difference(flown(scene, "exact", 0.01, 4), truth);
  EXPECT_LE(whole, 2e-4);  // measured: 1.3e-4
  EXPECT_NEAR(std::log2(whole / half), 2, 0.1);
}

TEST(EffectPairs, DragBrakesTheVelocityThatAddedMassLeaves) {
  // Without rotational drag all bodies are braked in one loop, which must not take P/m for v.
  const Scene scene = sceneFrom(
      "effects:\n"
      "  added_mass: {linear: [1, 2, 3]}\n"
      "  drag: {air_density: 1.2, drag_area: 0.5}\n"
      "bodies: {a: {mass: 1, inertia: [1, 1.5, 2], linear_velocity: [1, -2, 1.5],"
      " angular_velocity: [0.4, 0.3, -0.2]}}\n");
  const Bodies truth = flown(scene, "rk8", 0.01);
  const double whole = difference(flown(scene, "exact", 0.02), truth);
  const double half = difference(flown(scene, "exact", 0.01), truth);
  EXPECT_LE(whole, 1e-3);
  EXPECT_NEAR(std::log2(whole / half), 2, 0.1);
}

TEST(EffectPairs, OfFlowsDoNotDependOnTheOrderOfTheList) {
  const Scene scene = sceneOf({"damping", "rotating_frame"});
  Scene turned = scene;
  std::reverse(turned.effects.begin(), turned.effects.end());
  EXPECT_EQ(difference(flown(scene, "exact", 0.02), flown(turned, "exact", 0.02)), 0);
}

TEST(EffectPairs, ThatAreTooStiffTogetherAreRefused) {
  // Each alone swings by 0.4 rad a step, both together by 0.57, and 0.5 are borne.
  const std::string body =
      "{a: {mass: 400, inertia: [1, 1, 1], angular_velocity: [0.001, 0, 0]}}\n";
  const std::string dipole = "  magnetic_dipole: {field: [0, 0, 1], dipole: [0, 0, 400]}\n";
  const std::string float_ =
      "  buoyancy: {fluid_density: 1, volume: 400, center: [0, 0, 1], acceleration: [0, 0, -1]}\n";
  EXPECT_NO_THROW(Simulator(sceneFrom("effects:\n" + dipole + "bodies: " + body)));
  EXPECT_NO_THROW(Simulator(sceneFrom("effects:\n" + float_ + "bodies: " + body)));
  const std::string why =
      refusal([&] { Simulator(sceneFrom("effects:\n" + dipole + float_ + "bodies: " + body)); });
  EXPECT_TRUE(contains(why, {"body 'a': 'magnetic_dipole' and 'buoyancy' together are too stiff",
                             "may swing at 28.2843 rad/s"}));
  const std::string brakes = refusal([] {
    Simulator(
        sceneFrom("integrator: rk4\neffects:\n  damping: {linear: 100}\n"
                  "  spring: [{body: a, anchor: [0, 0, 0], stiffness: 1, "
                  "damping: 100}]\nbodies: {a: {point_mass: 1, position: [1, "
                  "0, 0]}}\n"));
  });
  EXPECT_TRUE(contains(
      brakes, {"'damping' and 'spring' and 'spring_damping' together", "slows down at 200 1/s"}));
}

TEST(EffectPairs, OnDifferentBodiesAreNotAddedUp) {
  EXPECT_NO_THROW(Simulator(
      sceneFrom("effects:\n"
                "  magnetic_dipole: {field: [0, 0, 1]}\n"
                "  buoyancy: {fluid_density: 1, center: [0, 0, 1], acceleration: [0, 0, -1]}\n"
                "bodies:\n"
                "  a: {mass: 1, inertia: [1, 1, 1], magnetic_dipole: {dipole: [0, 0, 400]}}\n"
                "  b: {mass: 400, inertia: [1, 1, 1], buoyancy: {volume: 400}}\n")));
}

TEST(Effects, ThatAreNotFiniteAtTheStartAreRefusedByNameAndBody) {
  for (const auto& [effect, body] : std::vector<std::pair<std::string, std::string>>{
           {"buoyancy: {fluid_density: 1.0e+200, volume: 1.0e+200, acceleration: [0, 0, -9.8]}",
            ""},
           {"magnetic_dipole: {field: [1.0e+200, 0, 0], dipole: [0, 1.0e+200, 0]}", ""},
           {"rotating_frame: {angular_velocity: [0, 0, 1.0e+200]}", ""}}) {
    const std::string why = refusal([&] {
      Simulator(sceneFrom("{effects: {" + effect +
                          "}, bodies: {ball: {mass: 1, inertia: [1, 2, 2.5]}}}"));
    });
    EXPECT_TRUE(
        contains(why, {"body 'ball': '" + effect.substr(0, effect.find(':')) + "'", "not finite"}));
  }
}

TEST(Effects, OnABodyDoNotDependOnItsNeighboursToTheBit) {
  const std::string own =
      "  a: {mass: 1.7, inertia: [1, 2, 2.5], linear_velocity: [3, -4, 20], angular_velocity: [1, "
      "2, "
      "3], drag: {drag_area: 0.013}, added_mass: false}\n";
  const std::string effects =
      "effects: {gravity: {acceleration: [0.1, 0.2, -9.8]}, drag: {air_density: 1.2, wind: [1, 2, "
      "3]}, added_mass: {linear: [2, 2, 2]}}\nbodies:\n";
  for (const std::string integrator : {"exact", "rk4"}) {
    Scene alone = sceneFrom(effects + own);
    Scene beside =
        sceneFrom(effects + own + "  b: {mass: 0.7, inertia: [1, 1, 1], drag: {drag_area: 0.3}}\n");
    alone.integrator = beside.integrator = integrator;
    Simulator one(alone), two(beside);
    for (int i = 0; i < 300; ++i) {
      one.step();
      two.step();
    }
    EXPECT_EQ(one.state(0).p_WBcm, two.state(0).p_WBcm) << integrator;
    EXPECT_EQ(one.state(0).P_WB, two.state(0).P_WB) << integrator;
    EXPECT_EQ(one.state(0).L_WBcm_W, two.state(0).L_WBcm_W) << integrator;
  }
}

}  // namespace
}  // namespace rigid_body_sim

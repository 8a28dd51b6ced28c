// What springs are taken to be too stiff for: their bodies' frequencies, and friction beside them.
#include <cmath>
#include <sstream>

#include "generic.hpp"

namespace rigid_body_sim {
namespace {

TEST(Spring, OnARodsAxisSwingsItAcrossAndNotAboutItself) {
  // 0.628 kg, 1 m long: k (1/m + d^2/I) across, with the arm d = 0.5 m along the axis. The moment
  // about the axis, 1700 times smaller, does not count.
  const double mass = 0.628, across = 0.0524, d = 0.5, k = 2000;
  const std::string what = refusal([] {
    Simulator{sceneFrom(
        "{step_s: 0.1, effects: {spring: [{body: rod, point: [0, 0, 0.5], anchor: [0, 0, 0.5], "
        "stiffness: 2000, rest_length: 1.0e-3}]}, bodies: {rod: {mass: 0.628, inertia: [0.0524, "
        "0.0524, 3.0e-5], position: [0, 0, 1.0e-3]}}}")};
  });
  std::ostringstream swings;
  swings << "may swing at " << std::sqrt(k * (1 / mass + d * d / across)) << " rad/s";
  EXPECT_TRUE(contains(what, {"body 'rod': 'spring'", swings.str()}));
}

TEST(Spring, ThatPullsABodyHungByItTurnsItAsAPendulum) {
  // A soft spring that pulls with 1000 N at 0.5 m from the centre: f d / I = 2500 1/s^2 beside
  // k (1/m + d^2/I), with I = 0.2.
  const std::string what = refusal([] {
    Simulator{sceneFrom(
        "{step_s: 0.1, effects: {spring: [{body: b, point: [0, 0, 0.5], anchor: [0, 0, 1000.5], "
        "stiffness: 1}]}, bodies: {b: {mass: 1, inertia: [0.2, 0.2, 0.2]}}}")};
  });
  std::ostringstream swings;
  swings << "may swing at " << std::sqrt(1000 * 0.5 / 0.2 + 1 + 0.25 / 0.2) << " rad/s";
  EXPECT_TRUE(contains(what, {"body 'b': 'spring'", swings.str()}));
}

TEST(Spring, DashpotSlowsDownBothItsEnds) {
  // c (1/m + 1/M), whichever of them is the lighter one.
  for (const std::string ends : {"body: a, to: b", "body: b, to: a"}) {
    const std::string what = refusal([&] {
      Simulator{sceneFrom("{integrator: rk4, effects: {spring: [{" + ends +
                          ", stiffness: 0, damping: 10}]}, bodies: {a: {point_mass: 1}, b: "
                          "{point_mass: 0.01, position: [1, 0, 0]}}}")};
    });
    EXPECT_TRUE(contains(what, {"'spring_damping'", "slows down at 1010 1/s"}));
  }
}

TEST(Spring, BesideFrictionIsRefusedBeforeAMethodOnVelocitiesBecomesInfinite) {
  // These kick between the halves of the friction: (w h)^2 < 2 (1 + exp(-x)), so 1.41 at any x.
  const auto text = [](const std::string& integrator, double swing, double decay) {
    std::ostringstream text;  // w h = swing, x = decay, of 1 kg and 0.02 s
    text << "{integrator: " << integrator << ", effects: {spring: [{body: a, anchor: [0, 0, 0], "
         << "stiffness: " << std::pow(swing / 0.02, 2) << "}], damping: {linear: " << decay / 0.02
         << "}}, bodies: {a: {point_mass: 1, position: [1, 0, 0]}}}";
    return text.str();
  };
  for (const std::string integrator : {"semi_implicit_velocity", "semi_implicit_newton"}) {
    EXPECT_TRUE(contains(refusal([&] { Simulator{sceneFrom(text(integrator, 1.8, 2))}; }),
                         {"body 'a': 'spring'", "may swing at 90 rad/s"}));
    for (const double decay : {0.1, 2.0, 20.0}) {
      Simulator simulator(sceneFrom(text(integrator, 1.4, decay)));
      simulator.advance(20'000);
      EXPECT_LE(simulator.state(0).p_WBcm.norm(), 10) << integrator << " " << decay;
      EXPECT_TRUE(simulator.frozenBodies().empty());
    }
  }
  Simulator simulator(sceneFrom(text("exact", 1.8, 2)));  // which kicks around them bears it
  simulator.advance(20'000);
  EXPECT_LE(simulator.state(0).p_WBcm.norm(), 1);
}

TEST(Spring, BesideFrictionIsRefusedWhereRungeKuttaBearsEachButNotBoth) {
  // At 0.95 and 0.85 of the limits a step makes the motion grow.
  const std::string why = refusal([] {
    Simulator{sceneFrom(
        "{integrator: rk4, effects: {spring: [{body: a, anchor: [0, 0, 0], stiffness: 17942}], "
        "damping: {linear: 118}}, bodies: {a: {point_mass: 1, position: [1, 0, 0]}}}")};
  });
  EXPECT_TRUE(contains(why, {"'spring'", "'damping'", "together are too stiff"}));
}

}  // namespace
}  // namespace rigid_body_sim

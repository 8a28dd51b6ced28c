// The books of energy: kinetic + potential - work of inputs - work of effects that are not
// conservative stays what it was at the start, to the order of the integrator.
#include <cmath>

#include "core/suitability.hpp"
#include "effect_blocks.hpp"
#include "generic.hpp"

namespace rigid_body_sim {
namespace {

/// Two bodies under some of the effects: about half of `allowed`.
Scene sceneOf(Sampler& sample, const std::vector<std::string>& allowed) {
  auto blocks = blocksOf(sample);
  std::string effects;
  bool has_added_mass = false;
  for (const std::string& name : allowed) {
    if (sample.number() < 0) continue;
    if (name == "added_mass") has_added_mass = true;
    if (name == "rotating_frame" && has_added_mass) continue;  // they do not go together
    effects += "  " + name + ": " + blocks.at(name) + "\n";
  }
  if (has_added_mass) eraseWhatAddedMassRefuses(effects);
  std::string bodies;
  for (const std::string name : {"a", "b"})
    bodies += "  " + name + ": {mass: " + std::to_string(sample.between(1, 3)) +
              ", inertia: [1.6, -0.3, 0.2, 2.1, 0.4, 1.8], com: " + listOf(0.2 * sample.vector()) +
              ", position: " + listOf(2 * sample.vector()) +
              ", linear_velocity: " + listOf(sample.vector()) +
              ", angular_velocity: " + listOf(2 * sample.vector()) + "}\n";
  SCOPED_TRACE(effects);
  return sceneFrom((effects.empty() ? "" : "effects:\n" + effects) + "bodies:\n" + bodies +
                   "energy_audit: true\n");
}

/// The largest error of the balance in 4 s, a push and an impulse among it.
double worstImbalance(Scene scene, const std::string& integrator, double step_s) {
  scene.integrator = integrator;
  scene.step_ns = std::llround(step_s * 1e9);
  Simulator simulator(scene);
  const auto ticks = static_cast<Tick>(std::lround(4 / step_s));
  WrenchInput push;
  push.applied = {Axes::kBody, {{0.5, -0.3, 0.2}, {0.1, 0.2, -0.3}}, {0.1, 0.2, 0.3}};
  push.start = ticks / 4;
  push.ticks = ticks / 2;
  simulator.apply(push);
  ImpulseInput kick;
  kick.body = 1;
  kick.applied = {Axes::kWorld, {{0.3, 0.2, -0.4}, {0.1, -0.2, 0.1}}, {0, 0.1, 0}};
  kick.start = ticks / 2;
  simulator.apply(kick);
  double worst = 0;
  for (Tick i = 0; i < ticks; ++i) {
    simulator.step();
    worst = std::max(worst, std::abs(simulator.energy().unaccounted_J()));
  }
  EXPECT_TRUE(simulator.frozenBodies().empty());
  EXPECT_NE(simulator.energy().inputs_J, 0);
  return worst;
}

/// Slope of the imbalance of many scenes together, from step_s to half of it.
double measuredOrder(const std::string& integrator, const std::vector<std::string>& allowed,
                     int order, double step_s) {
  double whole = 0, half = 0;
  Sampler sample(4711);
  for (int i = 0; i < 16; ++i) {
    const Scene scene = sceneOf(sample, allowed);
    int of_scene = integratorNamed(integrator).order;
    for (const auto& effect : scene.effects)
      of_scene = std::min(of_scene, orderUnder(integratorNamed(integrator), *effect));
    if (of_scene != order) continue;
    whole += worstImbalance(scene, integrator, step_s);
    half += worstImbalance(scene, integrator, step_s / 2);
  }
  EXPECT_GT(half, 1e-11) << integrator << ": what is compared is rounding";
  return std::log2(whole / half);
}

const std::vector<std::string> kAll = {"added_mass", "gravity",         "damping",
                                       "drag",       "central_gravity", "magnetic_dipole",
                                       "buoyancy",   "spring",          "rotating_frame"};
const std::vector<std::string> kConservative = {"gravity", "central_gravity", "magnetic_dipole",
                                                "buoyancy"};

struct Law {
  std::string integrator;
  int order;
  double step_s;
  std::vector<std::string> effects;
};

TEST(EnergyAudit, ClosesToTheOrderOfTheIntegratorUnderAnyEffects) {
  for (const Law& law :
       {Law{"semi_implicit", 1, 0.01, kAll}, Law{"explicit_euler", 1, 0.01, kConservative},
        Law{"split2", 2, 0.02, kAll}, Law{"exact", 2, 0.02, kAll}, Law{"rk4", 4, 0.04, kAll},
        Law{"rk8", 8, 0.05, kAll}, Law{"exact4", 4, 0.08, kConservative},
        Law{"exact6", 6, 0.08, kConservative}}) {
    const double order = measuredOrder(law.integrator, law.effects, law.order, law.step_s);
    RecordProperty(law.integrator, std::to_string(order));
    EXPECT_NEAR(order, law.order, 0.1 * law.order + 0.1) << law.integrator;
  }
}

TEST(EnergyAudit, CountsWorkOnlyWhereTheSceneAsksForIt) {
  const std::string text =
      "effects: {gravity: {acceleration: [0, 0, -9.8]}, damping: {linear: 0.5}}\n"
      "bodies: {b: {sphere: {radius: 0.1, density: 500}, linear_velocity: [1, 2, 3]}}\n";
  Simulator without(sceneFrom(text)), with(sceneFrom(text + "energy_audit: true\n"));
  for (int i = 0; i < 50; ++i) {
    without.step();
    with.step();
  }
  EXPECT_EQ(without.energy().effects_J, 0);
  EXPECT_LT(with.energy().effects_J, 0);
  EXPECT_EQ(without.energy().kinetic_J, with.energy().kinetic_J) << "an audit changes nothing";
}

TEST(EnergyAudit, OfDampingAloneIsTheKineticEnergyThatIsGone) {
  Scene scene = sceneFrom(
      "effects: {damping: {linear: 0.5, angular: 2}}\n"
      "bodies: {b: {mass: 2, inertia: [1, 2, 2.5], linear_velocity: [1, 2, 3],"
      " angular_velocity: [1, -2, 1]}}\nenergy_audit: true\n");
  Simulator simulator(scene);
  const double start = simulator.energy().kinetic_J;
  for (int i = 0; i < 100; ++i) simulator.step();
  const EnergyBalance energy = simulator.energy();
  EXPECT_NEAR(energy.effects_J, energy.kinetic_J - start, 100 * kEps * start);  // a rounding a tick
}

}  // namespace
}  // namespace rigid_body_sim

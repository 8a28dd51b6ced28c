// Dashpots beside springs, and beside each other, where a step stops their ends.
#include <algorithm>

#include "flown_scenes.hpp"

namespace rigid_body_sim {
namespace {

/// The largest energy of 3000 ticks, in those of the start, of two bodies in a chain from a point
/// of the world.
double worstOfChain(double damping) {
  const std::string c = ", damping: " + std::to_string(damping) + ", rest_length: 1}";
  Simulator simulator(
      sceneFrom("effects:\n"
                "  spring: [{body: a, anchor: [0.5, 0.5, 0.5], stiffness: 0" +
                c + ", {body: a, to: b, stiffness: 200" + c +
                "]\n"
                "bodies:\n"
                "  a: {mass: 1.3, inertia: [1.6, 2.1, 1.8], linear_velocity: [0.2, 0.1, 0]}\n"
                "  b: {mass: 2.1, inertia: [1.2, 1.9, 2.3], position: [1.5, 1, -0.5],\n"
                "      linear_velocity: [0.1, -0.3, 0.2]}\n"));
  const double start = totalEnergy(simulator);
  double worst = 0;
  for (int i = 0; i < 3000; ++i) {
    simulator.step();
    worst = std::max(worst, totalEnergy(simulator) / start);
  }
  EXPECT_LT(totalEnergy(simulator), 0.5 * start) << damping;
  return worst;
}

TEST(SpringDamping, OfAChainMakesNoEnergyFromItsSprings) {
  // Measured: 1.03 at most; 1e6 and more, growing, if each dashpot only stops its ends, by itself.
  for (const double damping : {50.0, 200.0, 500.0, 5000.0, 1e6})
    EXPECT_LT(worstOfChain(damping), 1.1) << damping;
}

TEST(SpringDamping, KeepsTheDistanceOfBodiesThatCircle) {
  // At 1e9 N s/m nothing moves along the line; 0.2 rad a step across it.
  Simulator simulator(sceneFrom(
      "step_s: 0.1\n"
      "effects: {spring: [{body: a, to: b, stiffness: 10, damping: 1.0e+9, rest_length: 1}]}\n"
      "bodies:\n"
      "  a: {point_mass: 1, position: [0.5, 0, 0], linear_velocity: [0, 1, 0]}\n"
      "  b: {point_mass: 1, position: [-0.5, 0, 0], linear_velocity: [0, -1, 0]}\n"));
  for (int i = 0; i < 2000; ++i) simulator.step();
  const Vector3d d = simulator.state(0).p_WBcm - simulator.state(1).p_WBcm;
  EXPECT_NEAR(d.norm(), 1, 1e-9);
}

}  // namespace
}  // namespace rigid_body_sim

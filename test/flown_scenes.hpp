#pragma once

// Scenes with bodies of no special shape, flown by any integrator, and what effects are held to.
#include <cmath>
#include <regex>

#include "generic.hpp"
#include "rigid_body_sim/conserved.hpp"

namespace rigid_body_sim {

/// A body of no special shape or motion, as scene files say it, with `more` in its block.
inline std::string genericBodyNamed(const std::string& name, const std::string& more = "") {
  return name +
         ": {mass: 2.7, inertia: [1.6, -0.3, 0.2, 2.1, 0.4, 1.8], com: [0.11, -0.23, 0.37], "
         "position: [1.7, -0.9, 2.3], orientation: [-0.6, 0.48, 0.0, 0.64], "
         "linear_velocity: [0.4, -1.1, 0.6], angular_velocity: [1.3, 0.7, -0.9]" +
         more + "}";
}

/// Another one, elsewhere.
inline std::string otherBodyNamed(const std::string& name, const std::string& more = "") {
  return name +
         ": {mass: 1.4, inertia: [0.5, 0.1, -0.05, 0.7, 0.02, 0.6], com: [-0.05, 0.1, 0.02], "
         "position: [-0.4, 1.2, 0.3], orientation: [0.36, 0.48, -0.8, 0.0], "
         "linear_velocity: [-0.3, 0.2, 0.8], angular_velocity: [-0.6, 1.7, 0.4]" +
         more + "}";
}

/// 2^17 5^6 ns: may be divided into up to 2^17 steps of whole nanoseconds.
constexpr double kTime = 2.048;

/// The scene after `time_s` in `steps` steps, of whole nanoseconds.
inline Simulator flown(Scene scene, const std::string& integrator, double time_s, int steps) {
  scene.integrator = integrator;
  const auto time_ns = static_cast<std::int64_t>(std::llround(time_s * 1e9));
  if (time_ns % steps != 0) throw std::logic_error("no whole number of nanoseconds");
  scene.step_ns = time_ns / steps;
  Simulator simulator(scene);
  for (int i = 0; i < steps; ++i) simulator.step();
  return simulator;
}

/// The largest difference of all state, each part in its own unit.
inline double distance(const Bodies& a, const Bodies& b) {
  double worst = 0;
  for (Eigen::Index i = 0; i < a.count(); ++i) {
    const BodyState one = a.state(i), other = b.state(i);
    worst =
        std::max({worst, angleBetween(one.q_WB, other.q_WB), difference(one.p_WBcm, other.p_WBcm),
                  difference(one.P_WB, other.P_WB), difference(one.L_WBcm_W, other.L_WBcm_W)});
  }
  return worst;
}

/// Order as a slope: `error` of a number of steps, which is doubled from `steps` on while the error
/// is above `least`; the slope between the last two.
template <class Error>
double slopeOf(const Error& error, int steps, double least) {
  double before = 0, now = error(steps);
  do {
    before = now;
    steps *= 2;
    now = error(steps);
  } while (now > least && steps < 1 << 14);
  return std::log2(before / now);
}

/// The wrench on resting bodies is the negative gradient of the potential energy: differences of
/// fourth order over 1e-3 m and rad. They leave 1e-12/30 of the fifth derivative and kEps/1e-3 of
/// the energy itself; `tolerance` is absolute.
inline void expectPotentialGivesWrench(const Effect& effect, Bodies bodies, double tolerance) {
  bodies.P_WB.setZero();
  bodies.L_WBcm_W.setZero();
  const auto potential = [&](Eigen::Index i, const Vector3d& dp, const Vector3d& turn) {
    Bodies moved = bodies;
    BodyState state = moved.state(i);
    state.p_WBcm += dp;
    state.q_WB = rotationExp(turn) * state.q_WB;
    moved.setState(i, state);
    return effect.potentialEnergy(Instant(moved, 0));
  };
  const auto slope = [](const auto& V) {
    const double h = 1e-3;
    return (8 * (V(h) - V(-h)) - (V(2 * h) - V(-2 * h))) / (12 * h);
  };
  Wrenches wrenches;
  wrenches.setZero(bodies.count());
  effect.addWrenches(Instant(bodies, 0), wrenches);
  const Vector3d none = Vector3d::Zero();
  for (Eigen::Index i = 0; i < bodies.count(); ++i) {
    for (int k = 0; k < 3; ++k) {
      const Vector3d e = Vector3d::Unit(k);
      EXPECT_NEAR(wrenches.f_W(i, k), -slope([&](double h) { return potential(i, h * e, none); }),
                  tolerance);
      EXPECT_NEAR(wrenches.t_Bcm_W(i, k),
                  -slope([&](double h) { return potential(i, none, h * e); }), tolerance);
    }
  }
}

/// Momentum of all bodies, and their angular momentum about the world's origin.
inline std::pair<Vector3d, Vector3d> totalMomenta(const Bodies& bodies) {
  Vector3d P = Vector3d::Zero(), L = Vector3d::Zero();
  for (Eigen::Index i = 0; i < bodies.count(); ++i) {
    P += bodies.P_WB.row(i);
    L += angularMomentumAboutPoint(bodies.state(i), Vector3d::Zero());
  }
  return {P, L};
}

inline double totalEnergy(const Simulator& simulator) {
  return simulator.energy().kinetic_J + simulator.energy().potential_J;
}

}  // namespace rigid_body_sim

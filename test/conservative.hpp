#pragma once

// What all conservative effects have to keep: their wrenches are the gradient of their potential,
// a choice of bodies feels what it feels in the whole, and the energy audit closes.

#include <boost/math/special_functions/ellint_1.hpp>
#include <iomanip>
#include <memory>
#include <sstream>

#include "generic.hpp"
#include "rigid_body_sim/active_effects.hpp"

namespace rigid_body_sim {

/// A vector as YAML, to the last bit.
inline std::string yamlOf(const Vector3d& v) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(20) << "[" << v(0) << ", " << v(1) << ", " << v(2) << "]";
  return text.str();
}
inline std::string yamlOf(const Quaterniond& q) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(20) << "[" << q.x() << ", " << q.y() << ", " << q.z()
       << ", " << q.w() << "]";
  return text.str();
}

/// A body of no special shape, of the given further keys, away from the origin and tumbling.
inline std::string genericBodyYaml(const std::string& more = "") {
  return "{mass: 2.7, com: [0.11, -0.23, 0.37], inertia: [1.6, -0.3, 0.2, 2.1, 0.4, 1.8], "
         "position: [1.7, -0.9, 2.3], linear_velocity: [0.4, -1.1, 0.6], "
         "angular_velocity: [1.3, 0.7, -0.9], orientation: " +
         yamlOf(genericAttitude()) + (more.empty() ? "" : ", " + more) + "}";
}

/// Six tensor elements.
inline std::string yamlOf(const Matrix3d& I) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(20) << "[" << I(0, 0) << ", " << I(0, 1) << ", "
       << I(0, 2) << ", " << I(1, 1) << ", " << I(1, 2) << ", " << I(2, 2) << "]";
  return text.str();
}

inline Wrenches wrenchesOf(const Effect& effect, const Bodies& bodies) {
  Wrenches wrenches;
  wrenches.setZero(bodies.count());
  effect.addWrenches(Instant(bodies, 0), wrenches);
  return wrenches;
}

/// The derivative at 0 by central differences of sixth order.
template <class F>
double derivative(const F& f, double d) {
  return (45 * (f(d) - f(-d)) - 9 * (f(2 * d) - f(-2 * d)) + (f(3 * d) - f(-3 * d))) / (60 * d);
}

/// Force and torque are what moving and turning a body costs. A difference quotient has an error of
/// rounding, some 2 kEps V/d, and one of truncation, (d/r)^6 of the derivative where the field
/// changes over the length r; with d = 0.01 and r = 2.7 both are some 1e-13.
inline void expectWrenchesAreTheGradient(const Effect& effect, const Bodies& bodies) {
  const Wrenches wrenches = wrenchesOf(effect, bodies);
  const double V = std::abs(effect.potentialEnergy(Instant(bodies, 0)));
  const double d = 0.01;
  for (Eigen::Index i = 0; i < bodies.count(); ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      const Vector3d e = Vector3d::Unit(axis);
      const auto moved = [&](double by) {
        Bodies there = bodies;
        there.p_WBcm.row(i) += by * e.transpose();
        return effect.potentialEnergy(Instant(there, 0));
      };
      const auto turned = [&](double by) {
        Bodies there = bodies;
        const Quaterniond q(Eigen::Vector4d(bodies.q_WB.row(i)));
        there.q_WB.row(i) = (Quaterniond(Eigen::AngleAxisd(by, e)) * q).coeffs().transpose();
        return effect.potentialEnergy(Instant(there, 0));
      };
      const double f = wrenches.f_W.row(i).norm(), t = wrenches.t_Bcm_W.row(i).norm();
      EXPECT_NEAR(wrenches.f_W(i, axis), -derivative(moved, d), 4 * kEps * V / d + 1e-11 * f);
      EXPECT_NEAR(wrenches.t_Bcm_W(i, axis), -derivative(turned, d), 4 * kEps * V / d + 1e-11 * t);
    }
  }
}

/// Bodies 2 and 0 of three, in this order.
inline void expectRestrictedEqualsTheWhole(const Effect& effect, const Bodies& bodies) {
  const std::vector<Eigen::Index> some = {2, 0};
  const auto part = effect.restrictedTo(some);
  ASSERT_TRUE(part);
  Bodies own(2);
  for (const int k : {0, 1}) {
    own.mass(k) = bodies.mass(some[k]);
    own.I_BBcm_B.row(k) = bodies.I_BBcm_B.row(some[k]);
    own.setState(k, bodies.state(some[k]));
  }
  const Wrenches all = wrenchesOf(effect, bodies), restricted = wrenchesOf(*part, own);
  for (const int k : {0, 1}) {
    EXPECT_TRUE(sameBits(Vector3d(restricted.f_W.row(k)), Vector3d(all.f_W.row(some[k]))));
    EXPECT_TRUE(sameBits(Vector3d(restricted.t_Bcm_W.row(k)), Vector3d(all.t_Bcm_W.row(some[k]))));
  }
}

/// Energy that nobody has given or taken after a flight of 2 s [J].
inline double unaccountedEnergy(Scene scene, const std::string& integrator, int steps) {
  scene.energy_audit = true;
  scene.integrator = integrator;
  scene.step_ns = 2'000'000'000 / steps;
  Simulator simulator(scene);
  for (int i = 0; i < steps; ++i) simulator.step();
  return simulator.energy().unaccounted_J();
}

/// The audit closes: at the order of the method, and to rounding where that is high.
inline void expectEnergyAuditCloses(const Scene& scene) {
  const double coarse = std::abs(unaccountedEnergy(scene, "exact", 200));
  const double fine = std::abs(unaccountedEnergy(scene, "exact", 400));
  EXPECT_NEAR(std::log2(coarse / fine), 2, 0.05) << coarse << " J, " << fine << " J";
  Simulator start(scene);
  const double scale = start.energy().kinetic_J + std::abs(start.energy().potential_J);
  // Rounding: 400 steps of a few kEps each.
  EXPECT_LE(std::abs(unaccountedEnergy(scene, "rk8", 400)), 400 * 4 * kEps * scale);
}

/// Body 0, which starts at rest and is turned by `angle` from where it is drawn to with the small
/// rate `omega`, swings like a pendulum, of any amplitude: the period is 4 K(sin(angle/2)) / omega
/// (Landau and Lifshitz, Mechanics, 1976, section 11). After half of it it is at rest on the other
/// side, after all of it where it was.
/// @param axis_W of the turn, unit
inline void expectPendulum(const Scene& scene, const Vector3d& axis_W, double angle, double omega) {
  const double period = 4 * boost::math::ellint_1(std::sin(angle / 2)) / omega;
  const auto errorAfter = [&](const std::string& integrator, double time_s, int steps,
                              double turn) {
    Bodies bodies = Simulator(scene).bodies();
    const Quaterniond start = bodies.state(0).q_WB;
    ActiveEffects effects;
    for (const auto& effect : scene.effects) effects.add(effect.get());
    const auto method = integratorNamed(integrator).make({});
    for (int k = 0; k < steps; ++k)
      method->step(bodies, effects, k * time_s / steps, time_s / steps);
    const Quaterniond wanted = Quaterniond(Eigen::AngleAxisd(turn, axis_W)) * start;
    return angleBetween(bodies.state(0).q_WB, wanted);
  };
  // At a turning point an error of the period counts squared only: look where it is fastest, too.
  EXPECT_LE(errorAfter("rk8", period, 400, 0), 1e-12);
  EXPECT_LE(errorAfter("rk8", period / 2, 200, -2 * angle), 1e-12);
  EXPECT_LE(errorAfter("rk8", period / 4, 100, -angle), 1e-12);
  const double coarse = errorAfter("exact", period / 4, 100, -angle);
  EXPECT_NEAR(std::log2(coarse / errorAfter("exact", period / 4, 200, -angle)), 2, 0.02);
}

}  // namespace rigid_body_sim

#pragma once

// The rows of the gallery, by what makes them hard.

#include "reference/gallery.hpp"

namespace rigid_body_sim::reference {

std::vector<HardCase> tumblingCases();
std::vector<HardCase> extremeBodies();
std::vector<HardCase> extremeNumbers();
std::vector<HardCase> pushedCases();

/// Rungs that fail alike.
using Rungs = std::vector<std::string>;
inline const Rungs kVelocityRungs = {"explicit_euler_velocity", "semi_implicit_velocity",
                                     "semi_implicit_newton"};
inline const Rungs kFirstOrder = {"explicit_euler", "semi_implicit"};
inline const Rungs kRungeKutta = {"rk4", "rk8"};
inline const Rungs kBackInTime = {"exact4", "exact6"};

/// Both lists.
inline Rungs operator+(Rungs a, const Rungs& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

/// What rounding may leave of an attitude in free flight: half a last bit of the quaternion a step,
/// which is one of the angle, and what the last bits of the constants of the motion do to it. Each
/// of those (|L|, energy, the ratios of moments) is some five operations from the input: 16 ulps.
inline Bound attitudeToRounding() {
  return {Measure::kAttitude, 0, "an ulp a step, and 16 times what the last bit of the input does",
          0x1p-52, 16};
}

/// L is never touched in free flight.
inline Bound momentumToTheBit() {
  return {Measure::kAngularMomentum, 0, "nothing acts: not a bit may change"};
}

/// Some sixty operations from momentum and attitude to energy, and what the steps round.
inline Bound energyToRounding() {
  return {Measure::kEnergy, 64 * 0x1p-52, "64 ulps, and one a step", 0x1p-52};
}

/// A quaternion is brought back to length one each step: what is left is its own rounding.
inline Bound unitLength() {
  return {Measure::kLength, 4 * 0x1p-52, "four ulps, the rounding of a product of quaternions"};
}

/// What every free flight of the exact rotor keeps.
inline std::vector<Bound> toRounding() {
  return {attitudeToRounding(), momentumToTheBit(), energyToRounding(), unitLength()};
}

/// The velocity rungs and the first-order ones in free flight: |L| and energy, or the energy, go.
/// @param semi_implicit what semi_implicit_velocity ends as
inline std::vector<Excuse> eulerIsLost(Outcome semi_implicit) {
  return {{{"explicit_euler_velocity", "semi_implicit_newton"},
           Outcome::kWrong,
           "first order on velocities: keeps neither angular momentum nor energy"},
          {{"semi_implicit_velocity"},
           semi_implicit,
           "gains h^2 a.I a / 2 of energy a step, and the faster the more"},
          {kFirstOrder, Outcome::kWrong,
           "first order: lost within seconds; L is kept, and energy below |L|^2 / 2 I1"}};
}

/// The same, and those whose truncation a bound of rounding shows.
inline std::vector<Excuse> onlyExactHolds(Outcome semi_implicit, const Rungs& truncating) {
  std::vector<Excuse> excuses = eulerIsLost(semi_implicit);
  excuses.push_back({truncating, Outcome::kDrifts,
                     "of finite order: the phase runs away, L to the bit and energy nearly kept"});
  return excuses;
}
inline const Rungs kSecondAndFourth = {"split2", "rk4"};
inline const Rungs kFiniteOrder = {"split2", "rk4", "rk8", "adaptive"};

/// From L to w and back each step: rounding, always to the same side.
inline Excuse velocityRungsSlip() {
  return {kVelocityRungs, Outcome::kDrifts, "from L to w and back: two ulps of the rate a step"};
}

/// A body with a mass [kg], inertia [kg m^2], angular velocity [rad/s] and whatever else, in YAML;
/// turned to no special attitude.
inline std::string bodyYaml(const std::string& name, const std::string& mass,
                            const std::string& inertia, const std::string& rate,
                            const std::string& more = "orientation: [-0.51, 0.62, 0.41, 0.43]") {
  return name + ": {mass: " + mass + ", inertia: [" + inertia + "], angular_velocity: [" + rate +
         "], " + more + "}";
}

/// A scene of such bodies, separated by commas.
inline std::string sceneYaml(const std::string& bodies, const std::string& step_s = "0.02",
                             const std::string& effects = "") {
  return "{step_s: " + step_s + ", effects: {" + effects + "}, bodies: {" + bodies + "}}";
}

}  // namespace rigid_body_sim::reference

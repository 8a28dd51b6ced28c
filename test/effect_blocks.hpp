#pragma once

#include <map>
#include <sstream>

#include "generic.hpp"

namespace rigid_body_sim {

inline std::string listOf(const Vector3d& v) {
  std::ostringstream text;
  text << "[" << v.x() << ", " << v.y() << ", " << v.z() << "]";
  return text.str();
}

/// A block for each effect but the gyroscopic one, with numbers of the size of one.
inline std::map<std::string, std::string> blocksOf(Sampler& sample) {
  const auto positive = [&] { return std::to_string(sample.between(0.2, 1)); };
  std::map<std::string, std::string> blocks;
  blocks["gravity"] = "{acceleration: " + listOf(3 * sample.vector()) + "}";
  blocks["damping"] = "{linear: " + positive() + ", angular: " + positive() + "}";
  blocks["drag"] = "{air_density: 1.2, drag_area: " + positive() +
                   ", rotational_drag: " + positive() + ", wind: " + listOf(sample.vector()) + "}";
  blocks["central_gravity"] = "{mu: 20, center: " + listOf(Vector3d(0, 0, 9) + sample.vector()) +
                              ", j2: 0.1, equatorial_radius: 2, axis: " + listOf(sample.vector()) +
                              ", gravity_gradient: true}";
  blocks["magnetic_dipole"] =
      "{field: " + listOf(sample.vector()) + ", dipole: " + listOf(2 * sample.vector()) + "}";
  blocks["buoyancy"] = "{fluid_density: 2, volume: " + positive() +
                       ", center: " + listOf(0.3 * sample.vector()) +
                       ", acceleration: " + listOf(3 * sample.vector()) + "}";
  blocks["spring"] =
      "[{body: a, point: " + listOf(0.3 * sample.vector()) +
      ", anchor: " + listOf(sample.vector()) + ", stiffness: 8, damping: " + positive() +
      ", rest_length: 0.5}, {body: a, to: b, to_point: " + listOf(0.3 * sample.vector()) +
      ", stiffness: 6, rest_length: 1}]";
  blocks["rotating_frame"] = "{angular_velocity: " + listOf(0.3 * sample.vector()) + "}";
  blocks["added_mass"] = "{linear: [" + positive() + ", " + positive() + ", " + positive() +
                         "], angular: [0.1, 0.3, 0.2]}";
  return blocks;
}

/// Parameters in blocks of effects that do not go with added mass.
inline void eraseWhatAddedMassRefuses(std::string& effects) {
  const std::string gradient = ", gravity_gradient: true", wind = ", wind: [";
  if (const auto at = effects.find(gradient); at != std::string::npos)
    effects.erase(at, gradient.size());
  if (const auto at = effects.find(wind); at != std::string::npos)
    effects.erase(at, effects.find(']', at) + 1 - at);
}

}  // namespace rigid_body_sim

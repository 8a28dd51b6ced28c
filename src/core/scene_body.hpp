#pragma once

#include <string>

#include "rigid_body_sim/scene.hpp"

namespace rigid_body_sim {

/// Whether the block says what the body is: one of the keys that bodyFromNumbers() takes.
bool saysWhatItIs(const Parameters& block);

/// A body that a scene gives without URDF: exactly one of mass + inertia (+ com), box, sphere,
/// cylinder, particles, point_mass.
SceneBody bodyFromNumbers(const Parameters& block, const std::string& name);

/// Reads position, orientation, linear_velocity and angular_velocity, as far as they are there.
void readInitialMotion(const Parameters& block, SceneBody& body);

}  // namespace rigid_body_sim

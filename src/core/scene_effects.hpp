#pragma once

#include <vector>

#include "rigid_body_sim/scene.hpp"

namespace rigid_body_sim {

/// Reads `effects` and what the bodies' blocks say of them.
/// @param bodies block of each body, in the scene's order
void readEffects(const Parameters& parameters, const std::vector<Parameters>& bodies, Scene& scene);

}  // namespace rigid_body_sim

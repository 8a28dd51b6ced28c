#pragma once

#include <vector>

#include "rigid_body_sim/effect_row.hpp"

namespace rigid_body_sim {

/// All built-in effects, in the order in which they are summed. One that adds mass comes first, as
/// the others may ask for the frames of bodies.
const std::vector<EffectRow>& effectRegistry();

}  // namespace rigid_body_sim

#pragma once

#include <vector>

#include "rigid_body_sim/effect_row.hpp"

namespace rigid_body_sim {

/// All built-in effects, in the order in which they are summed. One that adds mass comes first, as
/// the others may ask for the frames of bodies; the one that turns the world comes last, so that
/// the flows of the others, which come before and after its own, see velocities relative to it.
const std::vector<EffectRow>& effectRegistry();

}  // namespace rigid_body_sim

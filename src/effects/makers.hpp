#pragma once

#include "rigid_body_sim/effect_row.hpp"

// The makers of all effects, for the registry; each has its own source file.
namespace rigid_body_sim {

EffectList makeAddedMass(EffectBlock& block);
EffectList makeDamping(EffectBlock& block);
EffectList makeGravity(EffectBlock& block);
EffectList makeRotatingFrame(EffectBlock& block);
EffectList makeSpring(EffectBlock& block);

}  // namespace rigid_body_sim

#pragma once

#include <string>

#include "rigid_body_sim/effect_row.hpp"

namespace rigid_body_sim {

/// File name of the library that may offer the effect of this name; empty if no effect of a plug-in
/// can have the name.
std::string effectPluginLibrary(const std::string& name);

/// The effect of this name from a plug-in, see rigid_body_sim/effect_plugin.hpp; null if there is
/// no library of it on the dynamic linker's path.
/// @throws std::invalid_argument if there is one that does not fit
const EffectRow* effectPlugin(const std::string& name);

}  // namespace rigid_body_sim

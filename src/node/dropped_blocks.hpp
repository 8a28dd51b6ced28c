#pragma once

#include "rigid_body_sim/parameters.hpp"

namespace rigid_body_sim {

/// The parameter server drops maps without entries, so that `gravity: {}` in a scene file would be
/// as if it were not there.
/// @param file the scene as its file says it
/// @param given the same as it came through the parameter server
/// @throws std::invalid_argument naming the path of a block that was dropped, and the file; not for
/// those at the top level that say the same by not being there
void refuseDroppedBlocks(const Value& file, const Value& given, const std::string& file_name);

}  // namespace rigid_body_sim

#pragma once

#include <string>
#include <vector>

#include "core/urdf_prescan.hpp"

namespace rigid_body_sim {

/// Refuses every URDF whose masses, inertias, poses or tree the URDF parser would read as something
/// else than is written: it turns a malformed <inertial> into zero mass, ignores repeated elements
/// and unknown attributes of <origin>, and drops links that hang in a loop.
/// Checked are the root, <link>s (name, <inertial>) and <joint>s (name, type, ends, <origin>) and
/// that they form one tree; visual and collision elements are not.
/// @throws std::invalid_argument with one line that names source, link or joint, and rule.
void checkUrdf(const std::vector<XmlElement>& xml, const std::string& source);

}  // namespace rigid_body_sim

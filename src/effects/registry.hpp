#pragma once

#include <memory>
#include <string>
#include <vector>

#include "rigid_body_sim/effect.hpp"
#include "rigid_body_sim/parameters.hpp"

namespace rigid_body_sim {

/// An effect that scenes can list below `effects`.
struct EffectRow {
  std::string name;
  /// Null if its parameters make it nothing: an effect that does nothing is not in the list.
  std::shared_ptr<const Effect> (*make)(const Parameters& block, std::vector<Eigen::Index> bodies);
};

const std::vector<EffectRow>& effectRegistry();

}  // namespace rigid_body_sim

#include "effects/registry.hpp"

#include "effects/makers.hpp"

namespace rigid_body_sim {

const std::vector<EffectRow>& effectRegistry() {
  static const std::vector<EffectRow> rows = {
      {"gravity", BlockLayout::kMap, makeGravity},
      {"damping", BlockLayout::kMap, makeDamping},
      {"drag", BlockLayout::kMap, makeDrag},
  };
  return rows;
}

}  // namespace rigid_body_sim

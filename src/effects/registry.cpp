#include "effects/registry.hpp"

#include "effects/makers.hpp"

namespace rigid_body_sim {

const std::vector<EffectRow>& effectRegistry() {
  static const std::vector<EffectRow> rows = {
      {"added_mass", BlockLayout::kMap, makeAddedMass},
      {"gravity", BlockLayout::kMap, makeGravity},
      {"damping", BlockLayout::kMap, makeDamping},
      {"spring", BlockLayout::kList, makeSpring},
      {"rotating_frame", BlockLayout::kMap, makeRotatingFrame},
  };
  return rows;
}

}  // namespace rigid_body_sim

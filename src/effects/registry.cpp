#include "effects/registry.hpp"

#include "effects/makers.hpp"

namespace rigid_body_sim {

const std::vector<EffectRow>& effectRegistry() {
  static const std::vector<EffectRow> rows = {
      {"gravity", BlockLayout::kMap, makeGravity},
      {"damping", BlockLayout::kMap, makeDamping},
      {"drag", BlockLayout::kMap, makeDrag},
      {"central_gravity", BlockLayout::kMap, makeCentralGravity},
      {"magnetic_dipole", BlockLayout::kMap, makeMagneticDipole},
      {"buoyancy", BlockLayout::kMap, makeBuoyancy},
  };
  return rows;
}

}  // namespace rigid_body_sim

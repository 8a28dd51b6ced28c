// In place of src/effects/registry.cpp: a program that has no other effect than gravity.
#include "effects/makers.hpp"
#include "effects/registry.hpp"

namespace rigid_body_sim {

const std::vector<EffectRow>& effectRegistry() {
  static const std::vector<EffectRow> rows = {{"gravity", BlockLayout::kMap, makeGravity}};
  return rows;
}

}  // namespace rigid_body_sim

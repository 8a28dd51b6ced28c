#include "effects/registry.hpp"

namespace rigid_body_sim {
namespace {

std::shared_ptr<const Effect> makeGravity(const Parameters& block,
                                          std::vector<Eigen::Index> bodies) {
  const Vector3d g_W = block.vector3("acceleration", finite("m/s^2"));
  if (g_W.isZero(0) || bodies.empty()) return nullptr;
  return uniformGravity(g_W, std::move(bodies));
}

}  // namespace

const std::vector<EffectRow>& effectRegistry() {
  static const std::vector<EffectRow> rows = {{"gravity", makeGravity}};
  return rows;
}

}  // namespace rigid_body_sim

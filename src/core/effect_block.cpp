#include <set>

#include "rigid_body_sim/effect_row.hpp"

namespace rigid_body_sim {

double EffectBlock::number(const Member& member, const std::string& key, const Allowed& allowed,
                           std::optional<double> fallback) const {
  const bool scene_has_it = scene.has(key);
  if (member.block.has(key)) return member.block.number(key, allowed);
  if (scene_has_it || fallback) return scene.number(key, allowed, fallback);
  return member.block.number(key, allowed);  // says that it is missing
}

Vector3d EffectBlock::vector3(const Member& member, const std::string& key, const Allowed& allowed,
                              std::optional<Vector3d> fallback) const {
  const bool scene_has_it = scene.has(key);
  if (member.block.has(key)) return member.block.vector3(key, allowed);
  if (scene_has_it || fallback) return scene.vector3(key, allowed, fallback);
  return member.block.vector3(key, allowed);
}

Eigen::Index EffectBlock::bodyNamed(const Parameters& block, const std::string& key) const {
  const std::string name = block.text(key);
  std::set<std::string> names;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    if (bodies[i].name == name) return static_cast<Eigen::Index>(i);
    names.insert(bodies[i].name);
  }
  std::string known;
  constexpr std::size_t kMostNamed = 10;
  for (const std::string& one : names)
    if (names.size() <= kMostNamed) known += (known.empty() ? "; there are " : ", ") + one;
  const std::string nearest = nearestWord(name, names);
  block.refuse(key, "there is no body '" + name + "'" + known +
                        (nearest.empty() ? "" : "; did you mean '" + nearest + "'?"));
}

}  // namespace rigid_body_sim

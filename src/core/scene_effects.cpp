#include "core/scene_effects.hpp"

#include <algorithm>
#include <numeric>
#include <set>
#include <stdexcept>

#include "core/effect_plugin.hpp"
#include "effects/registry.hpp"
#include "rigid_body_sim/simulator.hpp"

namespace rigid_body_sim {
namespace {

/// The bodies that an effect acts on: all but those whose block says `<effect>: false`. They may
/// say so of an effect that the scene does not have, but not ask for one.
std::vector<EffectBlock::Member> membersOf(const std::string& effect, bool scene_has_it,
                                           const std::vector<Parameters>& blocks,
                                           const Scene& scene) {
  std::vector<EffectBlock::Member> members;
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    const bool has_map = blocks[i].isMap(effect);
    if (!has_map && !blocks[i].boolean(effect, scene_has_it)) continue;
    if (!scene_has_it)
      blocks[i].refuse(
          effect,
          "the scene has no such effect; list it under `effects`, with a parameter in its "
          "block: the parameter server drops empty ones");
    members.push_back({static_cast<Eigen::Index>(i),
                       has_map ? blocks[i].child(effect)
                               : Parameters({}, "bodies." + scene.bodies[i].name + "." + effect)});
  }
  return members;
}

EffectBlock blockOf(const EffectRow& row, const Parameters& effects,
                    const std::vector<Parameters>& bodies, Scene& scene) {
  if (effects.isBoolean(row.name))
    effects.refuse(row.name,
                   "true and false are for a body's own block and for `gyroscopic`; here an "
                   "effect has its parameters, or is left out, or ended by "
                   "~switch_effect while the node runs");
  EffectBlock block{row.name, Parameters({}, ""), {}, {}, scene.bodies};
  if (row.layout == BlockLayout::kList) {
    if (effects.has(row.name)) block.entries = effects.children(row.name);
    return block;
  }
  block.members = membersOf(row.name, effects.has(row.name), bodies, scene);
  if (effects.has(row.name)) block.scene = effects.child(row.name);
  return block;
}

void refuseUnknown(const EffectBlock& block) {
  block.scene.refuseUnknown();
  for (const Parameters& entry : block.entries) entry.refuseUnknown();
  for (const auto& member : block.members) member.block.refuseUnknown();
}

/// Refuses a key that would be the name of a plug-in, if there were one.
[[noreturn]] void refuseWithoutPlugin(const Parameters& effects, const std::string& key) {
  std::set<std::string> names = {"gyroscopic"};
  for (const EffectRow& row : effectRegistry()) names.insert(row.name);
  const std::string nearest = nearestWord(key, names);
  effects.refuse(key, "unknown key; " +
                          (nearest.empty() ? "" : "did you mean '" + nearest + "'? Otherwise: ") +
                          "there is no built-in effect of this name, and no library " +
                          effectPluginLibrary(key) +
                          " on the dynamic linker's path (LD_LIBRARY_PATH)");
}

/// Of an effect that no body takes: its keys are read all the same, as if all took it, lest one
/// that is misspelt goes unseen.
void readInVain(const EffectRow& row, const EffectBlock& block, std::vector<SceneBody> bodies) {
  for (SceneBody& body : bodies) {
    body.is_point_mass = false;
    body.mass_properties = solidSphere(1, 1);
    body.X_WL.translation().setConstant(1e30);  // where it is in nothing's way
    body.added_mass_L = {};
  }
  EffectBlock vain{block.name, block.scene, {}, {}, bodies};
  for (std::size_t i = 0; i < bodies.size(); ++i)
    vain.members.push_back(
        {static_cast<Eigen::Index>(i), Parameters({}, "bodies." + bodies[i].name)});
  row.make(vain);
  vain.scene.refuseUnknown();
}

/// The built-in effects, and those of plug-ins that the scene names.
std::vector<EffectRow> rowsFor(const Parameters& effects) {
  std::vector<EffectRow> rows = effectRegistry();
  for (const std::string& key : effects.keys()) {
    const auto is_it = [&](const EffectRow& row) { return row.name == key; };
    if (key == "gyroscopic" || std::any_of(rows.begin(), rows.end(), is_it)) continue;
    if (effectPluginLibrary(key).empty()) continue;  // refused with all that are unknown
    if (key == AppliedWrenches().name())
      effects.refuse(key, "is what the wrenches from topics are called; no effect has that name");
    const EffectRow* row = nullptr;
    try {
      row = effectPlugin(key);
    } catch (const std::invalid_argument& error) {
      effects.refuse(key, error.what());
    }
    if (!row) refuseWithoutPlugin(effects, key);
    rows.insert(rows.end() - 1, *row);  // the registry's last row stays the last one
  }
  return rows;
}

void readGyroscopic(const Parameters& effects, const std::vector<Parameters>& bodies,
                    Scene& scene) {
  scene.gyroscopic = effects.boolean("gyroscopic", true) ? Gyroscopic::kOn : Gyroscopic::kOff;
  for (std::size_t i = 0; i < bodies.size(); ++i)
    if (bodies[i].has("gyroscopic"))
      scene.bodies[i].gyroscopic =
          bodies[i].boolean("gyroscopic") ? Gyroscopic::kOn : Gyroscopic::kOff;
}

bool isSpherical(const SceneBody& body) {
  if (body.is_point_mass) return true;
  const Vector3d I = bodyFrame(body).I_BBcm_B;
  return I(0) == I(2);
}

bool isGyroscopicOn(const SceneBody& body, const Scene& scene) {
  return body.gyroscopic.value_or(scene.gyroscopic) == Gyroscopic::kOn;
}

std::string countOf(std::size_t some, std::size_t all) {
  return std::to_string(some) + " of " + std::to_string(all);
}

}  // namespace

void readEffects(const Parameters& parameters, const std::vector<Parameters>& bodies,
                 Scene& scene) {
  const Parameters effects = parameters.child("effects");
  readGyroscopic(effects, bodies, scene);
  for (const EffectRow& row : rowsFor(effects)) {
    EffectBlock block = blockOf(row, effects, bodies, scene);
    if (!effects.has(row.name)) continue;
    const bool is_in_vain = row.layout == BlockLayout::kMap && block.members.empty();
    if (is_in_vain) {
      block.why_nothing = "it acts on no body";
      readInVain(row, block, scene.bodies);
    }
    const EffectList made = row.make(block);
    if (!is_in_vain) refuseUnknown(block);
    if (made.empty()) scene.elided.push_back(row.name + ": " + block.why_nothing);
    if (!made.empty())
      for (const std::string& one : block.idle) scene.elided.push_back(row.name + one);
    scene.effects.insert(scene.effects.end(), made.begin(), made.end());
  }
  effects.refuseUnknown();
}

std::vector<Eigen::Index> ungyroscopicBodies(const Scene& scene,
                                             const std::vector<Eigen::Index>& some) {
  std::vector<Eigen::Index> off;
  for (std::size_t k = 0; k < some.size(); ++k) {
    const SceneBody& body = scene.bodies[some[k]];
    if (!isGyroscopicOn(body, scene) && !isSpherical(body))
      off.push_back(static_cast<Eigen::Index>(k));
  }
  return off;
}

std::vector<Eigen::Index> ungyroscopicBodies(const Scene& scene) {
  std::vector<Eigen::Index> all(scene.bodies.size());
  std::iota(all.begin(), all.end(), Eigen::Index(0));
  return ungyroscopicBodies(scene, all);
}

std::vector<std::string> elisions(const Scene& scene) {
  std::vector<std::string> lines = scene.elided;
  std::size_t spheres = 0, points = 0;
  for (const SceneBody& body : scene.bodies) {
    if (body.is_point_mass)
      ++points;
    else if (isSpherical(body))
      ++spheres;
  }
  const std::size_t all = scene.bodies.size();
  if (spheres > 0) lines.push_back("gyroscopic for " + countOf(spheres, all) + ": spherical");
  if (points > 0) lines.push_back("rotation for " + countOf(points, all) + ": point masses");
  return lines;
}

}  // namespace rigid_body_sim

#pragma once

#include <optional>
#include <string>
#include <vector>

#include "rigid_body_sim/scene.hpp"

namespace rigid_body_sim {

/// What a scene file says of one effect: its block below `effects`, and what bodies say of it in
/// blocks of their own.
struct EffectBlock {
  /// A body that the effect may act on, and its own block; empty if it has none.
  struct Member {
    Eigen::Index body;
    Parameters block;
  };

  std::string name;
  Parameters scene;                 ///< `effects.<name>`; empty if that is a list
  std::vector<Parameters> entries;  ///< of `effects.<name>`, if that is a list
  std::vector<Member> members;      ///< all bodies but those that say `<name>: false`
  std::vector<SceneBody>& bodies;   ///< all of the scene; an effect may add mass to them
  std::string why_nothing = "all its parameters are zero";  ///< if it makes no effect
  std::vector<std::string> idle = {};  ///< what of it does nothing if it makes one: `[1]: why`

  /// A number for one body: its own, or else the scene's, or else the fallback.
  double number(const Member& member, const std::string& key, const Allowed& allowed,
                std::optional<double> fallback = std::nullopt) const;
  Vector3d vector3(const Member& member, const std::string& key, const Allowed& allowed,
                   std::optional<Vector3d> fallback = std::nullopt) const;

  /// The body's name in messages.
  const std::string& nameOf(const Member& member) const { return bodies[member.body].name; }
  BodyFrame frameOf(const Member& member) const { return bodyFrame(bodies[member.body]); }
  /// The index of the body with this name. @throws std::invalid_argument naming `key` of `block`.
  Eigen::Index bodyNamed(const Parameters& block, const std::string& key) const;
};

/// Whether an effect's block in a scene file is a map of keys or a list of maps.
enum class BlockLayout { kMap, kList };

/// An effect that scenes can list below `effects`.
struct EffectRow {
  std::string name;
  BlockLayout layout = BlockLayout::kMap;
  /// Empty if its parameters make it nothing: an effect that does nothing is not in the list.
  /// @throws std::invalid_argument with the path of the key, its value, what is allowed, unit
  EffectList (*make)(EffectBlock& block) = nullptr;
};

}  // namespace rigid_body_sim

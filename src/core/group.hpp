#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "rigid_body_sim/integrator.hpp"
#include "rigid_body_sim/method.hpp"
#include "rigid_body_sim/simulator.hpp"

namespace rigid_body_sim {

using EffectList = std::vector<std::shared_ptr<const Effect>>;

/// The effects on some of the bodies alone, without those that act on none of them; nothing if one
/// of them cannot be divided.
std::optional<EffectList> restrictedTo(const EffectList& effects,
                                       const std::vector<Eigen::Index>& bodies);

/// Whether an effect cannot be divided for some of the `count` bodies: then they are planned for,
/// and looked at, as a whole.
bool areCoupled(const EffectList& effects, Eigen::Index count);

/// The rows of `bodies` with these indices.
Bodies rowsOf(const Bodies& bodies, const std::vector<Eigen::Index>& indices);

/// The largest |w| [rad/s] of the bodies, and whose it is.
struct FastestBody {
  Eigen::Index body = 0;
  double rate = 0;
};
FastestBody fastestOf(const Bodies& bodies);

/// Why the method must not step bodies under these effects; empty if it may.
std::string objection(const Method& method, const EffectList& effects);

/// Why the method must not step bodies that turn at `rate` [rad/s], in ticks of `tick_s` [s].
std::string objection(const Method& method, double rate, double tick_s);

/// What a user of the method should know of it under these effects; empty if nothing.
std::string caution(const Method& method, const EffectList& effects);

/// Bodies that one method steps, under the effects and the held wrenches that act on them. Each
/// moves as it would alone, to the bit; but not with `adaptive`, whose steps are common to all of
/// them: there, to its tolerance.
class Group {
 public:
  /// @param effects on these bodies alone
  /// @param bodies which of all they are; empty: all, which are then stepped in place
  Group(const Method& method, Gyroscopic gyroscopic, EffectList effects,
        std::vector<Eigen::Index> bodies = {});

  /// Takes up the wrenches that are held now; `applied` stays where it is for as long as they are.
  void hold(const AppliedWrenches& applied);

  /// From `start_s` [s] for a tick of `tick_s` [s]; the state of other bodies is left alone.
  void step(Bodies& all, double start_s, double tick_s);

  const Method& method() const { return method_; }
  const std::vector<Eigen::Index>& bodies() const { return indices_; }

 private:
  void stepInPlace(Bodies& bodies, double start_s, double tick_s);
  void gather(const Bodies& all);
  void scatter(Bodies& all) const;

  Method method_;
  std::vector<Eigen::Index> indices_;
  EffectList effects_;
  std::unique_ptr<Integrator> integrator_;
  ActiveEffects active_;
  std::shared_ptr<const Effect> own_applied_;  // the wrenches held on these bodies; null: on none
  const Effect* applied_ = nullptr;            // what of them is active
  Bodies own_;                                 // these bodies; none if they are all
};

/// A group for each method of the scene.
/// @throws std::invalid_argument if an effect cannot be divided among them
std::vector<Group> groupsOf(const Scene& scene);

/// Cautions, one line each.
/// @throws std::invalid_argument naming body or effect, if a method of the scene must not step its
/// bodies, or a body has no method or several
std::vector<std::string> requireSuitableMethods(const Scene& scene, const Bodies& bodies);

}  // namespace rigid_body_sim

#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "rigid_body_sim/integrator.hpp"
#include "rigid_body_sim/method.hpp"
#include "rigid_body_sim/simulator.hpp"

namespace rigid_body_sim {

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

/// The order of the method under the effect; 0: it is refused.
int orderUnder(const IntegratorRow& row, const Effect& effect);

/// Why the method must not step bodies under these effects; empty if it may.
std::string objection(const Method& method, const EffectList& effects);

/// A body on which effects act as they must not.
struct Fault {
  Eigen::Index body;
  std::string why;  ///< names the effects, and the longest stable step if they are too stiff
};

/// Whether an effect's wrench, energy or stiffness is not finite at `now`.
std::optional<Fault> notFinite(const EffectList& effects, const Instant& now);

/// Whether ticks of `tick_s` [s] are too long for the method to be stable under these effects, each
/// by itself and all of a body's together; judged at `now`.
std::optional<Fault> tooStiff(const Method& method, const EffectList& effects, const Instant& now,
                              double tick_s);

/// Why the method must not step bodies that turn at `rate` [rad/s], in ticks of `tick_s` [s].
std::string objection(const Method& method, double rate, double tick_s);

/// What a user of the method should know of it under these effects; empty if nothing.
std::string caution(const Method& method, const EffectList& effects);

/// Bodies that one method steps, under the effects and the held wrenches that act on them. Each
/// moves as it would alone, to the bit; but not with `adaptive`, whose steps are common to all of
/// them: there, to its tolerance.
class Group {
 public:
  /// @param ungyroscopic those of these bodies that fly without the gyroscopic term
  /// @param effects on these bodies alone
  /// @param bodies which of all they are; empty: all, which are then stepped in place
  Group(const Method& method, std::vector<Eigen::Index> ungyroscopic, EffectList effects,
        std::vector<Eigen::Index> bodies = {});

  /// Takes up the wrenches that are held now; `applied` stays where it is for as long as they are.
  void hold(const AppliedWrenches& applied);

  /// From `start_s` [s] for a tick of `tick_s` [s]; the state of other bodies is left alone.
  void step(Bodies& all, double start_s, double tick_s);

  /// Somebody else has moved one of its bodies.
  void disturb() { motion_ = Motion::kUnknown; }

  /// What the effects have done since the group was made.
  std::vector<EffectCount> counts() const { return active_.counts(); }
  void beginAudit() { active_.beginAudit(); }

  const Method& method() const { return method_; }
  const std::vector<Eigen::Index>& bodies() const { return indices_; }

 private:
  enum class Motion { kUnknown, kAtRest, kMoves };

  bool isAtRest(const Bodies& all);
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
  Motion motion_ = Motion::kUnknown;           // of free bodies
};

/// A group for each method of the scene.
/// @throws std::invalid_argument if an effect cannot be divided among them
std::vector<Group> groupsOf(const Scene& scene);

/// Cautions, one line each.
/// @throws std::invalid_argument naming body or effect, if a method of the scene must not step its
/// bodies, or a body has no method or several
std::vector<std::string> requireSuitableMethods(const Scene& scene, const Bodies& bodies,
                                                double time_s = 0);

}  // namespace rigid_body_sim

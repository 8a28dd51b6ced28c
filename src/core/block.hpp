#pragma once

#include <memory>
#include <vector>

#include "core/suitability.hpp"
#include "rigid_body_sim/integrator.hpp"
#include "rigid_body_sim/method.hpp"
#include "rigid_body_sim/simulator.hpp"

namespace rigid_body_sim {

/// The states of some bodies before a step.
class Snapshot {
 public:
  void take(const Bodies& bodies);

  /// Puts body i back.
  void restore(Eigen::Index i, Bodies& bodies) const;

 private:
  std::vector<double> numbers_;  // column by column
};

/// Bodies that one method steps together: their state, and what acts on them. Few enough to stay in
/// the nearest caches from tick to tick. Each moves as it would alone under the same effects, to
/// the bit; but not with `adaptive`, whose steps are common to all of them: there, to its
/// tolerance.
class Block {
 public:
  /// @param ungyroscopic those of these bodies that fly without the gyroscopic term
  /// @param effects on these bodies alone
  Block(const Method& method, std::vector<Eigen::Index> ungyroscopic, EffectList effects,
        Bodies bodies);

  const Bodies& bodies() const { return bodies_; }
  const Method& method() const { return method_; }

  /// Moves body i.
  void setState(Eigen::Index i, const BodyState& state);

  /// Takes up the wrenches that are held on its bodies now; null: there are none.
  void hold(std::shared_ptr<const Effect> applied);

  /// From `start_s` [s] for a tick of `tick_s` [s].
  void step(double start_s, double tick_s);

  /// From tick `first` on, tick by tick. A body whose state is not finite then goes back to the
  /// beginning of the tick, and stays there. @param before memory to work in
  void advance(Tick first, Tick ticks, double tick_s, Snapshot& before);

  /// Body i stays where it is from now on.
  void freeze(FrozenBody frozen) { frozen_.push_back(frozen); }

  /// Its bodies that do, by their places here, in the order of the ticks.
  const std::vector<FrozenBody>& frozen() const { return frozen_; }

  /// Whether ticks of `tick_s` [s] are too long by now for one of the effects by itself, to be
  /// stable or to be right under friction.
  std::optional<Fault> tooStiff(double time_s, double tick_s) const;

  /// What the effects have done since the block was made.
  std::vector<EffectCount> counts() const { return active_.counts(); }
  void beginAudit() { active_.beginAudit(); }

 private:
  enum class Motion { kUnknown, kAtRest, kMoves };

  bool isAtRest();
  void freezeWhatIsNotFinite(Tick tick, const Snapshot& before);

  Method method_;
  EffectList effects_;
  Bodies bodies_;
  std::unique_ptr<Integrator> integrator_;
  ActiveEffects active_;
  std::shared_ptr<const Effect> applied_;  // the held wrenches; null: none
  std::vector<FrozenBody> frozen_;
  Motion motion_ = Motion::kUnknown;  // of free bodies
};

/// Some of a scene's bodies, in a block.
struct Placed {
  std::vector<Eigen::Index> indices;  ///< in the scene
  Block block;
};

/// The blocks of a scene whose bodies are `bodies`, and wrenches `applied`.
/// @throws std::invalid_argument if an effect cannot be divided among its methods
std::vector<Placed> blocksOf(const Scene& scene, const Bodies& bodies);

}  // namespace rigid_body_sim

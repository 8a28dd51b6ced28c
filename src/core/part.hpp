#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "core/block.hpp"
#include "core/suitability.hpp"
#include "rigid_body_sim/trajectory.hpp"

namespace rigid_body_sim {

/// Whether a long search shall end; may be empty.
using ShallEnd = std::function<bool()>;

/// A scene in the middle of its simulation.
struct Situation {
  const Scene& scene;
  const Bodies& bodies;
  const AppliedWrenches& held;
  Tick tick;
  ShallEnd shall_end = {};
};

/// Some of a scene's bodies by themselves, with all that acts on them: what can be flown on from
/// here.
struct Part {
  std::vector<Eigen::Index> indices;  ///< of the bodies in the scene
  Bodies bodies;
  EffectList effects;                      ///< held wrenches among them
  std::vector<Eigen::Index> ungyroscopic;  ///< places of those without the gyroscopic term
  double tick_s;
  Tick tick;
  ShallEnd shall_end = {};
};

/// @returns nothing if an effect cannot be divided
std::optional<Part> partOf(const Situation& now, const std::vector<Eigen::Index>& bodies);

/// The whole scene as one part.
Part wholeOf(const Situation& now);

/// The part in flight.
class Flight {
 public:
  Flight(const Part& part, const Method& method);

  /// @throws std::invalid_argument if it shall end, which is asked now and then
  void step();
  const Bodies& bodies() const { return block_.bodies(); }
  Tick tick() const { return tick_; }

 private:
  Block block_;
  Tick tick_;
  double tick_s_;
  ShallEnd shall_end_;
  double unasked_ = 0;  // steps since it was asked
};

/// The ticks at which flights are compared: 0, one in each stretch of `every`, and the last one,
/// `ticks`, a multiple of `every`. Where in its stretch a tick is varies irregularly: a comb would
/// not see errors that come back with its own period.
std::vector<Tick> ticksToCompare(Tick ticks, Tick every);

/// Sampled at ticksToCompare().
Trajectory fly(const Part& part, const Method& method, Tick ticks, Tick every);

/// As flyTruly() of a scene, but sampled at ticksToCompare().
TrueTrajectory flyTruly(const Part& part, Tick ticks, Tick every);

/// The truest of what `fly` gives for `time_s` [s]; `is_free` if nothing acts on the bodies.
TrueTrajectory truest(const std::function<Trajectory(const Method&)>& fly, bool is_free,
                      double time_s);

}  // namespace rigid_body_sim

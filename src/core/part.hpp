#pragma once

#include <functional>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
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

/// Why no method can be chosen for some bodies: what would take part in the choice is not to be
/// had.
class Unplannable : public std::invalid_argument {
 public:
  /// @param body that it is about; its place among those bodies
  Unplannable(const std::string& why, Eigen::Index body)
      : std::invalid_argument(why), body_(body) {}
  Eigen::Index body() const { return body_; }

 private:
  Eigen::Index body_;
};

/// The same of a flight that would be possible, but takes more steps than are allowed.
class TooLong : public Unplannable {
  using Unplannable::Unplannable;
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

  /// Evaluations of all effects together, in those of one effect on one body.
  double evaluations() const;

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

/// Steps of rk8, of all flights together, times bodies.
struct StepCount {
  double most = std::numeric_limits<double>::infinity();
  double taken = 0;
};

/// As flyTruly() of a scene, but sampled at ticksToCompare().
/// @param steps counted under effects with flows only, where they can be many
/// @throws Unplannable if effects are so stiff that no flight can be taken for true; TooLong
TrueTrajectory flyTruly(const Part& part, Tick ticks, Tick every, StepCount& steps);

/// What is to be flown truly.
struct Course {
  const EffectList& effects;
  const Bodies& start;
  double start_s;
  double tick_s;
  Tick ticks;
  Tick every;
};

/// The truest of what `fly` gives.
/// @throws Unplannable as above
TrueTrajectory truest(const std::function<Trajectory(const Method&)>& fly, const Course& course);

}  // namespace rigid_body_sim

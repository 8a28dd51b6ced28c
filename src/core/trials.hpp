#pragma once

#include <limits>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/part.hpp"
#include "rigid_body_sim/accuracy.hpp"

namespace rigid_body_sim {

/// How long and how much the trials of a part may fly.
struct Allowance {
  Tick ticks = 0;    ///< of a flight
  Tick every = 1;    ///< of these one is compared, see ticksToCompare()
  double span = 1;   ///< the budget's ticks by those flown; more than one: extrapolated
  double steps = 0;  ///< of all trial flights together, times bodies
  /// Of what stiff effects ask for besides: of the reference, and of the first flights of methods
  /// that are unstable in fewer steps.
  double stiff_steps = std::numeric_limits<double>::infinity();
};

/// Trial flights of a part of a scene by the methods of the registry, against the truth; none is
/// made twice, and none that a simulator would refuse to begin with, or that effects will make
/// unstable on the way.
class Trials {
 public:
  /// @throws Unplannable if there is no truth to be had; TooLong
  Trials(const Part& part, const Allowance& allowance);

  /// The cheapest that stays within `budget`, but for those of the integrator `except`, or what
  /// leaves less for little more; nothing if there is none within the allowance.
  std::optional<Offer> choose(const Budget& budget, const std::string& except = {});

  /// Of all flown so far the one that leaves the least of `budget`; nothing if none could be flown.
  std::optional<Offer> best(const Budget& budget) const;

  /// Measures the local errors that the method makes.
  Forecast forecast(const Offer& offer) const;

  /// Over the whole span.
  Deviation doubt() const;
  const std::string& reference() const { return truth_.how; }
  double bodySteps() const { return reference_steps_ + body_steps_ + stiff_steps_; }
  const Part& part() const { return part_; }

 private:
  struct Rung;

  std::optional<Offer> cheapest(const Budget& budget, const std::string& except);
  bool isAffordable(const Method& method) const;
  Deviation errorOf(const Method& method);
  double costOf(const Method& method) const;
  double reckonedSteps() const;
  double stepsOf(const Method& method) const;
  std::vector<Rung> rungs(const std::string& except) const;
  void followTruth();
  void findLeast();
  double timeOf(std::size_t sample) const;
  bool isBorne(const Method& method) const;
  bool isWithin(const Method& method) const;
  bool isFirstOfStiff(const Method& method) const;

  Part part_;
  Allowance allowance_;
  TrueTrajectory truth_;
  std::vector<Tick> compared_;  // ticks
  double rate_ = 0;             // the largest |w| on the way [rad/s]
  bool is_torque_free_ = true;
  double effects_cost_ = 0;   // of an evaluation, a body
  std::size_t stiffest_ = 0;  // of the samples, where friction is fastest
  double reference_steps_ = 0;
  double body_steps_ = 0;             // of the other trials
  double stiff_steps_ = 0;            // of first flights that the others left no steps for
  std::map<std::string, int> least_;  // by integrator, the place of the fewest substeps it takes
  std::map<std::pair<std::string, int>, Deviation> flown_;
};

}  // namespace rigid_body_sim

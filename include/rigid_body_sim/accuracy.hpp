#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "rigid_body_sim/scene.hpp"
#include "rigid_body_sim/trajectory.hpp"

namespace rigid_body_sim {

/// A method, what it leaves, and its price.
struct Offer {
  Method method;
  Deviation error;  ///< over the budget's span, at worst
  double cost = 0;  ///< of a tick of one body, in torque-free steps of `semi_implicit`: from the
                    ///< registry and the effects, not from a clock
};

/// Bodies that got the same method, all of them free or none. The figures are those of the one that
/// comes nearest to the budget; the last three are of the same search, for that body.
struct ClassBill {
  std::vector<Eigen::Index> bodies;
  std::size_t flown = 0;      ///< how many of them were flown; the others are like one of those
  Eigen::Index hardest = 0;   ///< the body whose figures these are
  bool is_free = false;       ///< nothing acts on them
  bool keeps_budget = false;  ///< false: the best there is
  Offer chosen;
  Deviation doubt;                  ///< of the reference
  std::string reference;            ///< in words
  std::optional<Offer> runner_up;   ///< the cheapest of another integrator that keeps the budget
  std::optional<Offer> digit_less;  ///< the cheapest for ten times the budget
  std::optional<Offer> digit_more;  ///< the cheapest for a tenth of it; none: it cannot be had
};

/// What is expected of a body over the budget's span.
struct Forecast {
  Deviation error;          ///< with the reference's doubt
  Deviation amplification;  ///< that error, by the span's ticks times the largest local error
};

/// What an accuracy budget costs, and what was chosen to keep it.
struct Bill {
  Budget budget;
  Tick tick = 0;          ///< the state at its beginning is what was planned from
  Tick ticks_flown = 0;   ///< less than the budget's span if that is longer than the bound allows:
                          ///< errors are then extrapolated as they grew
  Tick every = 1;         ///< of so many ticks one is compared, at irregular intervals
  double body_steps = 0;  ///< flown to find out
  std::vector<ClassBill> classes;
  std::vector<Forecast> forecasts;  ///< of each body
};

/// A share of the budget that the measured error and the reference's doubt may take up together.
/// Trials of up to 10,000 ticks are compared at every one, and a simulation without inputs repeats
/// them to the bit. Longer ones are compared at 10,000 ticks, irregularly spaced so that no
/// motion's period hides an error, and at the last; the rest is for what lies between, but an error
/// that is there for a few ticks only may be missed.
constexpr double kShareOfBudget = 0.99;

/// A prediction breaks the budget when it is this many times as much: the largest local error of a
/// flight is known from 200 of its ticks, and inputs that matter change it by far more.
constexpr double kAlarm = 1.25;

/// What share of the budget an error takes together with the reference's doubt; the budget is kept
/// up to 1.
double shareOf(const Budget& budget, const Deviation& error, const Deviation& doubt);

/// Chooses for every body the cheapest method that keeps the budget, or one that leaves less for at
/// most a quarter more, by flying it with the others against flyTruly(), and groups bodies of one
/// choice into classes. Depends on nothing but its arguments; no clock is asked.
///
/// Bounded: at most 256 bodies are flown, over at most 600,000 ticks in all, with at most 6e7 steps
/// in all and 1000 a tick; a step takes some 0.1 to 1 us. Where effects are
/// stiff, half as many come on top (or 4e6 steps of all bodies if that is more) for the reference
/// under friction, and the same for the first flights of methods that fewer substeps make unstable.
/// Where the reference would take more, flights are shorter. Of more bodies the fastest of those
/// alike are flown: alike are bodies under effects of the same names, whose |w|, largest moment by
/// the smallest, torque and acceleration at the start are of one power of two, or of several if
/// that makes more than 256 kinds. Bodies that differ by what only shows later (when a wrench
/// begins, how stiff a spring is that is not drawn yet) are taken for alike, and a bill may be
/// wrong for them. A scene whose effects couple its bodies is flown as a whole and gets one method.
/// @throws std::invalid_argument if no method keeps it, with the best there is and what it leaves;
/// if friction is too stiff for any reference, naming it; or as Simulator.
Bill plan(const Scene& scene, const Budget& budget);

/// The methods that a bill chose, for Scene::methods.
std::vector<MethodOfBodies> methodsOf(const Bill& bill);

/// The bill in lines that a user can read.
std::string toText(const Bill& bill, const Scene& scene);

/// What a tick of a running simulation was off, by flying it again with a far better method.
struct LocalError {
  Tick tick = 0;
  Eigen::Index body = 0;
  Deviation error;  ///< of the tick
  /// Over the budget's span, if all ticks were like this one: the error by the span's ticks and the
  /// bill's amplification; of rounding, no more than the bill's own error.
  Deviation predicted;
  double share = 0;  ///< what share of the budget the prediction takes
};

/// A body that got inputs the plan did not know, and has been flown a second time by a far better
/// method since: how far it is off now.
struct SpentError {
  Eigen::Index body = 0;
  Tick since = 0;    ///< the first of these inputs
  Tick tick = 0;     ///< of the state that was compared
  Deviation error;   ///< from the second flight
  double share = 0;  ///< of the budget, with what the plan foresaw until then
};

/// Whether a running simulation keeps its budget. Bodies are looked at in turn, one tick of one
/// body at a time: every tick if there are 30 or more, each body every 30 ticks if they are fewer.
/// Bodies that are coupled are looked at together, every 30 ticks a body. A body that gets an
/// impulse or its first wrench is looked at in that tick, or as soon as those before it have been;
/// and from then on it is flown a second time, which measures what it is off by: up to eight bodies
/// at once, none that are coupled.
struct AccuracyState {
  Bill bill;      ///< the latest
  int bills = 1;  ///< how many there were
  std::size_t samples = 0;
  std::optional<LocalError> latest;
  std::optional<LocalError> worst_now;   ///< of the latest samples of all bodies
  std::optional<LocalError> worst_ever;  ///< since the start or a reset

  std::optional<LocalError> planned_for;  ///< why methods were chosen anew, the last time
  std::optional<SpentError> spent;        ///< of the followed body that is furthest off now
  std::optional<SpentError> broken;       ///< when the budget was first seen to be exceeded; stays

  /// Whether the span would end within the budget if it went on as it does now.
  bool willKeep() const { return !worst_now || worst_now->share <= kAlarm; }
  bool keepsBudget() const { return !broken && willKeep(); }
};

/// `rk8 x 2: rocket, probe and 3 more`.
std::string summary(const ClassBill& one, const Scene& scene);

/// `rocket: 2e-3 rad and 0 m off at tick 460, by inputs since tick 203`.
std::string toText(const SpentError& spent, const Scene& scene);

/// `rocket: 1e-12 rad and 0 m in tick 60, so 2e-08 rad and 0 m over the span`.
std::string toText(const LocalError& sample, const Scene& scene);

}  // namespace rigid_body_sim

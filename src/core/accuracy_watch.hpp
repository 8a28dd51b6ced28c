#pragma once

#include <deque>
#include <optional>
#include <vector>

#include "core/true_copies.hpp"
#include "rigid_body_sim/accuracy.hpp"

namespace rigid_body_sim {

/// Looks at the local errors of a running simulation. Counts ticks, so that the same inputs give
/// the same samples.
class AccuracyWatch {
 public:
  AccuracyWatch(Bill bill, const Scene& scene);

  /// An impulse is about to be given.
  void impulse(const ImpulseInput& input, const Bodies& before, Tick tick);

  /// A wrench is about to act.
  void wrench(Eigen::Index body, const Bodies& before, Tick tick);

  /// A tick begins; impulses have been given.
  void beginTick(const Situation& now);
  /// It has ended; `frozen` are the bodies that do not move.
  void endTick(const Bodies& bodies, const std::vector<FrozenBody>& frozen, Tick tick);

  /// The body that a new choice is due for, if any. One that was chosen for anew is not again for a
  /// tenth of the budget's span: nothing may be gained, and flights cost time.
  std::optional<Eigen::Index> bodyToReplan() const;

  /// Takes up a new choice for a body.
  void replan(Bill bill, Eigen::Index body);

  /// As at the start, from `tick` on. @returns whether the bill is another one now
  bool reset(Tick tick);

  const AccuracyState& state() const { return state_; }

 private:
  void take(Bill bill);
  void lookAt(Eigen::Index body);
  bool follow(Eigen::Index body, const Bodies& before, Tick tick);
  void compareCopies(const Bodies& bodies, Tick tick);
  LocalError sampleOf(const Bodies& after) const;
  Deviation predictedFrom(const Deviation& error, const Deviation& rounding,
                          const Forecast& forecast) const;
  void note(const LocalError& sample);
  void forget(Eigen::Index body);
  void findWorst();

  AccuracyState state_;
  Bill first_;
  double tick_s_;
  bool is_coupled_;
  Tick apart_;                                   // of samples [ticks]
  Tick ticks_ = 0;                               // since the start or the reset
  Tick start_ = 0;                               // the tick of that
  Eigen::Index next_ = 0;                        // body whose turn it is
  std::deque<Eigen::Index> asked_;               // bodies to look at before
  Eigen::Index body_ = 0;                        // the one that is looked at
  std::optional<Part> looked_at_;                // at the beginning of this tick
  std::vector<Method> methods_;                  // of each body
  std::vector<std::optional<LocalError>> last_;  // of each body
  TrueCopies copies_;
  std::vector<Tick> next_plan_;  // of each body, not before this of ticks_
};

}  // namespace rigid_body_sim

#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "rigid_body_sim/effect.hpp"

namespace rigid_body_sim {

/// What an effect has done so far.
struct EffectCount {
  std::string name;
  std::uint64_t evaluations = 0;  ///< of one body each; those of steady effects are counted too
  double work_J = 0;              ///< done on the bodies, if it is audited and not conservative [J]
};

/// Adds `more` to the counts of the same names.
void addUp(const std::vector<EffectCount>& more, std::vector<EffectCount>& counts);

/// The effects that act now on a set of bodies, which stay the same with their masses. A few
/// virtual calls an effect and evaluation; an effect that is not in the list costs nothing at all.
class ActiveEffects {
 public:
  void add(const Effect* effect);
  void remove(const Effect* effect);

  bool empty() const { return kicks_.empty() && flows_.empty(); }
  bool hasKicks() const { return !kicks_.empty(); }
  bool hasFlows() const { return !flows_.empty(); }

  /// Whether all wrenches of a step are those at its beginning, and none is audited.
  bool areSteady() const;

  /// Whether somebody looks at the velocities at which effects are evaluated.
  bool needVelocities() const { return is_audited_ || depend_on_velocity_; }

  /// The sum of all effects; valid until the next call. For methods whose momentum is a weighted
  /// sum of what they evaluate.
  /// @param weight_s what the step multiplies these wrenches by, for the audit [s]
  const Wrenches& evaluate(const Bodies& bodies, double time_s, double weight_s = 0);

  /// The same where all are steady, taken as so many evaluations.
  const Wrenches& evaluateSteady(const Bodies& bodies, double time_s, unsigned times);

  /// The sum of the effects without a flow; valid until the next call. For methods that give the
  /// momentum at once.
  /// @param weight_s how long the kick is, for the audit [s]
  const Wrenches& evaluateKicks(const Bodies& bodies, double time_s, double weight_s = 0);

  /// The instant evaluated last, with the velocities at it.
  const Instant& instant() const { return instant_; }

  /// The flows, in their order before the drift and the other way round after it. If there are
  /// kicks, they were evaluated just before.
  void beforeDrift(Bodies& bodies, double time_s, double h);
  void afterDrift(Bodies& bodies, double time_s, double h);

  /// A step was taken, or given up, with what was evaluated since: counts its work or forgets it.
  void stepTaken();
  void stepGivenUp();

  /// From now on the work of effects that are not conservative is counted.
  void beginAudit() { is_audited_ = true; }

  /// Of all effects that have been active.
  std::vector<EffectCount> counts() const;

 private:
  struct Entry {
    const Effect* effect;
    std::uint64_t evaluations = 0;
    double work_J = 0;
    double pending_J = 0;  // of a step that is not taken yet
  };

  void addUpKicks(unsigned times);
  void addUpFlows();
  void hasFlowed(const Effect& effect);
  template <class Flow>
  void audited(Entry& entry, Bodies& bodies, Flow flow);
  void auditKicks(double weight_s);
  void auditStage(std::vector<Entry>& entries, double weight_s);
  const Wrenches& wrenchesOf(const Effect& effect);

  std::vector<Entry> kicks_;
  std::vector<Entry> flows_;
  std::vector<EffectCount> past_;  // of those that were removed
  Instant instant_;
  Wrenches sum_;
  bool is_kept_ = false;    // sum_ is that of the kicks, which are steady
  bool are_steady_ = true;  // the kicks
  Wrenches one_;            // of one effect, for the audit
  bool is_audited_ = false;
  bool depend_on_velocity_ = false;
};

}  // namespace rigid_body_sim

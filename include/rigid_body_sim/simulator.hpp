#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "rigid_body_sim/accuracy.hpp"
#include "rigid_body_sim/column_pointers.hpp"
#include "rigid_body_sim/integrator.hpp"
#include "rigid_body_sim/scene.hpp"
#include "rigid_body_sim/wrench.hpp"

namespace rigid_body_sim {

/// Who gave an input, and which of his it is: the order in which inputs of one tick are summed, so
/// that the timing of threads cannot change a result.
struct Origin {
  std::string source;          ///< topic and publisher
  std::uint64_t sequence = 0;  ///< of the message, among those of this source
  std::uint64_t entry = 0;     ///< within the message
};

/// A wrench that acts over whole ticks.
struct WrenchInput {
  Eigen::Index body = 0;
  AppliedWrench applied;
  Tick start = 0;         ///< first tick it acts in; a past one means the next tick
  Tick ticks = 0;         ///< how many; 0: until it is replaced
  bool replaces = false;  ///< ends the wrenches that earlier messages of the same source gave to
                          ///< the body with `replaces` set
  Origin origin;
};

/// Momentum given at once, at the beginning of a tick.
struct ImpulseInput {
  Eigen::Index body = 0;
  AppliedWrench applied;  ///< in [N s] and [N m s]
  Tick start = 0;         ///< the tick; a past one means the next tick
  Origin origin;
};

/// The order in which the inputs of one tick are taken: by body, then by origin.
template <class Input>
bool isBefore(const Input& a, const Input& b) {
  const auto key = [](const Input& input) {
    return std::tie(input.body, input.origin.source, input.origin.sequence, input.origin.entry);
  };
  return key(a) < key(b);
}

/// Adds `begun` to inputs that are ordered by isBefore(), without those that are replaced then.
void settle(std::vector<WrenchInput>& held, std::vector<WrenchInput> begun);

/// A body that was stopped because its state would have become infinite or not a number.
struct FrozenBody {
  Eigen::Index body;
  Tick tick;  ///< the tick that failed; the state is the one at its beginning
};

/// The effect of the inputs: the wrenches held at the moment.
class AppliedWrenches : public Effect {
 public:
  std::string name() const override { return "applied"; }
  std::size_t bodyCount() const override { return acting_.size(); }
  bool isSteady() const override;
  void addWrenches(const Instant& now, Wrenches& wrenches) const override;
  std::shared_ptr<const Effect> restrictedTo(
      const std::vector<Eigen::Index>& bodies) const override;

  /// Ends what replaces and time end, and takes up `begun`. Returns those that ran out at `tick`.
  std::vector<WrenchInput> update(std::vector<WrenchInput> begun, Tick tick);
  void clear();
  const std::vector<WrenchInput>& held() const { return held_; }

 private:
  /// What of an input matters while it acts.
  struct Acting {
    Eigen::Index body;
    Axes axes;
    Triple f, t, p_BcmQ_B;
  };

  std::vector<WrenchInput>
      held_;  // ordered by body, source, sequence, entry; none of a restricted one
  std::vector<Acting> acting_;  // in the same order
};

class AccuracyWatch;
class Crew;
class Snapshot;
struct Placed;

/// A body that turns further in a step than its method bears.
struct OverTurnedBody {
  Eigen::Index body;
  Method method;
  double turn;      ///< [rad] a step
  double max_turn;  ///< what the method bears
};

/// A body on which something acts that has become too stiff for the step.
struct StiffBody {
  Eigen::Index body;
  std::string why;  ///< names the effect, and the largest stable step, or what friction falsifies
};

/// Where the energy of all bodies is, and what changed it. Work is counted if the scene asks for an
/// audit; then `unaccounted` is what the integrator's error has made or lost, as long as no body is
/// frozen. Work of a flow is the kinetic energy that it takes: an error of the flow itself does not
/// show.
struct EnergyBalance {
  double kinetic_J = 0;
  double potential_J = 0;  ///< of the conservative effects
  double start_J = 0;      ///< both, at the start, and what switched effects brought since
  double inputs_J = 0;     ///< work of wrenches and impulses since the start
  double effects_J = 0;    ///< work of effects that are not conservative; negative: dissipated

  double unaccounted_J() const { return kinetic_J + potential_J - start_J - inputs_J - effects_J; }
};

/// What one effect does to each body at an instant.
struct WrenchesOfEffect {
  std::string name;
  Wrenches wrenches;
};

/// The state of a scene and the loop that advances it. Deterministic: the same scene and the same
/// inputs give the same bits. Not thread-safe: one thread owns it.
class Simulator {
 public:
  /// @throws std::invalid_argument for a scene that cannot be simulated: no body, a frame twice, an
  /// invalid tensor, a pose that is no rigid transform, an unknown integrator, a step that is not
  /// positive, an integrator that does not bear an effect or a body's spin, an
  /// accuracy that no method keeps.
  /// @param shall_end is asked now and then while methods are chosen for an accuracy, which may
  /// take seconds; true ends that with an exception
  explicit Simulator(Scene scene, std::function<bool()> shall_end = {});
  ~Simulator();
  Simulator(Simulator&&) noexcept;
  Simulator& operator=(Simulator&&) noexcept;

  /// With the warnings of its integrator.
  const Scene& scene() const { return scene_; }

  /// Ticks since the start; the state is the one at the beginning of this tick.
  Tick tick() const { return tick_; }

  /// Hands over an input; it is latched when its tick begins.
  /// @throws std::invalid_argument for an unknown body, a number that is not finite, a negative
  /// number of ticks, or a torque on a point mass; nothing is changed then.
  void apply(WrenchInput input);
  void apply(ImpulseInput input);

  /// Simulates one tick: latch inputs, give impulses, step, freeze bodies whose state is not
  /// finite. @throws std::invalid_argument only if it shall end while it chooses methods anew.
  void step() { advance(1); }

  /// Simulates that many ticks, with the same result as step() as often, but faster where bodies
  /// are many: as long as no input begins or ends, each is taken through several ticks while it is
  /// in the processor's cache.
  /// @throws std::invalid_argument for a negative number, or as step() does
  void advance(Tick ticks);

  /// Back to the initial state, without inputs and frozen bodies. Takes one tick, so that no time
  /// belongs to two states.
  void reset();

  /// The beginning of this tick, from the start [s].
  double time_s() const { return static_cast<double>(tick_) * scene_.step_s(); }

  /// Ends or begins again what the scene lists below `effects`, or the gyroscopic term of those
  /// bodies that do not say of it themselves, from this tick on; until the next reset.
  /// @returns whether that changed anything
  /// @throws std::invalid_argument for an effect that the scene does not have, if a method does not
  /// bear it, or if the scene has an accuracy budget; nothing is changed then. What there is to
  /// caution about comes after the scene's own warnings, until the next switch.
  bool switchEffect(const std::string& name, bool is_on);

  /// What switchEffect() takes: the blocks below `effects`, and `gyroscopic`.
  std::vector<std::string> effectNames() const;

  /// What each effect has done since the start or the latest reset; those that were never active
  /// are not among them.
  std::vector<EffectCount> effectCounts() const;

  /// What each effect does at this instant, the held wrenches last.
  std::vector<WrenchesOfEffect> effectWrenches() const;

  /// The sum of them on one body, about its centre of mass, in world axes.
  Wrench wrenchOn(Eigen::Index body) const;

  EnergyBalance energy() const;

  /// All bodies; valid until the next tick.
  const Bodies& bodies() const;
  BodyState state(Eigen::Index body) const;

  /// Pose and velocities of the body's root link.
  LinkMotion linkMotion(Eigen::Index body) const;

  /// Constant pose of body frame B (centre of mass, principal axes) in the root link frame.
  const BodyFrame& bodyFrame(Eigen::Index body) const { return frames_[body]; }

  /// Inputs that wait for their tick.
  std::size_t pendingCount() const { return pending_wrenches_.size() + pending_impulses_.size(); }

  /// Wrenches that act now.
  const std::vector<WrenchInput>& heldWrenches() const { return applied_->held(); }

  /// Wrenches that ran out at the beginning of the latest tick, or in the latest advance();
  /// replaced ones are not among them.
  const std::vector<WrenchInput>& endedWrenches() const { return ended_; }

  const std::vector<FrozenBody>& frozenBodies() const { return frozen_; }

  /// Whether the scene's accuracy is kept; null if it asks for none.
  const AccuracyState* accuracy() const;

  /// The worst of the bodies that inputs have made too fast for their method, if any. Looks at all
  /// bodies: not for every tick.
  std::optional<OverTurnedBody> overTurnedBody() const;

  /// One on which an effect by itself has become too stiff since the start, as by a close
  /// encounter, if any. Looks at all bodies and effects: not for every tick.
  std::optional<StiffBody> stiffBody() const;

 private:
  /// Where the state of a body is.
  struct Place {
    std::size_t block;
    Eigen::Index row;
  };

  void addBody(const SceneBody& body);
  void makeBlocks();
  void setState(Eigen::Index body, const BodyState& state);
  void replanIfDue();
  void settlePending();
  void latchInputs();
  void latchWrenches();
  void holdWrenches();
  void giveImpulses(std::vector<ImpulseInput> impulses);
  Tick ticksWithoutInput(Tick most) const;
  void advanceBlocks(Tick ticks);
  void noteFrozenBodies();

  Scene scene_;
  std::function<bool()> shall_end_;
  std::vector<BodyFrame> frames_;
  Bodies initial_;
  mutable Bodies bodies_;  // the blocks' states in the scene's order, if it is up to date
  mutable bool is_up_to_date_ = true;
  Tick tick_ = 0;
  std::vector<Placed> blocks_;
  std::vector<Place> places_;   // of each body
  std::unique_ptr<Crew> crew_;  // null: this thread alone
  struct Switches {
    EffectList effects;
    Gyroscopic gyroscopic = Gyroscopic::kOn;
  };
  Switches switchedTo(const std::string& name, bool is_on) const;
  Switches at_start_;
  std::size_t start_warnings_ = 0;  // the scene's own, and those of its methods
  std::vector<EffectCount> counts_;  // of blocks that are no more
  double initial_energy_J_ = 0;
  double start_energy_J_ = 0;  // and the potential energy that effects brought or took since
  double impulse_work_J_ = 0;
  std::unique_ptr<AccuracyWatch> watch_;  // null: no accuracy asked for
  std::shared_ptr<AppliedWrenches> applied_ = std::make_shared<AppliedWrenches>();
  std::vector<WrenchInput> pending_wrenches_;
  std::size_t settled_ = 0;  // how many were left of them when they were settled last
  std::vector<ImpulseInput> pending_impulses_;
  std::vector<std::pair<Eigen::Index, BodyState>> before_impulses_;  // in this tick
  std::vector<WrenchInput> ended_;
  std::vector<FrozenBody> frozen_;
};

}  // namespace rigid_body_sim

// What is given to a simulator, and how it gets to the blocks of bodies.
#include <algorithm>
#include <iterator>
#include <stdexcept>
#include <utility>

#include "core/accuracy_watch.hpp"
#include "core/block.hpp"
#include "rigid_body_sim/conserved.hpp"

namespace rigid_body_sim {
namespace {

bool isFinite(const AppliedWrench& applied) {
  return applied.wrench.f_F.allFinite() && applied.wrench.t_Q_F.allFinite() &&
         applied.p_BcmQ_B.allFinite();
}

template <class Input>
void check(const Input& input, const Scene& scene) {
  if (input.body < 0 || input.body >= static_cast<Eigen::Index>(scene.bodies.size()))
    throw std::invalid_argument("there is no body " + std::to_string(input.body));
  if (!isFinite(input.applied)) throw std::invalid_argument("input is not finite");
  const SceneBody& body = scene.bodies[input.body];
  const AppliedWrench& applied = input.applied;
  if (body.is_point_mass && !(applied.wrench.t_Q_F.isZero(0) && applied.p_BcmQ_B.isZero(0)))
    throw std::invalid_argument("a torque on the point mass '" + body.name + "'");
}

/// Moves the inputs that are due at `tick` out of `pending`.
template <class Input>
std::vector<Input> takeDue(std::vector<Input>& pending, Tick tick) {
  const auto first_due = std::stable_partition(
      pending.begin(), pending.end(), [tick](const Input& input) { return input.start > tick; });
  std::vector<Input> due(std::make_move_iterator(first_due),
                         std::make_move_iterator(pending.end()));
  pending.erase(first_due, pending.end());
  return due;
}

}  // namespace

void Simulator::apply(WrenchInput input) {
  check(input, scene_);
  if (input.ticks < 0) throw std::invalid_argument("a negative number of ticks");
  input.start = std::max(input.start, tick_);
  pending_wrenches_.push_back(std::move(input));
  settlePending();
}

/// What is replaced at once need not wait: a sender that goes on while the simulation is paused
/// keeps a few inputs, not all. Now and then, as it takes time.
void Simulator::settlePending() {
  constexpr std::size_t kFew = 16;
  if (pending_wrenches_.size() < 2 * settled_ + kFew) return;
  std::vector<WrenchInput> due = takeDue(pending_wrenches_, tick_), settled;
  settle(settled, std::move(due));
  std::move(settled.begin(), settled.end(), std::back_inserter(pending_wrenches_));
  settled_ = pending_wrenches_.size();
}

void Simulator::apply(ImpulseInput input) {
  check(input, scene_);
  input.start = std::max(input.start, tick_);
  pending_impulses_.push_back(std::move(input));
}

void Simulator::latchInputs() {
  if (!pending_wrenches_.empty() || applied_->bodyCount() > 0) latchWrenches();
  before_impulses_.clear();
  if (!pending_impulses_.empty()) giveImpulses(takeDue(pending_impulses_, tick_));
}

void Simulator::latchWrenches() {
  std::vector<WrenchInput> begun = takeDue(pending_wrenches_, tick_);
  const bool may_change = !begun.empty();
  if (watch_)
    for (const WrenchInput& input : begun) watch_->wrench(input.body, bodies(), tick_);
  std::vector<WrenchInput> ended = applied_->update(std::move(begun), tick_);
  if (may_change || !ended.empty()) holdWrenches();
  std::move(ended.begin(), ended.end(), std::back_inserter(ended_));
}

void Simulator::holdWrenches() {
  for (Placed& one : blocks_) {
    const bool is_whole = blocks_.size() == 1 && one.indices.front() == 0;
    std::shared_ptr<const Effect> own = is_whole ? applied_ : applied_->restrictedTo(one.indices);
    one.block.hold(own->bodyCount() > 0 ? std::move(own) : nullptr);
  }
}

void Simulator::giveImpulses(std::vector<ImpulseInput> impulses) {
  std::sort(impulses.begin(), impulses.end(), isBefore<ImpulseInput>);
  for (const ImpulseInput& input : impulses) {
    if (isZero(input.applied.wrench)) continue;  // -0 + 0 would change a bit
    const auto is_it = [&](const FrozenBody& frozen) { return frozen.body == input.body; };
    if (std::any_of(frozen_.begin(), frozen_.end(), is_it)) continue;
    if (watch_) watch_->impulse(input, bodies(), tick_);
    BodyState body = state(input.body);
    if (before_impulses_.empty() || before_impulses_.back().first != input.body)
      before_impulses_.emplace_back(input.body, body);
    const Wrench impulse = inWorldAboutCom(input.applied, body.q_WB);
    body.P_WB += impulse.f_F;
    body.L_WBcm_W += impulse.t_Q_F;
    const double before = scene_.energy_audit ? kineticEnergy(bodies(), input.body) : 0;
    setState(input.body, body);
    if (scene_.energy_audit) impulse_work_J_ += kineticEnergy(bodies(), input.body) - before;
  }
}

/// From this tick on, at most `most`, at least one.
Tick Simulator::ticksWithoutInput(Tick most) const {
  if (watch_) return 1;
  Tick next = tick_ + most;
  for (const WrenchInput& input : pending_wrenches_) next = std::min(next, input.start);
  for (const ImpulseInput& input : pending_impulses_) next = std::min(next, input.start);
  for (const WrenchInput& input : applied_->held())
    if (input.ticks > 0) next = std::min(next, input.start + input.ticks);
  return std::max<Tick>(next - tick_, 1);
}

}  // namespace rigid_body_sim

#include <algorithm>

#include "rigid_body_sim/column_pointers.hpp"
#include "rigid_body_sim/simulator.hpp"

namespace rigid_body_sim {

bool isReplacedBy(const WrenchInput& old, const WrenchInput& input) {
  return old.replaces && input.replaces && old.body == input.body &&
         old.origin.source == input.origin.source && old.origin.sequence != input.origin.sequence;
}

void AppliedWrenches::addWrenches(const Instant& now, Wrenches& wrenches) const {
  if (held_.empty()) return;
  const RotationPointers R_WB(now.R_WB());
  const auto f_W = pointersTo(wrenches.f_W), t_W = pointersTo(wrenches.t_Bcm_W);
  for (const WrenchInput& input : held_) {
    const Eigen::Index i = input.body;
    const Triple f(input.applied.wrench.f_F), t(input.applied.wrench.t_Q_F),
        p_BcmQ_B(input.applied.p_BcmQ_B);
    if (input.applied.axes == Axes::kWorld) {
      add(f_W, i, f);
      add(t_W, i, t + cross(R_WB.times(i, p_BcmQ_B), f));
    } else {
      const Turn R = R_WB.of(i);
      add(f_W, i, R.times(f));
      add(t_W, i, R.times(t + cross(p_BcmQ_B, f)));
    }
  }
}

std::shared_ptr<const Effect> AppliedWrenches::restrictedTo(
    const std::vector<Eigen::Index>& bodies) const {
  auto restricted = std::make_shared<AppliedWrenches>();
  // By body and then as held, so that the sum of a body's wrenches keeps its order.
  for (std::size_t k = 0; k < bodies.size(); ++k) {
    for (const WrenchInput& input : held_) {
      if (input.body != bodies[k]) continue;
      restricted->held_.push_back(input);
      restricted->held_.back().body = static_cast<Eigen::Index>(k);
    }
  }
  return restricted;
}

std::vector<WrenchInput> AppliedWrenches::update(std::vector<WrenchInput> begun, Tick tick) {
  std::vector<WrenchInput> ended;
  std::sort(begun.begin(), begun.end(), isBefore<WrenchInput>);
  for (WrenchInput& input : begun) {
    held_.erase(std::remove_if(held_.begin(), held_.end(),
                               [&](const auto& old) { return isReplacedBy(old, input); }),
                held_.end());
    // A zero wrench only replaces: whether it is there or not makes no bit of difference.
    if (!isZero(input.applied.wrench)) held_.push_back(std::move(input));
  }
  const auto runs_on = [&](const WrenchInput& input) {
    return input.ticks == 0 || tick - input.start < input.ticks;
  };
  const auto first_ended = std::stable_partition(held_.begin(), held_.end(), runs_on);
  ended.assign(std::make_move_iterator(first_ended), std::make_move_iterator(held_.end()));
  held_.erase(first_ended, held_.end());
  std::sort(held_.begin(), held_.end(), isBefore<WrenchInput>);
  return ended;
}

}  // namespace rigid_body_sim

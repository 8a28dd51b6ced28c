#include <algorithm>

#include "rigid_body_sim/simulator.hpp"

namespace rigid_body_sim {

bool isReplacedBy(const WrenchInput& old, const WrenchInput& input) {
  return old.replaces && input.replaces && old.body == input.body &&
         old.origin.source == input.origin.source && old.origin.sequence != input.origin.sequence;
}

void AppliedWrenches::addWrenches(const Instant& now, Wrenches& wrenches) const {
  const Bodies& bodies = now.bodies();
  for (const WrenchInput& input : held_) {
    const Quaterniond q_WB(Eigen::Vector4d(bodies.q_WB.row(input.body)));
    const Wrench wrench = inWorldAboutCom(input.applied, q_WB);
    wrenches.f_W.row(input.body) += wrench.f_F;
    wrenches.t_Bcm_W.row(input.body) += wrench.t_Q_F;
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

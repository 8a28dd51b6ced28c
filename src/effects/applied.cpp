#include <algorithm>
#include <iterator>

#include "rigid_body_sim/column_pointers.hpp"
#include "rigid_body_sim/simulator.hpp"

namespace rigid_body_sim {

void AppliedWrenches::addWrenches(const Instant& now, Wrenches& wrenches) const {
  if (acting_.empty()) return;
  const RotationPointers R_WB(now.R_WB());
  const auto f_W = pointersTo(wrenches.f_W), t_W = pointersTo(wrenches.t_Bcm_W);
  for (const Acting& one : acting_) {
    const Eigen::Index i = one.body;
    if (one.axes == Axes::kWorld) {
      add(f_W, i, one.f);
      add(t_W, i, one.t + cross(R_WB.times(i, one.p_BcmQ_B), one.f));
    } else {
      const Turn R = R_WB.of(i);
      add(f_W, i, R.times(one.f));
      add(t_W, i, R.times(one.t + cross(one.p_BcmQ_B, one.f)));
    }
  }
}

/// Those in world axes that do not force the body at a point that turns with it. It holds until the
/// next update().
bool AppliedWrenches::isSteady() const {
  const Triple none(0, 0, 0);
  return std::all_of(acting_.begin(), acting_.end(), [&](const Acting& one) {
    return one.axes == Axes::kWorld && (one.p_BcmQ_B == none || one.f == none);
  });
}

std::shared_ptr<const Effect> AppliedWrenches::restrictedTo(
    const std::vector<Eigen::Index>& bodies) const {
  auto restricted = std::make_shared<AppliedWrenches>();
  // By body and then as held, so that the sum of a body's wrenches keeps its order.
  for (std::size_t k = 0; k < bodies.size() && !acting_.empty(); ++k) {
    const auto isBefore = [](const Acting& one, Eigen::Index body) { return one.body < body; };
    auto one = std::lower_bound(acting_.begin(), acting_.end(), bodies[k], isBefore);
    for (; one != acting_.end() && one->body == bodies[k]; ++one) {
      restricted->acting_.push_back(*one);
      restricted->acting_.back().body = static_cast<Eigen::Index>(k);
    }
  }
  return restricted;
}

namespace {

/// Whether both are from one source to one body.
bool areOfOneKind(const WrenchInput& a, const WrenchInput& b) {
  return a.body == b.body && a.origin.source == b.origin.source;
}

}  // namespace

void settle(std::vector<WrenchInput>& held, std::vector<WrenchInput> begun) {
  if (begun.empty()) return;
  std::sort(begun.begin(), begun.end(), isBefore<WrenchInput>);
  std::vector<WrenchInput> next;
  next.reserve(held.size() + begun.size());
  auto old = held.begin();
  for (auto first = begun.begin(), end = first; first != begun.end(); first = end) {
    const WrenchInput* replacing = nullptr;  // the last that does
    for (; end != begun.end() && areOfOneKind(*first, *end); ++end)
      if (end->replaces) replacing = &*end;
    const auto stays = [&](const WrenchInput& one) {
      return !replacing || !one.replaces || one.origin.sequence == replacing->origin.sequence;
    };
    for (; old != held.end() && isBefore(*old, *first) && !areOfOneKind(*old, *first); ++old)
      next.push_back(std::move(*old));
    const auto own = static_cast<std::ptrdiff_t>(next.size());
    for (; old != held.end() && areOfOneKind(*old, *first); ++old)
      if (stays(*old)) next.push_back(std::move(*old));
    const auto middle = static_cast<std::ptrdiff_t>(next.size());
    for (auto one = first; one != end; ++one)
      if (stays(*one)) next.push_back(*one);
    std::inplace_merge(next.begin() + own, next.begin() + middle, next.end(),
                       isBefore<WrenchInput>);
  }
  std::move(old, held.end(), std::back_inserter(next));
  held = std::move(next);
}

std::vector<WrenchInput> AppliedWrenches::update(std::vector<WrenchInput> begun, Tick tick) {
  const std::size_t begun_count = begun.size();
  settle(held_, std::move(begun));
  // A zero wrench only replaces: whether it is there or not makes no bit of difference.
  const auto is_zero = [](const WrenchInput& input) { return isZero(input.applied.wrench); };
  held_.erase(std::remove_if(held_.begin(), held_.end(), is_zero), held_.end());
  const auto runs_on = [&](const WrenchInput& input) {
    return input.ticks == 0 || tick - input.start < input.ticks;
  };
  const bool is_steady = begun_count == 0 && std::all_of(held_.begin(), held_.end(), runs_on);
  if (is_steady) return {};
  const auto first_ended = std::stable_partition(held_.begin(), held_.end(), runs_on);
  std::vector<WrenchInput> ended(std::make_move_iterator(first_ended),
                                 std::make_move_iterator(held_.end()));
  held_.erase(first_ended, held_.end());
  acting_.clear();
  for (const WrenchInput& input : held_) {
    const AppliedWrench& applied = input.applied;
    acting_.push_back({input.body, applied.axes, Triple(applied.wrench.f_F),
                       Triple(applied.wrench.t_Q_F), Triple(applied.p_BcmQ_B)});
  }
  return ended;
}

void AppliedWrenches::clear() {
  held_.clear();
  acting_.clear();
}

}  // namespace rigid_body_sim

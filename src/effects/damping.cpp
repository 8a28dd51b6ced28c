#include <cmath>

#include "effects/makers.hpp"
#include "rigid_body_sim/column_pointers.hpp"
#include "rigid_body_sim/members.hpp"

namespace rigid_body_sim {
namespace {

struct Rates {
  double linear;   // [1/s]
  double angular;  // [1/s]
};

bool operator==(const Rates& a, const Rates& b) {
  return a.linear == b.linear && a.angular == b.angular;
}

/// P' = -c P and L' = -c L: velocities fall by exp(-c t), whatever the tensor.
///
/// The flow is this solution itself, so a step of any length brakes by what it should and never
/// turns a velocity round.
class Damping : public Effect {
 public:
  explicit Damping(Members<Rates> members) : members_(std::move(members)) {}

  std::string name() const override { return "damping"; }
  std::size_t bodyCount() const override { return members_.size(); }
  bool dependsOnVelocity() const override { return true; }
  int flowOrder() const override { return 2; }

  void addWrenches(const Instant& now, Wrenches& wrenches) const override {
    for (const auto& [i, c] : members_) {
      wrenches.f_W.row(i) -= c.linear * now.bodies().P_WB.row(i);
      wrenches.t_Bcm_W.row(i) -= c.angular * now.bodies().L_WBcm_W.row(i);
    }
  }

  void beforeDrift(Bodies& bodies, const Instant&, double h) const override {
    decay(bodies, 0.5 * h);
  }
  void afterDrift(Bodies& bodies, const Instant&, double h) const override {
    decay(bodies, 0.5 * h);
  }

  Stiffness stiffness(const Instant&) const override {
    Stiffness stiffest;
    for (const auto& [i, c] : members_) {
      const double rate = std::max(c.linear, c.angular);
      if (rate > stiffest.decay) stiffest = {0, rate, i, true};
    }
    return stiffest;
  }

  std::shared_ptr<const Effect> restrictedTo(const std::vector<Eigen::Index>& some) const override {
    return std::make_shared<Damping>(members_.restrictedTo(some));
  }

 private:
  void decay(Bodies& bodies, double h) const {
    if (members_.empty()) return;
    const auto P = pointersTo(bodies.P_WB), L = pointersTo(bodies.L_WBcm_W);
    const auto leftOf = [h](const Rates& c) {
      return Rates{std::exp(-c.linear * h), std::exp(-c.angular * h)};
    };
    const auto decay = [P, L](Eigen::Index i, const Rates& left) {
      set(P, i, left.linear * at(P, i));
      set(L, i, left.angular * at(L, i));
    };
    if (const Rates* common = members_.commonData()) {
      const Rates left = leftOf(*common);
      members_.forEach([=](Eigen::Index i, const Rates&) { decay(i, left); });
    } else {
      members_.forEach([=](Eigen::Index i, const Rates& c) { decay(i, leftOf(c)); });
    }
  }

  Members<Rates> members_;
};

}  // namespace

EffectList makeDamping(EffectBlock& block) {
  Members<Rates> members;
  for (const auto& member : block.members) {
    const Rates rates = {block.number(member, "linear", notNegative("1/s"), 0),
                         block.number(member, "angular", notNegative("1/s"), 0)};
    if (rates.linear > 0 || rates.angular > 0) members.add(member.body, rates);
  }
  if (members.empty()) return {};
  return {std::make_shared<Damping>(std::move(members))};
}

}  // namespace rigid_body_sim

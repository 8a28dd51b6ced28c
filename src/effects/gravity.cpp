#include "effects/makers.hpp"
#include "rigid_body_sim/members.hpp"

namespace rigid_body_sim {
namespace {

struct Nothing {};

/// f = m g. Potential energy -m g.x.
class UniformGravity : public Effect {
 public:
  UniformGravity(const Vector3d& g_W, Members<Nothing> members)
      : g_W_(g_W), members_(std::move(members)) {}

  std::string name() const override { return "gravity"; }
  std::size_t bodyCount() const override { return members_.size(); }
  bool isConservative() const override { return true; }

  void addWrenches(const Instant& now, Wrenches& wrenches) const override {
    const Bodies& bodies = now.bodies();
    if (static_cast<Eigen::Index>(members_.size()) == bodies.count()) {  // all: a column at a time
      for (int k = 0; k < 3; ++k) wrenches.f_W.col(k) += g_W_(k) * bodies.mass;
      return;
    }
    for (const auto& [i, none] : members_) wrenches.f_W.row(i) += bodies.mass(i) * g_W_.transpose();
  }

  double potentialEnergy(const Instant& now) const override {
    double sum = 0;
    for (const auto& [i, none] : members_)
      sum -= now.bodies().mass(i) * now.bodies().p_WBcm.row(i).dot(g_W_);
    return sum;
  }

  std::shared_ptr<const Effect> restrictedTo(const std::vector<Eigen::Index>& some) const override {
    return std::make_shared<UniformGravity>(g_W_, members_.restrictedTo(some));
  }

 private:
  Vector3d g_W_;
  Members<Nothing> members_;
};

}  // namespace

std::shared_ptr<const Effect> uniformGravity(const Vector3d& g_W,
                                             std::vector<Eigen::Index> bodies) {
  std::sort(bodies.begin(), bodies.end());
  Members<Nothing> members;
  for (const Eigen::Index i : bodies) members.add(i, {});
  return std::make_shared<UniformGravity>(g_W, std::move(members));
}

EffectList makeGravity(EffectBlock& block) {
  const Vector3d g_W = block.scene.vector3("acceleration", finite("m/s^2"));
  if (g_W.isZero(0) || block.members.empty()) return {};
  std::vector<Eigen::Index> bodies;
  for (const auto& member : block.members) bodies.push_back(member.body);
  return {uniformGravity(g_W, std::move(bodies))};
}

}  // namespace rigid_body_sim

#include <algorithm>
#include <stdexcept>

#include "effects/makers.hpp"
#include "rigid_body_sim/column_pointers.hpp"
#include "rigid_body_sim/members.hpp"

namespace rigid_body_sim {
namespace {

/// f = m g. Potential energy -m g.x.
class UniformGravity : public Effect {
 public:
  UniformGravity(const Vector3d& g_W, Members<NoData> members)
      : g_W_(g_W), members_(std::move(members)) {}

  std::string name() const override { return "gravity"; }
  std::size_t bodyCount() const override { return members_.size(); }
  bool isSteady() const override { return true; }
  bool isConservative() const override { return true; }

  void addWrenches(const Instant& now, Wrenches& wrenches) const override {
    const auto f_W = pointersTo(wrenches.f_W);
    const double* mass = now.bodies().mass.data();
    const Triple g_W(g_W_);
    members_.forEach([=](Eigen::Index i, NoData) { add(f_W, i, mass[i] * g_W); });
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
  Members<NoData> members_;
};

}  // namespace

std::shared_ptr<const Effect> uniformGravity(const Vector3d& g_W,
                                             std::vector<Eigen::Index> bodies) {
  std::sort(bodies.begin(), bodies.end());
  if (std::adjacent_find(bodies.begin(), bodies.end()) != bodies.end() ||
      (!bodies.empty() && bodies.front() < 0))
    throw std::invalid_argument("gravity: a body is there twice, or has a negative index");
  Members<NoData> members;
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

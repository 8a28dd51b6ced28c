#include <algorithm>

#include "rigid_body_sim/effect.hpp"

namespace rigid_body_sim {
namespace {

class UniformGravity : public Effect {
 public:
  UniformGravity(const Vector3d& g_W, std::vector<Eigen::Index> bodies)
      : g_W_(g_W), bodies_(std::move(bodies)) {}

  std::string name() const override { return "gravity"; }
  std::size_t bodyCount() const override { return bodies_.size(); }

  void addWrenches(const Bodies& bodies, double, Wrenches& wrenches) const override {
    for (const Eigen::Index i : bodies_) wrenches.f_W.row(i) += bodies.mass(i) * g_W_;
  }

  std::shared_ptr<const Effect> restrictedTo(const std::vector<Eigen::Index>& some) const override {
    std::vector<Eigen::Index> acts_on;
    for (std::size_t k = 0; k < some.size(); ++k)
      if (std::find(bodies_.begin(), bodies_.end(), some[k]) != bodies_.end())
        acts_on.push_back(static_cast<Eigen::Index>(k));
    return uniformGravity(g_W_, std::move(acts_on));
  }

 private:
  Vector3d g_W_;
  std::vector<Eigen::Index> bodies_;
};

}  // namespace

std::shared_ptr<const Effect> uniformGravity(const Vector3d& g_W,
                                             std::vector<Eigen::Index> bodies) {
  return std::make_shared<UniformGravity>(g_W, std::move(bodies));
}

}  // namespace rigid_body_sim

#include "effects/alignment.hpp"
#include "effects/makers.hpp"
#include "rigid_body_sim/column_pointers.hpp"
#include "rigid_body_sim/members.hpp"

namespace rigid_body_sim {
namespace {

struct Displaced {
  double mass;        // of the fluid, rho V [kg]
  Vector3d p_BcmQ_B;  // centre of buoyancy Q [m]
};

bool operator==(const Displaced& a, const Displaced& b) {
  return a.mass == b.mass && a.p_BcmQ_B == b.p_BcmQ_B;
}

/// The weight of the displaced fluid upside down, f = -rho V g at the centre of buoyancy Q
/// (Archimedes, On Floating Bodies, I.5-7); potential energy rho V g.p_WQ. The body is wholly
/// under.
class Buoyancy : public Effect {
 public:
  /// @param tilted those of `all` whose centre of buoyancy is not the centre of mass
  Buoyancy(const Vector3d& g_W, Members<Displaced> all, Members<Displaced> tilted)
      : g_W_(g_W), all_(std::move(all)), tilted_(std::move(tilted)) {}

  std::string name() const override { return "buoyancy"; }
  std::size_t bodyCount() const override { return all_.size(); }
  bool isConservative() const override { return true; }

  void addWrenches(const Instant& now, Wrenches& wrenches) const override {
    const auto f_W = pointersTo(wrenches.f_W), t_W = pointersTo(wrenches.t_Bcm_W);
    const Triple g_W(g_W_);
    all_.forEach([=](Eigen::Index i, const Displaced& fluid) { add(f_W, i, -fluid.mass * g_W); });
    if (tilted_.empty()) return;
    const RotationPointers R_WB(now.R_WB());
    tilted_.forEach([=](Eigen::Index i, const Displaced& fluid) {
      const Triple p_BcmQ_W = R_WB.times(i, Triple(fluid.p_BcmQ_B));
      add(t_W, i, -fluid.mass * cross(p_BcmQ_W, g_W));
    });
  }

  double potentialEnergy(const Instant& now) const override {
    double sum = 0;
    for (const auto& [i, fluid] : all_) sum += fluid.mass * now.bodies().p_WBcm.row(i).dot(g_W_);
    for (const auto& [i, fluid] : tilted_)
      sum += fluid.mass * (now.R_WB(i) * fluid.p_BcmQ_B).dot(g_W_);
    return sum;
  }

  Stiffness stiffness(const Instant& now) const override {
    Stiffness stiffest;
    for (const auto& [i, fluid] : tilted_) {
      const double rate =
          alignmentRate(fluid.p_BcmQ_B, fluid.mass * g_W_.norm(), now.bodies().moments(i));
      if (rate > stiffest.oscillation) stiffest = {rate, 0, i};
    }
    return stiffest;
  }

  std::shared_ptr<const Effect> restrictedTo(const std::vector<Eigen::Index>& some) const override {
    return std::make_shared<Buoyancy>(g_W_, all_.restrictedTo(some), tilted_.restrictedTo(some));
  }

 private:
  Vector3d g_W_;
  Members<Displaced> all_, tilted_;
};

/// From the centre of mass to the centre of buoyancy [m], in B.
Vector3d centreOf(const EffectBlock& block, const EffectBlock::Member& member) {
  const BodyFrame frame = block.frameOf(member);
  const Allowed allowed = finite("m");
  if (block.bodies[member.body].is_point_mass) {
    if (!member.block.vector3("center", allowed, Vector3d::Zero()).isZero(0))
      member.block.refuse(
          "center", "body '" + block.nameOf(member) + "' is a point mass, which takes no torque");
    return Vector3d::Zero();
  }
  const Vector3d p_LQ = block.vector3(member, "center", allowed, frame.p_LBcm);
  return frame.q_LB.conjugate() * (p_LQ - frame.p_LBcm);
}

}  // namespace

EffectList makeBuoyancy(EffectBlock& block) {
  const double density = block.scene.number("fluid_density", notNegative("kg/m^3"));
  const Vector3d g_W = block.scene.vector3("acceleration", finite("m/s^2"));
  block.scene.has("center");  // is asked for, also where all have their own
  block.scene.has("volume");
  Members<Displaced> all, tilted;
  for (const auto& member : block.members) {
    const Displaced fluid = {density * block.number(member, "volume", notNegative("m^3"), 0),
                             centreOf(block, member)};
    if (fluid.mass == 0) continue;
    all.add(member.body, fluid);
    if (!fluid.p_BcmQ_B.isZero(0)) tilted.add(member.body, fluid);
  }
  if (all.empty() && !block.members.empty()) block.why_nothing = "no body has a volume";
  if (density == 0) block.why_nothing = "the fluid_density is zero";
  if (g_W.isZero(0)) block.why_nothing = "the acceleration is zero";
  if (all.empty() || g_W.isZero(0)) return {};
  return {std::make_shared<Buoyancy>(g_W, std::move(all), std::move(tilted))};
}

}  // namespace rigid_body_sim

#include "effects/alignment.hpp"
#include "effects/makers.hpp"
#include "rigid_body_sim/column_pointers.hpp"
#include "rigid_body_sim/members.hpp"

namespace rigid_body_sim {
namespace {

/// A dipole m fixed to the body in a uniform field: t = m x B, potential energy -m.B (Jackson,
/// Classical Electrodynamics, 1999, eqs. 5.71 and 5.72). A uniform field does not pull.
class MagneticDipole : public Effect {
 public:
  MagneticDipole(const Vector3d& field_W, Members<Vector3d> members)
      : field_W_(field_W), members_(std::move(members)) {}

  std::string name() const override { return "magnetic_dipole"; }
  std::size_t bodyCount() const override { return members_.size(); }
  bool isConservative() const override { return true; }

  void addWrenches(const Instant& now, Wrenches& wrenches) const override {
    const RotationPointers R_WB(now.R_WB());
    const auto t_W = pointersTo(wrenches.t_Bcm_W);
    const Triple field_W(field_W_);
    members_.forEach([=](Eigen::Index i, const Vector3d& m_B) {
      add(t_W, i, cross(R_WB.times(i, Triple(m_B)), field_W));
    });
  }

  double potentialEnergy(const Instant& now) const override {
    double sum = 0;
    for (const auto& [i, m_B] : members_) sum -= (now.R_WB(i) * m_B).dot(field_W_);
    return sum;
  }

  Stiffness stiffness(const Instant& now) const override {
    Stiffness stiffest;
    for (const auto& [i, m_B] : members_) {
      const double rate = alignmentRate(m_B, field_W_.norm(), now.bodies().moments(i));
      if (rate > stiffest.oscillation) stiffest = {rate, 0, i};
    }
    return stiffest;
  }

  std::shared_ptr<const Effect> restrictedTo(const std::vector<Eigen::Index>& some) const override {
    return std::make_shared<MagneticDipole>(field_W_, members_.restrictedTo(some));
  }

 private:
  Vector3d field_W_;
  Members<Vector3d> members_;  // their dipoles in B [A m^2]
};

}  // namespace

EffectList makeMagneticDipole(EffectBlock& block) {
  const Vector3d field_W = block.scene.vector3("field", finite("T"));
  const Allowed allowed = finite("A m^2");
  block.scene.vector3("dipole", allowed, Vector3d::Zero());  // also where all have their own
  Members<Vector3d> members;
  for (const auto& member : block.members) {
    if (block.bodies[member.body].is_point_mass) {
      if (!member.block.vector3("dipole", allowed, Vector3d::Zero()).isZero(0))
        member.block.refuse(
            "dipole", "body '" + block.nameOf(member) + "' is a point mass, which takes no torque");
      continue;
    }
    const Vector3d m_L = block.vector3(member, "dipole", allowed, Vector3d::Zero());
    if (!m_L.isZero(0)) members.add(member.body, block.frameOf(member).q_LB.conjugate() * m_L);
  }
  if (members.empty() && !block.members.empty())
    block.why_nothing = "no body has a dipole, but for point masses, which take no torque";
  if (field_W.isZero(0)) block.why_nothing = "the field is zero";
  if (members.empty() || field_W.isZero(0)) return {};
  return {std::make_shared<MagneticDipole>(field_W, std::move(members))};
}

}  // namespace rigid_body_sim

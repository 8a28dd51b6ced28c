#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "effects/makers.hpp"
#include "rigid_body_sim/members.hpp"

namespace rigid_body_sim {
namespace {

constexpr double kPi = 3.14159265358979323846;

struct Carried {
  bool is_isotropic;  // v and P are parallel
};

/// The translation of bodies that accelerate ideal fluid with them. Kirchhoff's equations (1870;
/// Lamb, Hydrodynamics, 1932, section 124) about the centre of mass, in world axes: with the mass
/// matrix M = R (m + M_A) R^T
///
///   P' = f,   L' = t - v x P,   v = M^-1 P.
///
/// Momentum and tensor contain the fluid's part. What is left for this effect is that methods drift
/// with P/m, and the moment -v x P of Munk (1924), which turns a body broadside. The drift's way
/// and the flow's cancel but for h v: of a body that is n times lighter than the fluid it carries,
/// positions are rounded n times as coarsely.
///
/// Its flow is that of the energy P.M^-1 P/2 - P.P/2m: P and the attitude do not change, so that it
/// is exact, p += h (v - P/m) and L -= h v x P.
class AddedMassEffect : public Effect {
 public:
  explicit AddedMassEffect(Members<Carried> members) : members_(std::move(members)) {}

  std::string name() const override { return "added_mass"; }
  std::size_t bodyCount() const override { return members_.size(); }
  bool dependsOnVelocity() const override { return true; }
  bool isConservative() const override { return true; }  // the kinetic energy contains it
  bool isSwitchable() const override { return false; }
  bool hasReversibleFlow() const override { return true; }
  bool hasInnermostFlow() const override { return true; }
  bool hasStableFlow() const override { return false; }  // Munk's moment turns nothing: it kicks

  /// Without a moment it commutes with the drift: nothing is split.
  int flowOrder() const override {
    const auto is_isotropic = [](const auto& member) { return member.data.is_isotropic; };
    return std::all_of(members_.begin(), members_.end(), is_isotropic) ? kExact : 2;
  }

  /// The Runge-Kutta methods take v itself from the instant.
  void addWrenches(const Instant& now, Wrenches& wrenches) const override {
    for (const auto& [i, carried] : members_) {
      if (carried.is_isotropic) continue;
      const Vector3d v_WBcm = now.v_WBcm().row(i), P_WB = now.bodies().P_WB.row(i);
      wrenches.t_Bcm_W.row(i) -= v_WBcm.cross(P_WB);
    }
  }

  void beforeDrift(Bodies& bodies, const Instant&, double h) const override {
    flow(bodies, 0.5 * h);
  }
  void afterDrift(Bodies& bodies, const Instant&, double h) const override {
    flow(bodies, 0.5 * h);
  }

  /// A body that moves along its heaviest axis swings about it: Munk's moment is
  /// P^2 (1/M_i - 1/M_j) sin a cos a.
  Stiffness stiffness(const Instant& now) const override {
    Stiffness stiffest;
    const Bodies& bodies = now.bodies();
    for (const auto& [i, carried] : members_) {
      if (carried.is_isotropic) continue;
      const Eigen::Matrix<double, 9, 1> A = bodies.inverse_mass_B.row(i);
      const Vector3d a = Eigen::SelfAdjointEigenSolver<Matrix3d>(
                             Eigen::Map<const Matrix3d>(A.data()), Eigen::EigenvaluesOnly)
                             .eigenvalues();
      const double rate =
          bodies.P_WB.row(i).norm() * std::sqrt((a(2) - a(0)) / bodies.moments(i)(0));
      if (rate > stiffest.oscillation) stiffest = {rate, 0, i};
    }
    return stiffest;
  }

  std::shared_ptr<const Effect> restrictedTo(const std::vector<Eigen::Index>& some) const override {
    return std::make_shared<AddedMassEffect>(members_.restrictedTo(some));
  }

 private:
  static constexpr int kExact = 100;  // above any method's order

  void flow(Bodies& bodies, double h) const {
    for (const auto& [i, carried] : members_) {
      const Vector3d P_WB = bodies.P_WB.row(i), v_WBcm = bodies.v_WBcm(i);
      BodyState body = bodies.state(i);
      move(body, h * (v_WBcm - P_WB / bodies.mass(i)));
      bodies.setState(i, body);
      if (!carried.is_isotropic) bodies.L_WBcm_W.row(i) -= h * v_WBcm.cross(P_WB);
    }
  }

  Members<Carried> members_;
};

/// A sphere carries half of the mass that it displaces, and turns without taking any along (Lamb
/// 1932, section 92).
AddedMass ofSphere(const Parameters& sphere) {
  const double radius = sphere.number("radius", positive("m"));
  const double density = sphere.number("fluid_density", notNegative("kg/m^3"));
  sphere.refuseUnknown();
  AddedMass added;
  added.linear_F.setConstant(2.0 / 3 * kPi * radius * radius * radius * density);
  return added;
}

/// What a body says itself, or else the scene; a sphere instead of numbers, not beside them.
AddedMass addedMassOf(const EffectBlock& block, const EffectBlock::Member& member) {
  for (const Parameters* one : {&block.scene, &member.block}) {
    const bool has_numbers = one->has("linear") | one->has("angular");
    if (one->has("sphere") && has_numbers)
      one->refuse("sphere", "it stands for linear and angular; give one of the two");
  }
  if (member.block.has("sphere")) return ofSphere(member.block.child("sphere"));
  const bool has_own = member.block.has("linear") || member.block.has("angular");
  if (!has_own && block.scene.has("sphere")) return ofSphere(block.scene.child("sphere"));
  return {block.vector3(member, "linear", notNegative("kg"), Vector3d::Zero()),
          block.vector3(member, "angular", notNegative("kg m^2"), Vector3d::Zero())};
}

}  // namespace

EffectList makeAddedMass(EffectBlock& block) {
  Members<Carried> members;
  if (!block.members.empty()) block.why_nothing = "no body has a linear or an angular one";
  for (const auto& member : block.members) {
    const AddedMass added = addedMassOf(block, member);
    if (added.isZero()) continue;
    SceneBody& body = block.bodies[member.body];
    if (body.is_point_mass)
      Parameters({Value::Map()}, "bodies." + body.name)
          .refuse("added_mass",
                  "a point mass has no shape and carries no fluid; say `added_mass: "
                  "false` there");
    body.added_mass_L = added;
    const Vector3d& linear = added.linear_F;
    if (!linear.isZero(0))
      members.add(member.body, {linear == Vector3d::Constant(linear(0))});
    else
      block.why_nothing = "it is all in the tensors";
  }
  if (members.empty()) return {};
  return {std::make_shared<AddedMassEffect>(std::move(members))};
}

}  // namespace rigid_body_sim

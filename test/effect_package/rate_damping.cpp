// The effect `rate_damping`: air that a body flies through damps its rotation,
//
//   M = rho V S / 4 (b^2 Clp p, c^2 Cmq q, b^2 Cnr r),
//
// with the rates p, q, r about the axes of its root link, as in NASA/TM-2015-218675, atmospheric
// case 3. These are the moments rho V^2/2 S (b Clp pb/2V, c Cmq qc/2V, b Cnr rb/2V) of flight
// mechanics; written so, they need no division by V.
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <rigid_body_sim/effect_plugin.hpp>
#include <rigid_body_sim/members.hpp>

namespace {

using namespace rigid_body_sim;

/// Density [kg/m^3] at a height above sea level [m]. US Standard Atmosphere 1976, equations 18, 23,
/// 33a, 33b and 42: the troposphere, and above 11 km an atmosphere of constant temperature.
double standardDensity(double height) {
  constexpr double kRadius = 6356766, kTop = 11000;              // [m]
  constexpr double kT0 = 288.15, kLapse = 0.0065, kP0 = 101325;  // [K], [K/m], [Pa]
  constexpr double kGasConstant = 287.053, kGravity = 9.80665;   // [J/(kg K)], [m/s^2]
  const double H = kRadius * height / (kRadius + height);        // geopotential
  const double T = kT0 - kLapse * std::min(H, kTop);
  const double p = kP0 * std::pow(T / kT0, kGravity / (kGasConstant * kLapse)) *
                   std::exp(-kGravity / (kGasConstant * T) * std::max(H - kTop, 0.0));
  return p / (kGasConstant * T);
}

/// What damps one body: t_B = -rho V D w_B.
struct Damper {
  double air_density;  // [kg/m^3]; negative: that of the standard atmosphere
  Matrix3d D_B;        // [m^4]
  // Of D I^-1 = A diag(decay) A^-1.
  Matrix3d A, A_inverse;
  Vector3d decay;  // [m^2/kg]
};

class RateDamping : public Effect {
 public:
  explicit RateDamping(Members<Damper> members) : members_(std::move(members)) {}

  std::string name() const override { return "rate_damping"; }
  std::size_t bodyCount() const override { return members_.size(); }
  bool dependsOnVelocity() const override { return true; }

  void addWrenches(const Instant& now, Wrenches& wrenches) const override {
    for (const auto& [i, damper] : members_) {
      const Matrix3d R_WB = now.R_WB(i);
      const Vector3d w_WB = now.w_WB().row(i);
      const Vector3d t_B = damper.D_B * (R_WB.transpose() * w_WB);
      wrenches.t_Bcm_W.row(i) -= massFlux(now.bodies(), i, damper) * R_WB * t_B;
    }
  }

  // The flow: while a drift lasts, V and rho are what they are at its ends; then
  // L' = -rho V D I^-1 L is solved by exponentials, which no step makes unstable.
  int flowOrder() const override { return 2; }
  void beforeDrift(Bodies& bodies, const Instant&, double h) const override { damp(bodies, 0.5 * h); }
  void afterDrift(Bodies& bodies, const Instant&, double h) const override { damp(bodies, 0.5 * h); }

  Stiffness stiffness(const Instant& now) const override {
    Stiffness stiffest;
    for (const auto& [i, damper] : members_) {
      const double decay = massFlux(now.bodies(), i, damper) * damper.decay.maxCoeff();
      if (decay > stiffest.decay) stiffest = {0, decay, i};
    }
    return stiffest;
  }

  std::shared_ptr<const Effect> restrictedTo(const std::vector<Eigen::Index>& some) const override {
    return std::make_shared<RateDamping>(members_.restrictedTo(some));
  }

 private:
  /// rho V [kg/(m^2 s)]; the air is at rest in W, and W's z is the height above sea level.
  static double massFlux(const Bodies& bodies, Eigen::Index i, const Damper& damper) {
    const double rho =
        damper.air_density < 0 ? standardDensity(bodies.p_WBcm(i, 2)) : damper.air_density;
    return rho * bodies.v_WBcm(i).norm();
  }

  void damp(Bodies& bodies, double h) const {
    for (const auto& [i, damper] : members_) {
      const Matrix3d R_WB = Quaterniond(Eigen::Vector4d(bodies.q_WB.row(i))).toRotationMatrix();
      const Vector3d L_W = bodies.L_WBcm_W.row(i);
      const Vector3d modes = damper.A_inverse * (R_WB.transpose() * L_W);
      const Eigen::Array3d decay = (-h * massFlux(bodies, i, damper) * damper.decay.array()).exp();
      bodies.L_WBcm_W.row(i) = R_WB * (damper.A * (decay * modes.array()).matrix());
    }
  }

  Members<Damper> members_;
};

Damper damperOf(const EffectBlock& block, const EffectBlock::Member& member) {
  const double area = block.number(member, "reference_area", positive("m^2"));
  const double b = block.number(member, "span", positive("m"));
  const double c = block.number(member, "chord", positive("m"));
  const Vector3d coefficients = block.vector3(
      member, "coefficients", {-std::numeric_limits<double>::infinity(), 0, "no unit"});
  const double air_density = block.number(member, "air_density", notNegative("kg/m^3"), -1);
  const BodyFrame frame = block.frameOf(member);
  const Matrix3d R_BL = frame.q_LB.conjugate().toRotationMatrix();
  const Vector3d D_L = -0.25 * area * coefficients.cwiseProduct(Vector3d(b * b, c * c, b * b));
  const Matrix3d D_B = R_BL * D_L.asDiagonal() * R_BL.transpose();
  // I^-1/2 D I^-1/2 is symmetric and has the eigenvalues of D I^-1: none is negative.
  const Vector3d root = frame.I_BBcm_B.cwiseSqrt();
  const auto inverse_root = root.cwiseInverse().asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Matrix3d> modes(inverse_root * D_B * inverse_root);
  return {air_density, D_B, root.asDiagonal() * modes.eigenvectors(),
          modes.eigenvectors().transpose() * inverse_root, modes.eigenvalues()};
}

EffectList makeRateDamping(EffectBlock& block) {
  Members<Damper> members;
  for (const auto& member : block.members) {
    if (block.bodies[member.body].is_point_mass) continue;  // has no rotation
    const Damper damper = damperOf(block, member);
    if (!damper.D_B.isZero(0) && damper.air_density != 0) members.add(member.body, damper);
  }
  if (members.empty()) return {};
  return {std::make_shared<RateDamping>(std::move(members))};
}

}  // namespace

RIGID_BODY_SIM_EFFECT("rate_damping", BlockLayout::kMap, makeRateDamping)

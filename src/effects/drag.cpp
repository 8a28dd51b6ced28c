#include <algorithm>
#include <optional>

#include "effects/air.hpp"
#include "effects/makers.hpp"
#include "effects/quadratic_decay.hpp"
#include "rigid_body_sim/column_pointers.hpp"
#include "rigid_body_sim/members.hpp"

namespace rigid_body_sim {
namespace {

struct Shape {
  double drag_area;        // drag coefficient times area [m^2]
  double rotational_drag;  // the same for turning [m^5]
};

bool operator==(const Shape& a, const Shape& b) {
  return a.drag_area == b.drag_area && a.rotational_drag == b.rotational_drag;
}

/// The inverse mass matrix of body i in B.
Matrix3d inverseMass(const Bodies& bodies, Eigen::Index i) {
  const Eigen::Matrix<double, 9, 1> A = bodies.inverse_mass_B.row(i);
  return Eigen::Map<const Matrix3d>(A.data());
}

bool isNumber(const Matrix3d& A) {
  return A(0, 0) == A(1, 1) && A(0, 0) == A(2, 2) && (A - A(0, 0) * Matrix3d::Identity()).isZero(0);
}

/// f = -rho/2 CdA |u| u at the centre of mass, with u the velocity through the air, and
/// t = -rho/2 C |w| w. (The drag equation: Rayleigh, Phil. Mag. 2 (1876) 430, has its square law.)
///
/// The flow is this motion by itself for half the step, in the wind and density where the body is:
/// u / (1 + k |u| h) with k = rho CdA / 2m. No step, however long, turns a velocity round.
template <class Air>
class Drag : public Effect {
 public:
  Drag(std::shared_ptr<const Air> air, Members<Shape> members)
      : air_(std::move(air)), members_(std::move(members)) {}

  std::string name() const override { return "drag"; }
  std::size_t bodyCount() const override { return members_.size(); }
  bool dependsOnVelocity() const override { return true; }
  int flowOrder() const override { return 2; }
  double cost() const override { return Air::kCost; }

  void addWrenches(const Instant& now, Wrenches& wrenches) const override {
    const auto air = air_->at(now.time_s());
    for (const auto& [i, shape] : members_) {
      const Vector3d p = now.bodies().p_WBcm.row(i);
      const double half = 0.5 * air.density(p);
      const Vector3d u = now.v_WBcm().row(i).transpose() - air.wind(p);
      wrenches.f_W.row(i) -= half * shape.drag_area * u.norm() * u;
      if (shape.rotational_drag == 0) continue;
      const Vector3d w = now.w_WB().row(i);
      wrenches.t_Bcm_W.row(i) -= half * shape.rotational_drag * w.norm() * w;
    }
  }

  void beforeDrift(Bodies& bodies, const Instant& now, double h) const override {
    brake(bodies, now.time_s(), 0.5 * h);
  }
  void afterDrift(Bodies& bodies, const Instant& now, double h) const override {
    brake(bodies, now.time_s(), 0.5 * h);
  }

  Stiffness stiffness(const Instant& now) const override {
    Stiffness stiffest;
    for (const auto& member : members_) {
      const double rate = decayOf(now, member.body, member.data);
      if (rate > stiffest.decay) stiffest = {0, rate, member.body};
    }
    return stiffest;
  }

  std::shared_ptr<const Effect> restrictedTo(const std::vector<Eigen::Index>& some) const override {
    return std::make_shared<Drag>(air_, members_.restrictedTo(some));
  }

 private:
  void brake(Bodies& bodies, double time_s, double h) const {
    const auto air = air_->at(time_s);
    if (const Shape* shape = members_.commonData();
        shape && shape->rotational_drag == 0 && !bodies.hasAddedMass())
      return brakeAlike(bodies, air, h);
    for (const auto& [i, shape] : members_) {
      const Vector3d p = bodies.p_WBcm.row(i);
      const double c_h = 0.5 * air.density(p) * h;
      if (shape.drag_area > 0) brakeMomentum(bodies, i, air.wind(p), c_h * shape.drag_area);
      if (shape.rotational_drag == 0) continue;
      const Quaterniond q(Eigen::Vector4d(bodies.q_WB.row(i)));
      bodies.L_WBcm_W.row(i) =
          brakedSpin(bodies.L_WBcm_W.row(i), bodies.moments(i), q, c_h * shape.rotational_drag);
    }
  }

  /// Of bodies that differ in nothing but their mass: a loop that becomes SIMD.
  template <class AirNow>
  void brakeAlike(Bodies& bodies, const AirNow& air, double h) const {
    const auto P = pointersTo(bodies.P_WB);
    const auto p = pointersTo(std::as_const(bodies.p_WBcm));
    const double* mass = bodies.mass.data();
    members_.forEach([=, &air](Eigen::Index i, const Shape& shape) {
      const Vector3d p_W = at(p, i).vector();
      const double c_h = 0.5 * air.density(p_W) * h;
      set(P, i, brakedMomentum(at(P, i), mass[i], Triple(air.wind(p_W)), c_h * shape.drag_area));
    });
  }

  static void brakeMomentum(Bodies& bodies, Eigen::Index i, const Vector3d& wind_W, double c_h) {
    const Vector3d P = bodies.P_WB.row(i);
    if (bodies.carries(i)) {
      const Matrix3d A = inverseMass(bodies, i);
      const Quaterniond q(Eigen::Vector4d(bodies.q_WB.row(i)));
      bodies.P_WB.row(i) = isNumber(A) ? brakedMomentum(P, 1 / A(0, 0), wind_W, c_h)
                                       : brakedMomentum(P, A, q, wind_W, c_h);
    } else {
      bodies.P_WB.row(i) = brakedMomentum(P, bodies.mass(i), wind_W, c_h);
    }
  }

  double decayOf(const Instant& now, Eigen::Index i, const Shape& shape) const {
    const Bodies& bodies = now.bodies();
    const auto air = air_->at(now.time_s());
    const Vector3d p = bodies.p_WBcm.row(i);
    const double half = 0.5 * air.density(p);
    const Vector3d u_W = now.v_WBcm().row(i).transpose() - air.wind(p);
    const Matrix3d R = now.R_WB(i);
    const Matrix3d A = bodies.hasAddedMass() ? inverseMass(bodies, i)
                                             : Matrix3d(Matrix3d::Identity() / bodies.mass(i));
    const double linear = fastestDecay(R.transpose() * u_W, A, half * shape.drag_area);
    if (shape.rotational_drag == 0) return linear;
    const Vector3d w_B = R.transpose() * now.w_WB().row(i).transpose();
    const Matrix3d inverse_I = bodies.moments(i).cwiseInverse().asDiagonal();
    return std::max(linear, fastestDecay(w_B, inverse_I, half * shape.rotational_drag));
  }

  std::shared_ptr<const Air> air_;
  Members<Shape> members_;
};

/// Unset: by the atmosphere.
std::optional<double> readDensity(const Parameters& scene) {
  if (!scene.has("atmosphere")) {
    if (!scene.has("air_density"))
      scene.refuseMissing("air_density",
                          "it must be a density [kg/m^3]; or give `atmosphere: us_standard_1976`");
    return scene.number("air_density", notNegative("kg/m^3"));
  }
  if (scene.has("air_density"))
    scene.refuse("air_density", "`atmosphere` has a density of its own: leave one of them out");
  const std::string atmosphere = scene.text("atmosphere");
  if (atmosphere != "us_standard_1976")
    scene.refuse("atmosphere", "'" + atmosphere + "' is not known; there is us_standard_1976");
  return std::nullopt;
}

std::optional<SeaLevel> readSeaLevel(const Parameters& scene, bool is_used) {
  if (!scene.has("sea_level")) return std::nullopt;
  if (!is_used)
    scene.refuse("sea_level",
                 "nothing here depends on altitude: it goes with `atmosphere` or "
                 "with the shear of `wind`");
  const Parameters block = scene.child("sea_level");
  const SeaLevel sea_level = {block.vector3("center", finite("m")),
                              block.number("radius", positive("m"))};
  block.refuseUnknown();
  return sea_level;
}

/// Zero for point masses, which do not turn; but they may not ask for it themselves.
double readRotationalDrag(const EffectBlock& block, const EffectBlock::Member& member) {
  const double drag = block.number(member, "rotational_drag", notNegative("m^5"), 0);
  if (!block.bodies[member.body].is_point_mass) return drag;
  if (drag > 0 && member.block.has("rotational_drag"))
    member.block.refuse("rotational_drag", "a point mass does not turn and takes no torque");
  return 0;
}

Members<Shape> readShapes(const EffectBlock& block) {
  // Also where no body takes them: they may be wrong all the same.
  block.scene.number("drag_area", notNegative("m^2"), 0);
  block.scene.number("rotational_drag", notNegative("m^5"), 0);
  Members<Shape> members;
  for (const auto& member : block.members) {
    const Shape shape = {block.number(member, "drag_area", notNegative("m^2"), 0),
                         readRotationalDrag(block, member)};
    if (shape.drag_area > 0 || shape.rotational_drag > 0) members.add(member.body, shape);
  }
  return members;
}

/// The fluid that bodies carry is at rest in W (Kirchhoff's equations). In a steady uniform stream
/// that is the same where the added mass has no direction, by Galileo; else Munk's moment would
/// turn a body that drifts with the stream, and a stream that changes would have to pull at what
/// the body displaces.
void refuseWindOnAddedMass(const EffectBlock& block, const Wind& wind,
                           const Members<Shape>& members) {
  if (wind.velocity_W.isZero(0) && wind.gusts.areNone()) return;
  const bool changes = wind.shear || !wind.gusts.areNone();
  for (const auto& [i, shape] : members) {
    const Vector3d& carried = block.bodies[i].added_mass_L.linear_F;
    if (shape.drag_area == 0 || carried.isZero(0)) continue;
    if (!changes && carried == Vector3d::Constant(carried(0))) continue;
    block.scene.refuse(
        "wind", "with `added_mass` on body '" + block.bodies[i].name + "', whose fluid is at rest" +
                    (changes ? ": it bears no shear and no gusts"
                             : ": it bears wind only if the three of its `linear` are equal"));
  }
}

}  // namespace

EffectList makeDrag(EffectBlock& block) {
  const std::optional<double> density = readDensity(block.scene);
  Wind wind = readWind(block.scene);
  const auto sea_level = readSeaLevel(block.scene, !density || wind.shear);
  Members<Shape> members = readShapes(block);
  if (members.empty() && !block.members.empty())
    block.why_nothing = "no body has a drag_area or a rotational_drag";
  if (density == 0.0) block.why_nothing = "the air_density is zero";
  if (members.empty() || density == 0.0) return {};
  refuseWindOnAddedMass(block, wind, members);
  if (density && !wind.shear) {
    auto air = std::make_shared<UniformAir>(UniformAir{*density, wind.velocity_W, wind.gusts});
    return {std::make_shared<Drag<UniformAir>>(std::move(air), std::move(members))};
  }
  auto air = std::make_shared<LayeredAir>(LayeredAir{density, {}, std::move(wind), sea_level});
  return {std::make_shared<Drag<LayeredAir>>(std::move(air), std::move(members))};
}

}  // namespace rigid_body_sim

#include <algorithm>
#include <cmath>
#include <sstream>

#include "effects/makers.hpp"
#include "rigid_body_sim/column_pointers.hpp"
#include "rigid_body_sim/members.hpp"

namespace rigid_body_sim {
namespace {

struct CentralField {
  double mu;          // [m^3/s^2]
  double j2_R2;       // J2 times the square of the equatorial radius [m^2]
  Vector3d center_W;  // [m]
  Vector3d pole_W;    // unit
};

/// Where the centre of mass is, seen from the centre of the field: r n.
struct Ray {
  double inverse_r;  // [1/m]
  Vector3d n_W;

  Ray(const CentralField& field, const Bodies& bodies, Eigen::Index i)
      : n_W(bodies.p_WBcm.row(i).transpose() - field.center_W) {
    inverse_r = 1 / n_W.norm();
    n_W *= inverse_r;
  }
};

/// The tensor's deviator, its diagonal in B. From differences, so that it is exactly zero for a
/// sphere: all that gravity sees of a small body beside its mass.
Vector3d deviatorOf(const Vector3d& I) {
  return Vector3d((I(0) - I(1)) + (I(0) - I(2)), (I(1) - I(2)) + (I(1) - I(0)),
                  (I(2) - I(0)) + (I(2) - I(1))) /
         3;
}

/// Gravity of a planet at a fixed place, which does not feel the bodies.
///
/// Point mass and oblateness, with s = n.pole (Vallado, Fundamentals of Astrodynamics and
/// Applications, 2013, chapter 8; its gradient by hand):
///   V = -mu m/r (1 - J2 (Re/r)^2 (3 s^2 - 1)/2),
///   f = -mu m/r^2 (n + 3/2 J2 (Re/r)^2 ((1 - 5 s^2) n + 2 s pole)).
/// Gravity gradient: what a small body of any shape feels beyond a point mass (MacCullagh 1855;
/// Hughes, Spacecraft Attitude Dynamics, 1986, chapter 8), V = -mu/(2 r^3) (tr I - 3 n.I n).
/// With the deviator D = I - (tr I)/3:
///   V = 3 mu/(2 r^3) n.D n,  t = 3 mu/r^3 n x D n,  f = -3 mu/(2 r^4) (2 D n - 5 (n.D n) n).
/// The force is what drains the orbit when the torque feeds the spin: without it energy and angular
/// momentum are not kept. The oblateness' own gradient, J2 (Re/r)^2 times smaller, is left out.
class CentralGravity : public Effect {
 public:
  /// @param extended those of `all` that are not points for it
  CentralGravity(const CentralField& field, Members<NoData> all, Members<NoData> extended)
      : field_(field), all_(std::move(all)), extended_(std::move(extended)) {}

  std::string name() const override { return "central_gravity"; }
  std::size_t bodyCount() const override { return all_.size(); }
  bool isConservative() const override { return true; }

  void addWrenches(const Instant& now, Wrenches& wrenches) const override {
    addPointForces(now.bodies(), wrenches);
    if (field_.j2_R2 != 0) addOblateness(now.bodies(), wrenches);
    if (!extended_.empty()) addGradient(now, wrenches);
  }

  double potentialEnergy(const Instant& now) const override {
    const Bodies& bodies = now.bodies();
    double sum = 0;
    for (const auto& [i, none] : all_) {
      const Ray ray(field_, bodies, i);
      const double s = ray.n_W.dot(field_.pole_W);
      const double oblate = field_.j2_R2 * ray.inverse_r * ray.inverse_r;
      sum -= field_.mu * bodies.mass(i) * ray.inverse_r * (1 - 0.5 * oblate * (3 * s * s - 1));
    }
    for (const auto& [i, none] : extended_) {
      const Ray ray(field_, bodies, i);
      const Vector3d n_B = now.R_WB(i).transpose() * ray.n_W;
      sum += 1.5 * field_.mu * cube(ray.inverse_r) *
             n_B.cwiseAbs2().dot(deviatorOf(bodies.moments(i)));
    }
    return sum;
  }

  Stiffness stiffness(const Instant& now) const override;

  std::shared_ptr<const Effect> restrictedTo(const std::vector<Eigen::Index>& some) const override {
    return std::make_shared<CentralGravity>(field_, all_.restrictedTo(some),
                                            extended_.restrictedTo(some));
  }

 private:
  static double cube(double x) { return x * x * x; }

  void addPointForces(const Bodies& bodies, Wrenches& wrenches) const {
    const auto p_W = pointersTo(bodies.p_WBcm);
    const auto f_W = pointersTo(wrenches.f_W);
    const double* mass = bodies.mass.data();
    const double mu = field_.mu;
    const Triple center_W(field_.center_W);
    all_.forEach([=](Eigen::Index i, NoData) {
      const Triple r_W = at(p_W, i) - center_W;
      const double inverse_r = 1 / std::sqrt(dot(r_W, r_W));
      const double pull = mu * mass[i] * inverse_r * inverse_r;
      add(f_W, i, -pull * (inverse_r * r_W));
    });
  }

  void addOblateness(const Bodies& bodies, Wrenches& wrenches) const {
    for (const auto& [i, none] : all_) {
      const Ray ray(field_, bodies, i);
      const double inverse_r2 = ray.inverse_r * ray.inverse_r;
      const double pull = 1.5 * field_.mu * bodies.mass(i) * field_.j2_R2 * inverse_r2 * inverse_r2;
      const double s = ray.n_W.dot(field_.pole_W);
      wrenches.f_W.row(i) -= pull * ((1 - 5 * s * s) * ray.n_W + 2 * s * field_.pole_W).transpose();
    }
  }

  void addGradient(const Instant& now, Wrenches& wrenches) const {
    for (const auto& [i, none] : extended_) {
      const Ray ray(field_, now.bodies(), i);
      const Matrix3d R_WB = now.R_WB(i);
      const Vector3d n_B = R_WB.transpose() * ray.n_W;
      const Vector3d Dn_B = deviatorOf(now.bodies().moments(i)).cwiseProduct(n_B);
      const double scale = 3 * field_.mu * cube(ray.inverse_r);
      const Vector3d f_W =
          -0.5 * scale * ray.inverse_r * (2 * (R_WB * Dn_B) - 5 * n_B.dot(Dn_B) * ray.n_W);
      wrenches.f_W.row(i) += f_W.transpose();
      wrenches.t_Bcm_W.row(i) += scale * (R_WB * n_B.cross(Dn_B)).transpose();
    }
  }

  CentralField field_;
  Members<NoData> all_, extended_;
};

/// An orbit goes round at sqrt(mu/r^3), and a body swings about the local vertical at up to the
/// root of 3 (I_j - I_k)/I_i times that (Hughes 1986, chapter 9). Judged where the body is now.
///
/// No eigenvalue of the oblateness' own gradient is above 12 mu |J2| Re^2/r^5, which it has at the
/// poles: the potential is mu J2 Re^2/2 (pole.grad)^2 1/r, so that along a unit vector u the
/// gradient is the symmetric form T(pole, pole, u, u), T = mu J2 Re^2/2 grad^4 1/r; such a form is
/// largest with four equal vectors (Banach, Studia Math. 7 (1938) 36), and
/// (u.grad)^4 1/r = 24 P_4(u.n)/r^5, |P_4| <= 1.
Stiffness CentralGravity::stiffness(const Instant& now) const {
  Stiffness stiffest;
  const auto consider = [&](Eigen::Index i, double factor) {
    const double rate =
        std::sqrt(factor * field_.mu * cube(Ray(field_, now.bodies(), i).inverse_r));
    if (std::isfinite(rate) && rate > stiffest.oscillation) stiffest = {rate, 0, i};
  };
  for (const auto& [i, none] : all_) {
    const double inverse_r = Ray(field_, now.bodies(), i).inverse_r;
    consider(i, 1 + 12 * std::abs(field_.j2_R2) * inverse_r * inverse_r);
  }
  for (const auto& [i, none] : extended_) {
    const Vector3d I = now.bodies().moments(i);
    consider(i, 3 * std::max({(I(2) - I(1)) / I(0), (I(2) - I(0)) / I(1), (I(1) - I(0)) / I(2)}));
  }
  return stiffest;
}

bool hasGradient(const EffectBlock& block, const EffectBlock::Member& member) {
  const SceneBody& body = block.bodies[member.body];
  const bool scene_says_it = block.scene.boolean("gravity_gradient", false);
  const bool body_says_it = member.block.has("gravity_gradient");
  if (!(body_says_it ? member.block.boolean("gravity_gradient") : scene_says_it)) return false;
  const Parameters& said = body_says_it ? member.block : block.scene;
  if (body.is_point_mass) {
    if (body_says_it)
      said.refuse("gravity_gradient",
                  "true, but body '" + body.name + "' is a point mass, which takes no torque");
    return false;
  }
  if (!body.added_mass_L.isZero())
    said.refuse("gravity_gradient", "true, but body '" + body.name +
                                        "' has added mass: gravity pulls at its own tensor, which "
                                        "is not the one it moves with; say false for this body");
  const Vector3d I = block.frameOf(member).I_BBcm_B;
  return I(0) != I(2);
}

CentralField readField(const Parameters& scene) {
  CentralField field = {};
  field.mu = scene.number("mu", notNegative("m^3/s^2"));
  field.center_W = scene.vector3("center", finite("m"), Vector3d::Zero());
  const double j2 = scene.number("j2", finite(""), 0);
  if (j2 != 0 || scene.has("equatorial_radius")) {
    const double radius = scene.number("equatorial_radius", positive("m"));
    field.j2_R2 = j2 * radius * radius;
  }
  const Vector3d axis_W = scene.vector3("axis", finite(""), Vector3d::UnitZ());
  if (axis_W.isZero(0))
    scene.refuse("axis", "[0, 0, 0] has no direction; the pole is wanted, of any length but zero");
  field.pole_W = axis_W.stableNormalized();
  return field;
}

/// A body that starts at the centre, or so deep in the planet that the series in Re/r means
/// nothing: where the oblateness, at most 3 |J2| (Re/r)^2 of it, may outweigh the pull itself. Of a
/// real planet's J2 that is nowhere outside; a radius in the wrong unit gets there.
void requireOutside(const CentralField& field, const EffectBlock& block,
                    const EffectBlock::Member& member) {
  const SceneBody& body = block.bodies[member.body];
  const double r = (body.X_WL * body.mass_properties.p_FBcm - field.center_W).norm();
  std::ostringstream where;
  where << "body '" << body.name << "' starts " << r << " m from there";
  if (!std::isfinite(field.mu / (r * r * r)))
    block.scene.refuse("center", where.str() + ", where the pull is not finite");
  const double part = 3 * std::abs(field.j2_R2) / (r * r);
  if (part > 1) {
    where << ", so far inside of equatorial_radius that j2's part is up to " << part
          << " times the pull itself; wrong units?";
    block.scene.refuse("center", where.str());
  }
}

}  // namespace

EffectList makeCentralGravity(EffectBlock& block) {
  const CentralField field = readField(block.scene);
  block.scene.boolean("gravity_gradient", false);
  Members<NoData> all, extended;
  for (const auto& member : block.members) {
    all.add(member.body, {});
    if (hasGradient(block, member)) extended.add(member.body, {});
    if (field.mu > 0) requireOutside(field, block, member);
  }
  if (field.mu == 0 || all.empty()) return {};
  return {std::make_shared<CentralGravity>(field, std::move(all), std::move(extended))};
}

}  // namespace rigid_body_sim

#include <algorithm>

#include "effects/makers.hpp"
#include "rigid_body_sim/column_pointers.hpp"
#include "rigid_body_sim/members.hpp"
#include "rigid_body_sim/rotation.hpp"

namespace rigid_body_sim {
namespace {

struct Turned {
  bool has_rotation;  // is no point mass
};

bool operator==(const Turned& a, const Turned& b) { return a.has_rotation == b.has_rotation; }

Matrix3d tensorInWorld(const Matrix3d& R_WB, const Vector3d& I_BBcm_B) {
  return R_WB * I_BBcm_B.asDiagonal() * R_WB.transpose();
}

/// R - I of the turn by r [rad]: [r] sin(x)/x + [r]^2 (1 - cos x)/x^2 (Rodrigues 1840).
Matrix3d turnLessOne(const Vector3d& r) {
  const double x2 = r.squaredNorm(), half = CosSinc(0.25 * x2).sinc;
  const double a = CosSinc(x2).sinc, b = 0.5 * half * half;
  Matrix3d turn = b * r * r.transpose();
  turn.diagonal().array() -= b * x2;
  turn(0, 1) -= a * r.z();
  turn(1, 0) += a * r.z();
  turn(0, 2) += a * r.y();
  turn(2, 0) -= a * r.y();
  turn(1, 2) -= a * r.x();
  turn(2, 1) += a * r.x();
  return turn;
}

/// The world W turns with a constant angular velocity W_W (Omega) against inertial space, about its
/// origin; states are relative to it: P = m v, L = I w. In W's axes the absolute momenta are
/// P + m Omega x p and L + I Omega; they obey P_a' + Omega x P_a = f, L_a' + Omega x L_a = t. With
/// I' = [w] I - I [w] that gives (Coriolis 1835; Goldstein, Classical Mechanics, 2002, section
/// 4.10, for the force)
///
///   P' = f - 2 m Omega x v - m Omega x (Omega x p),
///   L' = t + I (w x Omega) - w x I Omega - Omega x I w - Omega x I Omega.
///
/// The terms with velocities do no work; the others have the potential -m |Omega x p|^2/2
/// - Omega.I Omega/2.
///
/// The flow goes to the absolute momenta in the inertial frame that coincides with W at that
/// moment, and after the drift to the W that has turned since. So free flight is as exact as the
/// drift, at any step.
class RotatingFrame : public Effect {
 public:
  RotatingFrame(const Vector3d& w_W, Members<Turned> members)
      : w_W_(w_W), members_(std::move(members)) {}

  std::string name() const override { return "rotating_frame"; }
  std::size_t bodyCount() const override { return members_.size(); }
  bool dependsOnVelocity() const override { return true; }
  bool isConservative() const override { return true; }
  bool needsGyroscopicTerm() const override { return true; }
  int flowOrder() const override { return kExact; }
  bool hasReversibleFlow() const override { return true; }
  bool hasTurningFlow() const override { return true; }
  bool hasInnermostFlow() const override { return true; }

  void addWrenches(const Instant& now, Wrenches& wrenches) const override {
    const Bodies& bodies = now.bodies();
    for (const auto& [i, turned] : members_) {
      const Vector3d p = bodies.p_WBcm.row(i), v = now.v_WBcm().row(i);
      wrenches.f_W.row(i) -= bodies.mass(i) * w_W_.cross(2 * v + w_W_.cross(p));
      if (!turned.has_rotation) continue;
      const Matrix3d I_W = tensorInWorld(now.R_WB(i), bodies.moments(i));
      const Vector3d w = now.w_WB().row(i), L = bodies.L_WBcm_W.row(i), I_Omega = I_W * w_W_;
      wrenches.t_Bcm_W.row(i) += I_W * w.cross(w_W_) - w.cross(I_Omega) - w_W_.cross(L + I_Omega);
    }
  }

  double potentialEnergy(const Instant& now) const override {
    const Bodies& bodies = now.bodies();
    double sum = 0;
    for (const auto& [i, turned] : members_) {
      const Vector3d p = bodies.p_WBcm.row(i);
      sum -= 0.5 * bodies.mass(i) * w_W_.cross(p).squaredNorm();
      if (!turned.has_rotation) continue;
      const Vector3d w_B = now.R_WB(i).transpose() * w_W_;
      sum -= 0.5 * w_B.cwiseProduct(w_B).dot(bodies.moments(i));
    }
    return sum;
  }

  void beforeDrift(Bodies& bodies, const Instant& now, double) const override {
    addFrame(bodies, now.R_WB(), 1);
  }

  /// As the turn back leaves Omega as it is, the absolute momenta may lose the frame's before it.
  ///
  /// By R - I, and not by R: the rounding of R is that of one, the same at each step, and adds up.
  /// It made positions 7e-11 of their length wrong in a day at the earth's rate.
  void afterDrift(Bodies& bodies, const Instant& now, double h) const override {
    addFrame(bodies, now.R_WB(), -1);
    const Matrix3d less_one = turnLessOne(-h * w_W_);
    const Triple R0(less_one.row(0)), R1(less_one.row(1)), R2(less_one.row(2));
    const auto way = [=](const Triple& v) { return Triple(dot(R0, v), dot(R1, v), dot(R2, v)); };
    const auto p_W = pointersTo(bodies.p_WBcm), low_W = pointersTo(bodies.p_low),
               P_W = pointersTo(bodies.P_WB), L_W = pointersTo(bodies.L_WBcm_W);
    members_.forEach([=](Eigen::Index i, const Turned&) {
      move(p_W, low_W, i, way(at(p_W, i)));  // what a turn changes of p_low is below rounding
      add(P_W, i, way(at(P_W, i)));
      add(L_W, i, way(at(L_W, i)));
    });
    turnAttitudes(bodies, rotationExp(-h * w_W_));
  }

  Stiffness stiffness(const Instant&) const override { return {2 * w_W_.norm(), 0, 0, true}; }

  std::shared_ptr<const Effect> restrictedTo(const std::vector<Eigen::Index>& some) const override {
    return std::make_shared<RotatingFrame>(w_W_, members_.restrictedTo(some));
  }

 private:
  static constexpr int kExact = 100;  // above any method's order

  void turnAttitudes(Bodies& bodies, const Quaterniond& turn) const {
    double* qx = bodies.q_WB.data();
    const Eigen::Index rows = bodies.count();
    double *qy = qx + rows, *qz = qy + rows, *qw = qz + rows;
    const double x = turn.x(), y = turn.y(), z = turn.z(), w = turn.w();
    members_.forEach([=](Eigen::Index i, const Turned& turned) {
      if (!turned.has_rotation) return;
      const double a = qx[i], b = qy[i], c = qz[i], d = qw[i];
      const double nx = w * a + x * d + y * c - z * b, ny = w * b + y * d + z * a - x * c,
                   nz = w * c + z * d + x * b - y * a, nw = w * d - x * a - y * b - z * c;
      const double scale = 1.5 - 0.5 * (nx * nx + ny * ny + nz * nz + nw * nw);
      qx[i] = scale * nx;
      qy[i] = scale * ny;
      qz[i] = scale * nz;
      qw[i] = scale * nw;
    });
  }

  /// From momenta relative to W to absolute ones, or back.
  void addFrame(Bodies& bodies, const ColumnR& rotations, double sign) const {
    const Triple w_W(Vector3d(sign * w_W_));
    const RotationPointers R_WB(rotations);
    const auto p_W = pointersTo(std::as_const(bodies.p_WBcm)),
               I = pointersTo(std::as_const(bodies.I_BBcm_B));
    const auto P_W = pointersTo(bodies.P_WB), L_W = pointersTo(bodies.L_WBcm_W);
    const double* mass = bodies.mass.data();
    members_.forEach([=](Eigen::Index i, const Turned& turned) {
      add(P_W, i, mass[i] * cross(w_W, at(p_W, i)));
      const Triple w_B = R_WB.transposedTimes(i, w_W);
      const Triple moment = R_WB.times(i, {I.x[i] * w_B.x, I.y[i] * w_B.y, I.z[i] * w_B.z});
      if (turned.has_rotation) add(L_W, i, moment);
    });
  }

  Vector3d w_W_;
  Members<Turned> members_;
};

/// The world turns for all bodies or for none.
void requireAllBodies(const EffectBlock& block) {
  for (std::size_t i = 0; i < block.bodies.size(); ++i) {
    const SceneBody& body = block.bodies[i];
    const auto is_it = [&](const auto& member) {
      return member.body == static_cast<Eigen::Index>(i);
    };
    const Parameters own({Value::Map()}, "bodies." + body.name);
    if (std::none_of(block.members.begin(), block.members.end(), is_it))
      own.refuse("rotating_frame", "false; the world turns for all bodies or for none");
    if (!body.added_mass_L.isZero())
      own.refuse("added_mass", "with `rotating_frame`; the fluid would not turn with the world");
  }
}

}  // namespace

EffectList makeRotatingFrame(EffectBlock& block) {
  const Vector3d w_W = block.scene.vector3("angular_velocity", finite("rad/s"));
  if (w_W.isZero(0)) return {};
  requireAllBodies(block);
  Members<Turned> members;
  for (const auto& member : block.members)
    members.add(member.body, {!block.bodies[member.body].is_point_mass});
  return {std::make_shared<RotatingFrame>(w_W, std::move(members))};
}

}  // namespace rigid_body_sim

// The founding text's own methods (section 7), to the letter: Euler's method on velocities, with
// the quaternion exponential of section 6 for the attitude. They are here as what most engines do,
// and as the yardstick of what the others cost; the tests show where they fail.
#include "integrators/families.hpp"
#include "integrators/kick.hpp"
#include "integrators/ungyroscopic.hpp"
#include "rigid_body_sim/rotation.hpp"
#include "rigid_body_sim/wrench.hpp"

namespace rigid_body_sim {
namespace {

/// Velocities of one body, in world axes.
struct Velocities {
  Vector3d v_WBcm;
  Vector3d w_WB;
};

/// Angular velocity in body axes after the gyroscopic term alone, backwards Euler: one Newton step
/// for I (w' - w) + h w' x I w' = 0 from w' = w (E. Catto, Numerical Methods, GDC 2015).
Vector3d newtonGyroscopic(const Vector3d& w_B, const Vector3d& I, double h) {
  const Vector3d m_B = I.cwiseProduct(w_B);
  const Vector3d residual = h * w_B.cross(m_B);
  // I + h ([w] I - [I w])
  Matrix3d slope;
  slope << I(0), -h * (w_B.z() * I(1) - m_B.z()), h * (w_B.y() * I(2) - m_B.y()),
      h * (w_B.z() * I(0) - m_B.z()), I(1), -h * (w_B.x() * I(2) - m_B.x()),
      -h * (w_B.y() * I(0) - m_B.y()), h * (w_B.x() * I(1) - m_B.x()), I(2);
  return w_B - slope.inverse() * residual;
}

enum class PoseMovesWith { kOldVelocity, kNewVelocity };
enum class Gyration { kNone, kExplicit, kNewton };

/// w_B after h from I w' = t - w x I w, whose last term is the gyroscopic one.
template <Gyration gyration>
Vector3d nextAngularVelocity(const Vector3d& w_B, const Vector3d& t_B, const Vector3d& I,
                             double h) {
  if constexpr (gyration == Gyration::kNone) return w_B + h * t_B.cwiseQuotient(I);
  if constexpr (gyration == Gyration::kNewton)
    return newtonGyroscopic(w_B + h * t_B.cwiseQuotient(I), I, h);
  return w_B + h * (t_B - w_B.cross(Vector3d(I.cwiseProduct(w_B)))).cwiseQuotient(I);
}

template <PoseMovesWith pose_moves_with, Gyration gyration>
class VelocityEuler : public Integrator {
 public:
  explicit VelocityEuler(const IntegratorOptions& options) : ungyroscopic_(options.ungyroscopic) {}

  void step(Bodies& bodies, ActiveEffects& effects, double time_s, double h) override {
    const Wrenches* wrenches =
        effects.hasKicks() ? &effects.evaluateKicks(bodies, time_s, h) : nullptr;
    driftWithFlows(bodies, effects, time_s, h, [&] {
      for (Eigen::Index i = 0; i < bodies.count(); ++i) {
        Wrench applied;
        if (wrenches) applied = {wrenches->f_W.row(i), wrenches->t_Bcm_W.row(i)};
        if (ungyroscopic_.has(i))
          stepBody<Gyration::kNone>(bodies, i, applied, h);
        else
          stepBody<gyration>(bodies, i, applied, h);
      }
    });
  }

 private:
  template <Gyration its_gyration>
  static void stepBody(Bodies& bodies, Eigen::Index i, const Wrench& applied, double h) {
    BodyState body = bodies.state(i);
    const double mass = bodies.mass(i);
    const Vector3d I = bodies.moments(i);

    const Vector3d w_B = angularVelocityInBody(body, I);
    const Vector3d t_B = body.q_WB.conjugate() * applied.t_Q_F;
    const Velocities old = {velocity(body, mass), body.q_WB * w_B};
    const Velocities next = {old.v_WBcm + (h / mass) * applied.f_F,
                             body.q_WB * nextAngularVelocity<its_gyration>(w_B, t_B, I, h)};

    const Velocities& moving = pose_moves_with == PoseMovesWith::kNewVelocity ? next : old;
    move(body, h * moving.v_WBcm);
    body.q_WB = renormalized(rotationExp(h * moving.w_WB) * body.q_WB);
    body.P_WB = mass * next.v_WBcm;
    body.L_WBcm_W = body.q_WB * I.cwiseProduct(body.q_WB.conjugate() * next.w_WB);
    bodies.setState(i, body);
  }

  Ungyroscopic ungyroscopic_;
};

template <PoseMovesWith pose_moves_with, Gyration gyration>
std::unique_ptr<Integrator> make(const IntegratorOptions& options) {
  return std::make_unique<VelocityEuler<pose_moves_with, gyration>>(options);
}

}  // namespace

std::unique_ptr<Integrator> makeExplicitEulerVelocity(const IntegratorOptions& options) {
  return make<PoseMovesWith::kOldVelocity, Gyration::kExplicit>(options);
}

std::unique_ptr<Integrator> makeSemiImplicitVelocity(const IntegratorOptions& options) {
  return make<PoseMovesWith::kNewVelocity, Gyration::kExplicit>(options);
}

std::unique_ptr<Integrator> makeSemiImplicitNewton(const IntegratorOptions& options) {
  return make<PoseMovesWith::kNewVelocity, Gyration::kNewton>(options);
}

}  // namespace rigid_body_sim

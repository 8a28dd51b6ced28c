#include <array>
#include <vector>

#include "integrators/body_momentum.hpp"
#include "integrators/families.hpp"
#include "integrators/ungyroscopic.hpp"

namespace rigid_body_sim {
namespace {

/// What one stage finds out about a body.
struct Stage {
  Vector3d v_WBcm;
  Vector3d f_W;
  Vector3d t_W;
  Vector3d w_B;
  Vector3d m_rate_B;
};

/// Weighted sum of the four stages, 1/6, 1/3, 1/3, 1/6.
template <class Part>
Vector3d mean(const std::array<Stage, 4>& k, Part part) {
  return (1.0 / 6) * (part(k[0]) + 2 * (part(k[1]) + part(k[2])) + part(k[3]));
}

/// The classical method for positions and momenta; for the attitude its Lie group form with two
/// commutators (H. Munthe-Kaas, Appl. Numer. Math. 29 (1999) 115), for q' = q w/2: the body's own
/// rates multiply from the right, so commutators have the other sign.
template <Gyroscopic gyroscopic>
class Rk4 : public Integrator {
 public:
  explicit Rk4(const IntegratorOptions& options) : ungyroscopic_(options.ungyroscopic) {}

  void step(Bodies& bodies, ActiveEffects& effects, double time_s, double h) override {
    stages_.resize(static_cast<std::size_t>(bodies.count()));
    momenta_.resize(stages_.size());
    if (effects.empty()) return stepFree(bodies, h);
    stage_bodies_ = bodies;
    constexpr std::array<double, 4> c = {0, 0.5, 0.5, 1};
    constexpr std::array<double, 4> b = {1.0 / 6, 1.0 / 3, 1.0 / 3, 1.0 / 6};
    for (int s = 0; s < 4; ++s) {
      const Wrenches& wrenches =
          effects.evaluate(s == 0 ? bodies : stage_bodies_, time_s + c[s] * h, b[s] * h);
      const Column3& v_WBcm = effects.instant().v_WBcm();
      for (Eigen::Index i = 0; i < bodies.count(); ++i) {
        if (s == 0) momenta_[i] = bodyMomentum(bodies.state(i));
        stages_[i][s].v_WBcm = v_WBcm.row(i);
        finishStage(bodies, i, s, {wrenches.f_W.row(i), wrenches.t_Bcm_W.row(i)}, h);
        if (s < 3) beginStage(bodies, i, s + 1, h);
      }
    }
    for (Eigen::Index i = 0; i < bodies.count(); ++i) endStep(bodies, i, h);
    effects.stepTaken();
  }

 private:
  static Vector3d bodyMomentum(const BodyState& body) {
    return body.q_WB.conjugate() * body.L_WBcm_W;
  }

  /// Without effects no stage needs an attitude.
  void stepFree(Bodies& bodies, double h) {
    for (Eigen::Index i = 0; i < bodies.count(); ++i) {
      const BodyState body = bodies.state(i);
      if (body.L_WBcm_W.isZero(0)) {
        bodies.p_WBcm.row(i) += (h / bodies.mass(i)) * body.P_WB;
        continue;
      }
      momenta_[i] = bodyMomentum(body);
      std::array<Stage, 4>& k = stages_[i];
      for (int s = 0; s < 4; ++s) {
        k[s].v_WBcm = body.P_WB / bodies.mass(i);
        k[s].f_W = k[s].t_W = Vector3d::Zero();
        setRates(bodies, i, s, Vector3d::Zero(), h);
      }
      endStep(bodies, i, h);
    }
  }

  /// Momentum in body axes at which stage s looks.
  Vector3d stageMomentum(Eigen::Index i, int s, double h) const {
    if (s == 0) return momenta_[i];
    return momenta_[i] + (s == 3 ? h : 0.5 * h) * stages_[i][s - 1].m_rate_B;
  }

  void setRates(const Bodies& bodies, Eigen::Index i, int s, const Vector3d& t_B, double h) {
    Stage& k = stages_[i][s];
    const Vector3d m_B = stageMomentum(i, s, h);
    k.w_B = m_B.cwiseQuotient(bodies.moments(i));
    k.m_rate_B = momentumRate(ungyroscopic_.of(i), m_B, k.w_B, t_B);
  }

  /// The rates of stage s from the wrench at it.
  void finishStage(const Bodies& bodies, Eigen::Index i, int s, const Wrench& wrench, double h) {
    Stage& k = stages_[i][s];
    const ColumnQ& q_WB = s == 0 ? bodies.q_WB : stage_bodies_.q_WB;
    k.f_W = wrench.f_F;
    k.t_W = wrench.t_Q_F;
    setRates(bodies, i, s, Quaterniond(Eigen::Vector4d(q_WB.row(i))).conjugate() * k.t_W, h);
  }

  /// The state at which the effects of stage s are evaluated.
  void beginStage(const Bodies& bodies, Eigen::Index i, int s, double h) {
    const std::array<Stage, 4>& k = stages_[i];
    const double ah = s == 3 ? h : 0.5 * h;
    Vector3d turn = ah * k[s - 1].w_B;
    if (s == 2) turn += (h * h / 8) * k[0].w_B.cross(k[1].w_B);
    BodyState at = bodies.state(i);
    at.p_WBcm += ah * k[s - 1].v_WBcm;
    at.P_WB += ah * k[s - 1].f_W;
    at.q_WB = at.q_WB * rotationExp(turn);
    at.L_WBcm_W = at.q_WB * stageMomentum(i, s, h);
    stage_bodies_.setState(i, at);
  }

  void endStep(Bodies& bodies, Eigen::Index i, double h) const {
    const std::array<Stage, 4>& k = stages_[i];
    BodyState body = bodies.state(i);
    body.p_WBcm += h * mean(k, [](const Stage& s) { return s.v_WBcm; });
    body.P_WB += h * mean(k, [](const Stage& s) { return s.f_W; });
    const Vector3d turn =
        h * mean(k, [](const Stage& s) { return s.w_B; }) + (h * h / 12) * k[0].w_B.cross(k[3].w_B);
    const Vector3d m_B = momenta_[i] + h * mean(k, [](const Stage& s) { return s.m_rate_B; });
    const Vector3d L_W = body.L_WBcm_W + h * mean(k, [](const Stage& s) { return s.t_W; });
    setRotation(ungyroscopic_.of(i), body, body.q_WB * rotationExp(turn), m_B, L_W);
    bodies.setState(i, body);
  }

  Ungyroscopic<gyroscopic> ungyroscopic_;
  Bodies stage_bodies_;
  std::vector<std::array<Stage, 4>> stages_;
  std::vector<Vector3d> momenta_;  // in body axes, at the beginning of the step
};

}  // namespace

std::unique_ptr<Integrator> makeRk4(const IntegratorOptions& options) {
  return makeFor<Rk4>(options);
}

}  // namespace rigid_body_sim

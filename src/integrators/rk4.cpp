#include <limits>

#include "integrators/columns.hpp"
#include "integrators/families.hpp"
#include "integrators/ungyroscopic.hpp"

namespace rigid_body_sim {
namespace {

/// What the weighted sum of the stages' velocities makes of positions, of bodies whose v is not
/// P / m.
class AddedMassPath {
 public:
  void begin(const Bodies& bodies) {
    carry_.clear();
    for (Eigen::Index i = 0; i < bodies.count(); ++i)
      if (bodies.carries(i)) carry_.push_back(i);
    p_start_ = bodies.p_WBcm;
    p_low_start_ = bodies.p_low;
    v_sum_.setZero(bodies.count(), 3);
  }
  void add(const Column3& v_WBcm, double weight) { v_sum_ += weight * v_WBcm; }
  void moveStage(Bodies& stage, const Column3& v_WBcm, double h) const {
    for (const Eigen::Index i : carry_) stage.p_WBcm.row(i) = p_start_.row(i) + h * v_WBcm.row(i);
  }
  void end(Bodies& bodies, double h) const {
    for (const Eigen::Index i : carry_) {
      BodyState body = bodies.state(i);
      body.p_WBcm = p_start_.row(i);
      body.p_low = p_low_start_.row(i);
      move(body, h * v_sum_.row(i).transpose());
      bodies.setState(i, body);
    }
  }

 private:
  std::vector<Eigen::Index> carry_;
  Column3 p_start_, p_low_start_, v_sum_;
};

/// The classical method for positions and momenta; for the attitude its Lie group form with two
/// commutators (H. Munthe-Kaas, Appl. Numer. Math. 29 (1999) 115), for q' = q w/2: the body's own
/// rates multiply from the right, so commutators have the other sign. Momenta in body axes, as said
/// in body_momentum.hpp.
class Rk4 : public Integrator {
 public:
  explicit Rk4(const IntegratorOptions& options) : ungyroscopic_(options.ungyroscopic) {}

  void step(Bodies& bodies, ActiveEffects& effects, double time_s, double h) override {
    if (effects.empty()) return stepSteadily(bodies, nullptr, h);
    if (effects.areSteady() && !bodies.hasAddedMass()) {
      const batch::WrenchColumns wrenches =
          columnsOf(effects.evaluateSteady(bodies, time_s, kStages));
      return stepSteadily(bodies, &wrenches, h);
    }
    const bool with_velocity = effects.needVelocities();
    begin(bodies, with_velocity);
    constexpr double c[] = {0, 0.5, 0.5, 1};
    constexpr double b[] = {1.0 / 6, 1.0 / 3, 1.0 / 3, 1.0 / 6};
    for (int s = 0; s < kStages; ++s) {
      const Wrenches& wrenches =
          effects.evaluate(s == 0 ? bodies : stage_, time_s + c[s] * h, b[s] * h);
      if (bodies.hasAddedMass()) path_.add(effects.instant().v_WBcm(), b[s]);
      endStage(bodies, wrenches, with_velocity, s, h);
      if (bodies.hasAddedMass() && s < kStages - 1)
        path_.moveStage(stage_, effects.instant().v_WBcm(), c[s + 1] * h);
    }
    if (bodies.hasAddedMass()) path_.end(bodies, h);
    effects.stepTaken();
  }

 private:
  void begin(const Bodies& bodies, bool with_velocity) {
    tiles_.resize(bodies.count());
    if (stage_.count() != bodies.count()) stage_ = bodies;
    if (!with_velocity) stage_.L_WBcm_W.setConstant(std::numeric_limits<double>::quiet_NaN());
    stage_.mass = bodies.mass;
    stage_.I_BBcm_B = bodies.I_BBcm_B;
    if (!bodies.hasAddedMass()) return;
    stage_.inverse_mass_B = bodies.inverse_mass_B;
    path_.begin(bodies);
  }

  /// @param wrenches of all stages; null for none
  void stepSteadily(Bodies& bodies, const batch::WrenchColumns* wrenches, double h) const {
    const batch::BodyColumns columns = columnsOf(bodies);
    ungyroscopic_.forRuns(bodies.count(), [&](batch::Range range, Gyroscopic gyroscopic) {
      const auto step = gyroscopic == Gyroscopic::kOn ? kernels_.rk4Steady
                                                      : kernels_.rk4SteadyWithoutGyroscopicTerm;
      step(columns, wrenches, h, range);
    });
  }

  /// From the wrenches at stage s to the next one's state, or to the step's end.
  void endStage(Bodies& bodies, const Wrenches& wrenches, bool with_velocity, int s, double h) {
    const batch::BodyColumns columns = columnsOf(bodies), stages = columnsOf(stage_);
    const auto withTerm = with_velocity ? kernels_.rk4StageWithVelocity : kernels_.rk4Stage;
    ungyroscopic_.forRuns(bodies.count(), [&](batch::Range range, Gyroscopic gyroscopic) {
      const auto stage =
          gyroscopic == Gyroscopic::kOn ? withTerm : kernels_.rk4StageWithoutGyroscopicTerm;
      stage(columns, stages, columnsOf(wrenches), tiles_.data(), s, h, range);
    });
  }

  static constexpr int kStages = 4;

  const batch::Kernels& kernels_ = batch::kernels();
  Ungyroscopic ungyroscopic_;
  Bodies stage_;  // the state at which the effects of a stage are evaluated
  AddedMassPath path_;
  Tiles tiles_{batch::kRk4Numbers};
};

}  // namespace

std::unique_ptr<Integrator> makeRk4(const IntegratorOptions& options) {
  return std::make_unique<Rk4>(options);
}

}  // namespace rigid_body_sim

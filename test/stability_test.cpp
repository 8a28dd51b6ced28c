// The largest steps that integrators bear: what a scene that is too stiff is refused by.
#include <cmath>

#include "integrator_laws.hpp"
#include "rigid_body_sim/conserved.hpp"

namespace rigid_body_sim {
namespace {

/// f = -k x - c P on a body of 1 kg.
class Linear : public Effect {
 public:
  Linear(double stiffness, double damping) : stiffness_(stiffness), damping_(damping) {}
  std::string name() const override { return "linear"; }
  std::size_t bodyCount() const override { return 1; }
  bool dependsOnVelocity() const override { return damping_ != 0; }
  void addWrenches(const Instant& now, Wrenches& wrenches) const override {
    wrenches.f_W -= stiffness_ * now.bodies().p_WBcm + damping_ * now.bodies().P_WB;
  }

 private:
  double stiffness_, damping_;
};

/// Whether x and v stay below a thousand times the start's for so many steps of 1 s.
bool isBounded(const IntegratorRow& row, const Effect& effect) {
  Bodies bodies = bodiesOf(reference::caseNamed("tumbling_stone"));
  bodies.mass.setOnes();
  bodies.L_WBcm_W.setZero();
  bodies.p_WBcm << 1, -0.3, 0.2;
  bodies.P_WB << 0.1, 0.4, -0.2;
  const auto integrator = row.make({});
  ActiveEffects effects;
  effects.add(&effect);
  for (int i = 0; i < 3000; ++i) {
    integrator->step(bodies, effects, i, 1);
    if (!(bodies.p_WBcm.norm() < 1e3 * 1.1 && bodies.P_WB.norm() < 1e3 * 1.1)) return false;
  }
  return true;
}

/// The first limit: by a search, as there may be windows of stability above it, then by bisection
/// to four digits.
template <class Make>
double limit(const IntegratorRow& row, Make make) {
  double low = 0, high = 0.05;
  for (; high < 10 && isBounded(row, make(high)); high += 0.05) low = high;
  while (high - low > 1e-4 * high) {
    const double middle = 0.5 * (low + high);
    (isBounded(row, make(middle)) ? low : high) = middle;
  }
  return low;
}

TEST_P(IntegratorLaws, IsStableUpToTheSwingThatIsStated) {
  if (GetParam().order == 0) return;  // it chooses its steps, see below
  const double measured = limit(GetParam(), [](double swing) { return Linear(swing * swing, 0); });
  RecordProperty("swing", std::to_string(measured));
  EXPECT_LE(GetParam().max_swing, measured + 1e-3);
  // Compositions with steps back have resonances from pi on (the trace of their matrix leaves
  // [-2, 2] by 2e-7), which grow too slowly to show in so few steps.
  if (GetParam().order_under_drag == 0) return;
  // What 3000 steps do not tell: growth below a factor of 1000 in them, that is by 0.0023 a step.
  EXPECT_GE(GetParam().max_swing, measured - 0.05);
}

/// A pendulum: turns the body's third axis along z, at `swing` rad a step where it swings little.
class Needle : public Effect {
 public:
  Needle(double swing, double I) : torque_(swing * swing * I) {}
  std::string name() const override { return "needle"; }
  std::size_t bodyCount() const override { return 1; }
  void addWrenches(const Instant& now, Wrenches& wrenches) const override {
    for (Eigen::Index i = 0; i < now.bodies().count(); ++i)
      wrenches.t_Bcm_W.row(i) +=
          torque_ * Vector3d(now.R_WB(i).col(2)).cross(Vector3d::UnitZ()).transpose();
  }
  double depth() const { return 2 * torque_; }

 private:
  double torque_;
};

/// The most kinetic energy in 20,000 steps, in the depth of the well, of bodies with these moments
/// that are let go at angles up to just below the unstable rest. @param nudge of the momenta at the
/// start, as a part of them
double heat(const IntegratorRow& row, const Vector3d& I, double swing, double nudge = 0) {
  const std::vector<double> angles = {0.1, 0.8, 1.57, 2.3, 2.9, 3.1, 3.14};
  Bodies bodies(static_cast<Eigen::Index>(angles.size()));
  const bool spins = I(0) != I(2);
  for (Eigen::Index i = 0; i < bodies.count(); ++i) {
    bodies.mass(i) = 1;
    bodies.I_BBcm_B.row(i) = I;
    const Vector3d axis = spins ? Vector3d(1, 0.3, 0.1).normalized() : Vector3d(1, 0, 0);
    bodies.setState(
        i, {Vector3d::Zero(), Quaterniond(Eigen::AngleAxisd(angles[i], axis)), Vector3d::Zero(),
            (1 + nudge) * spins * swing * Vector3d(0.02, 0.01, 0.03)});
  }
  const Needle needle(swing, I(0));
  ActiveEffects effects;
  effects.add(&needle);
  const auto integrator = row.make({});
  double most = 0;
  for (int k = 0; k < 20'000; ++k) {
    integrator->step(bodies, effects, k, 1);
    for (Eigen::Index i = 0; k % 10 == 0 && i < bodies.count(); ++i)
      most = std::max(most, kineticEnergy(bodies, i) / needle.depth());
  }
  return most;
}

TEST_P(IntegratorLaws, KeepsSwingsOfAnySizeBoundedUpToTheOneThatIsStated) {
  const IntegratorRow& row = GetParam();
  if (row.order == 0 || row.max_large_swing < 0.1) return;  // the latter are known to grow
  const Vector3d three(1, 1.5, 2.2), ball(1, 1, 1);
  const double round = heat(row, ball, row.max_large_swing);
  RecordProperty("round", std::to_string(round));
  EXPECT_LE(round, 1.1);  // 1 would be right; measured: at most 1.023
  // On velocities the gyroscopic term grows by itself.
  if (row.keeps_angular_momentum || row.name == "rk4" || row.name == "rk8") {
    const double triaxial = heat(row, three, row.max_large_swing);
    RecordProperty("triaxial", std::to_string(triaxial));
    // Measured: at most 1.03, and 1.71 of first order.
    EXPECT_LE(triaxial, row.order == 1 ? 2 : 1.1);
  }
  // And not needlessly small: of a method that loses no energy, with 2.2 times as much some swing
  // has no bound. When it sets out is up to roundings: the hottest of three starts, measured 160
  // and more.
  if (row.keeps_angular_momentum && row.has_drifts) {
    double most = 0;
    for (const double nudge : {0.0, 1e-13, 2e-13})
      most = std::max(most, heat(row, three, 2.2 * row.max_large_swing, nudge));
    EXPECT_GE(most, 10);
  }
}

TEST_P(IntegratorLaws, IsStableUpToTheDecayThatIsStated) {
  if (GetParam().order_under_drag == 0) return;  // refused, or it chooses its steps
  const double measured = limit(GetParam(), [](double decay) { return Linear(0, decay); });
  RecordProperty("decay", std::to_string(measured));
  EXPECT_LE(GetParam().max_decay, measured + 1e-3);
  EXPECT_GE(GetParam().max_decay, measured - 0.05);
}

/// The size of x w and v after ten steps, from 1 and 0.
double sizeAfter(const Effect& effect, double swing) {
  Bodies bodies = bodiesOf(reference::caseNamed("tumbling_stone"));
  bodies.mass.setOnes();
  bodies.L_WBcm_W.setZero();
  bodies.p_WBcm << (swing > 0 ? 1 / swing : 0), 0, 0;
  bodies.P_WB << (swing > 0 ? 0 : 1), 0, 0;
  ActiveEffects effects;
  effects.add(&effect);
  const auto integrator = integratorNamed("adaptive").make({});
  for (int i = 0; i < 10; ++i) integrator->step(bodies, effects, i, 1);
  return std::hypot(swing * bodies.p_WBcm(0, 0), bodies.P_WB(0, 0));
}

TEST(Adaptive, BearsTheSwingAndTheDecayThatAreStatedAndNotMuchMore) {
  const IntegratorRow& row = integratorNamed("adaptive");
  const double swing = row.max_swing, decay = row.max_decay;
  const double kept = sizeAfter(Linear(swing * swing, 0), swing);
  RecordProperty("kept", std::to_string((kept - 1) * 1e12) + "e-12");
  EXPECT_NEAR(kept, 1, 1e-10);  // measured: 2.3e-11
  EXPECT_LE(sizeAfter(Linear(0, decay), 0), 1e-6);
  EXPECT_FALSE(std::abs(sizeAfter(Linear(100 * swing * swing, 0), 10 * swing) - 1) <= 1e-3);
  EXPECT_FALSE(sizeAfter(Linear(0, 1.2 * decay), 0) <= 1);
}

INSTANTIATE_TEST_SUITE_P(Every, IntegratorLaws, testing::ValuesIn(integrators()), nameOfRow);

}  // namespace
}  // namespace rigid_body_sim

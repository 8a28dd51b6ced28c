// Steps put together from the batch kernels, against the integrators for one body and the
// equations of motion.
#include <cmath>

#include "batch_bodies.hpp"
#include "integrator_laws.hpp"

namespace rigid_body_sim::batch {
namespace {

constexpr int kSteps = 50;
constexpr double kStep = 0.02;

/// Wrenches that do not change.
class Held : public Effect {
 public:
  explicit Held(const Pushes& pushes) : pushes_(pushes) {}
  std::string name() const override { return "held"; }
  std::size_t bodyCount() const override { return static_cast<std::size_t>(pushes_.f_W.rows()); }
  void addWrenches(const Instant&, Wrenches& wrenches) const override {
    wrenches.f_W += pushes_.f_W;
    wrenches.t_Bcm_W += pushes_.t_Bcm_W;
  }

 private:
  Pushes pushes_;
};

/// Generic bodies at some rad/s.
Bodies tumblingBodies(Eigen::Index count) {
  Bodies bodies(count);
  Sampler sample(9);
  for (Eigen::Index i = 0; i < count; ++i) {
    bodies.mass(i) = 1.5 + sample.number();
    bodies.I_BBcm_B.row(i) = someMoments(sample, 0);
    const Quaterniond q_WB = sample.attitude();
    bodies.setState(i, {sample.vector(), q_WB, sample.vector(),
                        q_WB * bodies.moments(i).cwiseProduct(2 * sample.vector())});
  }
  return bodies;
}

Bodies byIntegrator(const std::string& name, Bodies bodies, const Pushes* pushes) {
  const auto integrator = integratorNamed(name).make({});
  const Held held(pushes ? *pushes : Pushes(1));
  ActiveEffects effects;
  if (pushes) effects.add(&held);
  for (int i = 0; i < kSteps; ++i) integrator->step(bodies, effects, i * kStep, kStep);
  return bodies;
}

double difference(const Bodies& a, const Bodies& b) {
  double worst = 0;
  for (Eigen::Index i = 0; i < a.count(); ++i)
    worst = std::max(worst, distance(a.state(i), b.state(i)));
  return worst;
}

class BatchSteps : public testing::Test {
 protected:
  const Kernels& k = kernels();
  Bodies bodies = tumblingBodies(19);
  const Bodies start = bodies;
  const Pushes pushes = somePushes(19);
  const BodyColumns columns = columnsOf(bodies);
  const WrenchColumns wrenches = columnsOf(pushes);
  const Range all = {0, 19};
};

// Both sides round differently, a rounding a step in each of some ten components, which the motion
// spreads a little. Measured: 1e-14.
constexpr double kRounding = 1e-13;

TEST_F(BatchSteps, OfSemiImplicitAreThoseOfOneBody) {
  for (int i = 0; i < kSteps; ++i) k.driftAtConstantRate(columns, &wrenches, kStep, all);
  EXPECT_LE(difference(bodies, byIntegrator("semi_implicit", start, &pushes)), kRounding);
}

TEST_F(BatchSteps, OfSplit2AreThoseOfOneBody) {
  for (int i = 0; i < kSteps; ++i) {
    k.kick(columns, wrenches, kStep / 2, all);
    k.driftBySplitting(columns, nullptr, kStep, all);
    k.kick(columns, wrenches, kStep / 2, all);
  }
  EXPECT_LE(difference(bodies, byIntegrator("split2", start, &pushes)), kRounding);
}

TEST_F(BatchSteps, OfRk4AreThoseOfOneBody) {
  Bodies stages(19);
  std::vector<double> tiles(tileSize(19, kRk4Numbers));
  for (int i = 0; i < kSteps; ++i)
    for (int stage = 0; stage < 4; ++stage)
      k.rk4StageWithVelocity(columns, columnsOf(stages), wrenches, tiles.data(), stage, kStep, all);
  EXPECT_LE(difference(bodies, byIntegrator("rk4", start, &pushes)), kRounding);
}

TEST_F(BatchSteps, OfRk4WithoutEffectsAreThoseOfOneBody) {
  for (int i = 0; i < kSteps; ++i) k.rk4Steady(columns, nullptr, kStep, all);
  EXPECT_LE(difference(bodies, byIntegrator("rk4", start, nullptr)), kRounding);
  EXPECT_TRUE(sameBits(bodies.L_WBcm_W, start.L_WBcm_W));
}

TEST_F(BatchSteps, OfExactAreThoseOfOneBody) {
  std::vector<double> tiles(tileSize(19, kSpinNumbers));
  for (int i = 0; i < kSteps; ++i) {
    k.kickSpins(columns, wrenches, tiles.data(), kStep / 2, all);
    k.driftSpins(columns, tiles.data(), kStep, all);
    k.kickSpins(columns, wrenches, tiles.data(), kStep / 2, all);
  }
  EXPECT_LE(difference(bodies, byIntegrator("exact", start, &pushes)), kRounding);
}

TEST_F(BatchSteps, OfPositionsAreThoseOfOneBodyToTheBit) {
  // Ways far below the positions' last bits, and far beyond.
  for (const double size : {1e-14, 1.0, 1e14}) {
    bodies.P_WB = size * start.P_WB;
    Bodies alone = bodies;
    for (int step = 0; step < kSteps; ++step) {
      k.driftPositions(columns, kStep, all);
      for (Eigen::Index i = 0; i < alone.count(); ++i) {
        BodyState body = alone.state(i);
        move(body, (kStep / alone.mass(i)) * body.P_WB);
        alone.setState(i, body);
      }
      // In each: the next way may hide what an earlier one has left wrong.
      ASSERT_TRUE(sameBits(bodies.p_WBcm, alone.p_WBcm)) << size;
      ASSERT_TRUE(sameBits(bodies.p_low, alone.p_low)) << size;
    }
  }
}

TEST_F(BatchSteps, OfExactTakeUpWhatSomebodyElseHasMoved) {
  std::vector<double> tiles(tileSize(19, kSpinNumbers));
  const auto fly = [&](int steps) {
    for (int i = 0; i < steps; ++i) k.driftSpins(columns, tiles.data(), kStep, all);
  };
  fly(10);
  const Bodies later = bodies;
  bodies.q_WB = start.q_WB;
  fly(10);
  EXPECT_TRUE(sameBits(bodies.q_WB, later.q_WB));
}

TEST_F(BatchSteps, OfCoastingStayOnTheOrbit) {
  // Nothing of the attitude's rounding may come back into the motion.
  Bodies few = tumblingBodies(8);
  const Bodies before = few;
  std::vector<double> tiles(tileSize(8, kSpinNumbers));
  constexpr int kMany = 200000;
  for (int i = 0; i < kMany; ++i) k.driftSpins(columnsOf(few), tiles.data(), kStep, {0, 8});
  EXPECT_TRUE(sameBits(few.L_WBcm_W, before.L_WBcm_W));
  const auto energy = [](const Bodies& of, Eigen::Index i) {
    const BodyState state = of.state(i);
    return 0.5 * state.L_WBcm_W.dot(angularVelocity(state, of.moments(i)));
  };
  double worst = 0;
  for (Eigen::Index i = 0; i < 8; ++i)
    worst = std::max(worst, std::abs(energy(few, i) / energy(before, i) - 1));
  RecordProperty("energy", std::to_string(worst / kEps));
  EXPECT_LE(worst, 32 * kEps);
}

}  // namespace
}  // namespace rigid_body_sim::batch

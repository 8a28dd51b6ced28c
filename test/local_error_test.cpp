#include "core/local_error.hpp"

#include <cmath>

#include "accuracy_scenes.hpp"

namespace rigid_body_sim {
namespace {

/// A tick's error as estimated, and in truth.
struct Sample {
  double estimate;
  double truth;
  double rounding;
};

/// Of a body in the next tick of the simulation; the truth is the reference's in long double.
Sample sampleOf(const TrueScene& one, Simulator& simulator, Eigen::Index body,
                const Method& method) {
  const AppliedWrenches none;
  const Bodies before = simulator.bodies();
  const Tick tick = simulator.tick();
  const auto part = partOf({simulator.scene(), before, none, tick}, {body});
  simulator.step();
  const Bodies after = rowsOf(simulator.bodies(), {body});
  const double start_s = static_cast<double>(tick) * 0.02;
  const auto law = [&](reference::Real time_s, const reference::State& state) {
    return one.laws[body](start_s + time_s, state);
  };
  Bodies truth = after;
  truth.setState(
      0,
      reference::fly(before.state(body), before.mass(body), before.moments(body), law, 0.02).end);
  const auto relevant = [&](const Deviation& deviation) {
    return one.is_of_positions ? deviation.position_m : deviation.attitude_rad;
  };
  return {relevant(localError(*part, after, method)), relevant(deviation(truth, after, 0)),
          relevant(roundingOfTick(part->bodies, 0.02))};
}

TEST(LocalError, IsWithinAFactorOfThreeOfTheTruthAndElseRounding) {
  const std::vector<Method> methods = {{"semi_implicit"}, {"split2"}, {"split2", 4}, {"exact"},
                                       {"exact", 8},      {"rk4"},    {"rk4", 3},    {"rk8"},
                                       {"rk8", 2},        {"exact4"}, {"exact4", 2}, {"exact6"},
                                       {"exact6", 3}};
  int above = 0, close = 0, below = 0;
  for (const TrueScene& one : tenScenes(20)) {
    for (const Method& method : methods) {
      Scene scene = one.scene;
      scene.integrator = method.integrator;
      scene.substeps = method.substeps;
      if (!objection(method, scene.effects).empty()) continue;
      if (one.name == "spinner" && integratorNamed(method.integrator).max_turn < 2) continue;
      Simulator simulator(scene);
      for (int k = 0; k < 20; ++k) {
        for (int i = 0; i < 9; ++i) simulator.step();
        const Sample sample = sampleOf(one, simulator, k % simulator.bodies().count(), method);
        if (sample.truth <= sample.rounding) {
          ++below;
          EXPECT_LE(sample.estimate, 2 * sample.rounding) << one.name << " " << toText(method);
        } else {
          ++above;
          close += sample.estimate <= 3 * sample.truth && sample.truth <= 3 * sample.estimate;
        }
      }
    }
  }
  EXPECT_GE(above, 1000);
  EXPECT_GE(below, 200);
  EXPECT_GE(close, 0.95 * above);  // measured: all, and within a factor of 1.1
  RecordProperty("close_percent", std::to_string(100.0 * close / above));
}

TEST(LocalError, OfASpinBeyondItsBoundIsStillFinite) {
  // 20 rad a tick in 64 steps of 0.3 rad.
  const TrueScene fast = forcedScene("fast", bodyOf("top", {1, 2, 2.5}, {300, -800, 500}),
                                     Pendulum{{0.5, -0.3, 0.8}, {0.2, 0.4, 0}});
  Simulator simulator(fast.scene);
  const Sample sample = sampleOf(fast, simulator, 0, {"exact"});
  EXPECT_LE(sample.estimate, 3 * sample.truth);
  EXPECT_GE(sample.estimate, sample.truth / 3);
}

TEST(LocalError, OfRoundingIsTwentyUlpsOfWhatIsRounded) {
  Bodies bodies(1);
  bodies.mass(0) = 2;
  bodies.I_BBcm_B.row(0) << 1, 2, 2.5;
  BodyState state;
  state.p_WBcm << 3, 4, 0;
  bodies.setState(0, state);
  EXPECT_DOUBLE_EQ(roundingOfTick(bodies, 0.1).attitude_rad, 20 * kEps);
  EXPECT_DOUBLE_EQ(roundingOfTick(bodies, 0.1).position_m, 20 * kEps * 5);
  state.P_WB << 0, 0, 40;
  state.L_WBcm_W << 0, 30, 0;
  bodies.setState(0, state);
  EXPECT_DOUBLE_EQ(roundingOfTick(bodies, 0.1).attitude_rad, 20 * kEps * 4);
  EXPECT_DOUBLE_EQ(roundingOfTick(bodies, 0.1).position_m, 20 * kEps * 7);
}

/// Counts how often it is asked.
class Counter : public Effect {
 public:
  std::string name() const override { return "counter"; }
  std::size_t bodyCount() const override { return 1; }
  void addWrenches(const Instant&, Wrenches&) const override { ++count; }
  mutable int count = 0;
};

TEST(LocalError, TakesABoundedNumberOfEvaluations) {
  const auto counter = std::make_shared<Counter>();
  Scene scene = sceneOf(bodyOf("top", {1, 2, 2.5}, {3e6, -8e6, 5e6}), "exact");
  const Simulator simulator(scene);
  Part part = wholeOf({scene, simulator.bodies(), {}, 0});
  part.effects = {counter};
  flyTickTruly(part, {"exact"});
  EXPECT_LE(counter->count, kMostEvaluations);
  EXPECT_GT(counter->count, 0);
}

}  // namespace
}  // namespace rigid_body_sim

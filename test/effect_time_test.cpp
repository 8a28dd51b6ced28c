// Effects are asked at the times that the methods state, and these are the simulation's own.
#include <algorithm>

#include "generic.hpp"

namespace rigid_body_sim {
namespace {

/// Does nothing but write down when it was asked [s].
class Recorder : public Effect {
 public:
  std::string name() const override { return "recorder"; }
  std::size_t bodyCount() const override { return 1; }
  void addWrenches(const Bodies&, double time_s, Wrenches&) const override {
    times.push_back(time_s);
  }

  mutable std::vector<double> times;
};

/// The times an effect is asked at in the step from t to t + h, by the method's formula.
std::vector<double> timesOfStep(const std::string& integrator, double t, double h) {
  if (integrator == "split2" || integrator == "exact") return {t, t + h};
  return {t};
}

TEST(EffectTime, IsTheTickTimesTheStep) {
  for (const IntegratorRow& row : integrators()) {
    for (const std::int64_t step_ns : {20'000'000, 4'100'000, 333}) {
      const auto recorder = std::make_shared<Recorder>();
      Scene scene = sceneOf(genericSceneBody("b"), row.name);
      scene.step_ns = step_ns;
      scene.effects.push_back(recorder);
      Simulator simulator(scene);
      for (int i = 0; i < 1000; ++i) simulator.step();
      const auto per_step = static_cast<std::size_t>(row.evaluations);
      ASSERT_EQ(recorder->times.size(), 1000 * per_step) << row.name;
      for (std::size_t tick = 0; tick < 1000; ++tick) {
        const double t = static_cast<double>(tick * step_ns) / 1e9, h = step_ns / 1e9;
        const std::vector<double> expected = timesOfStep(row.name, t, h);
        for (std::size_t i = 0; i < per_step; ++i) {
          // Product and sum are rounded once each.
          ASSERT_NEAR(recorder->times[tick * per_step + i], expected.at(i), 2 * kEps * (t + h))
              << row.name << " tick " << tick;
        }
      }
    }
  }
}

TEST(EffectTime, GoesOnOverAReset) {
  const auto recorder = std::make_shared<Recorder>();
  Scene scene = sceneOf(genericSceneBody("b"));
  scene.effects.push_back(recorder);
  Simulator simulator(scene);
  for (int i = 0; i < 5; ++i) simulator.step();
  simulator.reset();
  simulator.step();
  const auto at = recorder->times.end() - 2;
  EXPECT_NEAR(at[0], 0.12, kEps);
  EXPECT_NEAR(at[1], 0.14, kEps);
}

}  // namespace
}  // namespace rigid_body_sim

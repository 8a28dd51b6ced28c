// Effects are asked at the times that the methods state, and these are the simulation's own.
#include <algorithm>
#include <cmath>

#include "generic.hpp"

namespace rigid_body_sim {
namespace {

/// Does nothing but write down when it was asked [s].
class Recorder : public Effect {
 public:
  std::string name() const override { return "recorder"; }
  std::size_t bodyCount() const override { return 1; }
  void addWrenches(const Instant& now, Wrenches&) const override { times.push_back(now.time_s()); }

  mutable std::vector<double> times;
};

/// Hairer's table: c of DOP853.
std::vector<double> stagesOfDop853(double t, double h) {
  const double root = std::sqrt(6.0);
  std::vector<double> times;
  for (const double c :
       {0.0, (12 - 2 * root) / 135, (6 - root) / 45, (6 - root) / 30, (6 + root) / 30, 1.0 / 3,
        1.0 / 4, 4.0 / 13, 127.0 / 195, 3.0 / 5, 6.0 / 7, 1.0})
    times.push_back(t + c * h);
  return times;
}

/// A symmetric sequence of drifts, from the first ones of one half: what is missing to a half, or
/// for an odd number to the whole, is in the middle.
std::vector<double> afterDrifts(std::vector<double> drifts, double t, double h) {
  const bool is_odd = drifts.size() == 5;
  double sum = 0;
  for (const double drift : drifts) sum += drift;
  const std::vector<double> first = drifts;
  if (is_odd) {
    drifts.push_back(1 - 2 * sum);
  } else {
    drifts.push_back(0.5 - sum);
    drifts.push_back(0.5 - sum);
  }
  drifts.insert(drifts.end(), first.rbegin(), first.rend());
  std::vector<double> times = {t};
  for (const double drift : drifts) times.push_back(times.back() + drift * h);
  return times;
}

/// The times an effect is asked at in the step from t to t + h, by the method's formula.
std::vector<double> timesOfStep(const std::string& integrator, double t, double h) {
  if (integrator == "split2" || integrator == "exact") return {t, t + h};
  if (integrator == "rk4") return {t, t + h / 2, t + h / 2, t + h};
  if (integrator == "rk8") return stagesOfDop853(t, h);
  if (integrator == "exact4") return afterDrifts({0.245298957184271, 0.604872665711080}, t, h);
  if (integrator == "exact6")
    return afterDrifts({0.123229775946271, 0.290553797799558, -0.127049212625417,
                        -0.246331761062075, 0.357208872795928},
                       t, h);
  return {t};
}

TEST(EffectTime, IsTheTickTimesTheStep) {
  for (const IntegratorRow& row : integrators()) {
    if (row.evaluations == 0) continue;  // as many as it needs
    for (const std::int64_t step_ns : {20'000'000, 4'100'000, 333}) {
      const auto recorder = std::make_shared<Recorder>();
      Scene scene = sceneOf(genericSceneBody("b"), row.name);
      scene.step_ns = step_ns;
      scene.effects.push_back(recorder);
      Simulator simulator(scene);
      recorder->times.clear();  // at the start it was asked once, whether it is finite
      for (int i = 0; i < 1000; ++i) simulator.step();
      const auto per_step = static_cast<std::size_t>(row.evaluations);
      ASSERT_EQ(recorder->times.size(), 1000 * per_step) << row.name;
      for (std::size_t tick = 0; tick < 1000; ++tick) {
        const double t = static_cast<double>(tick * step_ns) / 1e9, h = step_ns / 1e9;
        const std::vector<double> expected = timesOfStep(row.name, t, h);
        for (std::size_t i = 0; i < per_step; ++i) {
          // Product and sums are rounded once each; the compositions' tables have 15 digits.
          ASSERT_NEAR(recorder->times[tick * per_step + i], expected.at(i),
                      (2 + per_step) * kEps * (t + h))
              << row.name << " tick " << tick;
        }
      }
    }
  }
}

TEST(EffectTime, OfSubstepsIsTheirOwn) {
  const auto recorder = std::make_shared<Recorder>();
  Scene scene = sceneOf(genericSceneBody("b"), "rk4");
  scene.substeps = 3;
  scene.effects.push_back(recorder);
  Simulator simulator(scene);
  recorder->times.clear();
  for (int i = 0; i < 2; ++i) simulator.step();
  ASSERT_EQ(recorder->times.size(), 2u * 3 * 4);
  const double h = 0.02 / 3;
  for (std::size_t step = 0; step < 6; ++step) {
    const std::vector<double> expected = timesOfStep("rk4", static_cast<double>(step) * h, h);
    for (std::size_t i = 0; i < 4; ++i)
      EXPECT_NEAR(recorder->times[4 * step + i], expected[i], 8 * kEps * 0.04) << step;
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

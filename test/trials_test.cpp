#include "core/trials.hpp"

#include "accuracy_scenes.hpp"

namespace rigid_body_sim {
namespace {

Part partOf(const TrueScene& one, const Simulator& simulator) {
  return wholeOf({one.scene, simulator.bodies(), {}, 0});
}

TEST(Trials, ExtrapolateErrorsAsTheyGrew) {
  // From half of the minute to the whole of it. Errors grow by starts, so no rule is sharp:
  // measured, 0.59 to 2.1 times what they became.
  for (const TrueScene& one : tenScenes(1)) {
    if (one.scene.effects.empty()) continue;
    const Simulator simulator(one.scene);
    Trials half(partOf(one, simulator), {1500, 1, 2, kInf}),
        whole(partOf(one, simulator), {3000, 1, 1, kInf});
    for (const double budget : {1e-2, 1e-4}) {
      const auto offer = half.choose(one.budget(budget));
      ASSERT_TRUE(offer) << one.name;
      const auto error = [&](const Deviation& deviation) {
        return one.is_of_positions ? deviation.position_m : deviation.attitude_rad;
      };
      const Deviation became = deviation(fly(one.scene, offer->method, 3000, 1),
                                         flyTruly(one.scene, 3000, 1).trajectory);
      EXPECT_GE(error(offer->error), error(became) / 2) << one.name << " " << toText(offer->method);
      EXPECT_LE(error(offer->error), error(became) * 3) << one.name << " " << toText(offer->method);
    }
  }
}

TEST(Trials, EndWithTheirAllowance) {
  const TrueScene one = tenScenes(1)[1];  // forced
  const Simulator simulator(one.scene);
  Trials rich(partOf(one, simulator), {500, 1, 1, 1e9}),
      poor(partOf(one, simulator), {500, 1, 1, 17'000});
  const Budget budget = one.budget(1e-9);
  ASSERT_TRUE(rich.choose(budget));
  EXPECT_FALSE(poor.choose(budget));
  EXPECT_LE(poor.bodySteps(), 17'000);
  EXPECT_GT(rich.bodySteps(), 17'000);
}

TEST(Trials, OfABudgetBelowTheDoubtFindNothingButTheBest) {
  const TrueScene one = tenScenes(1)[1];
  const Simulator simulator(one.scene);
  Trials trials(partOf(one, simulator), {500, 1, 1, 1e9});
  const Budget budget = one.budget(1e-17);
  EXPECT_FALSE(trials.choose(budget));
  const Offer best = trials.best(budget);
  EXPECT_GT(best.cost, 0);
  EXPECT_LE(best.error.attitude_rad, 1e-10);  // some high order's
}

TEST(Trials, LeaveOutWhatDragForbids) {
  const TrueScene one = tenScenes(1)[3];  // drag
  const Simulator simulator(one.scene);
  Trials trials(partOf(one, simulator), {500, 1, 1, 1e9});
  for (const double budget : {1e-2, 1e-4, 1e-6, 1e-8}) {
    const auto offer = trials.choose(one.budget(budget));
    ASSERT_TRUE(offer);
    EXPECT_GT(integratorNamed(offer->method.integrator).order_under_drag, 0);
  }
}

TEST(Trials, ForecastAnAmplificationThatGivesTheErrorBack) {
  const TrueScene one = tenScenes(1)[1];
  const Simulator simulator(one.scene);
  Trials trials(partOf(one, simulator), {3000, 1, 1, 1e9});
  const auto offer = trials.choose(one.budget(1e-4));
  ASSERT_TRUE(offer);
  const Forecast forecast = trials.forecast(*offer);
  EXPECT_GE(forecast.error.attitude_rad, offer->error.attitude_rad);
  EXPECT_GT(forecast.amplification.attitude_rad, 1e-3);  // errors that cancel: less than one
  EXPECT_LT(forecast.amplification.attitude_rad, 1e3);
}

}  // namespace
}  // namespace rigid_body_sim

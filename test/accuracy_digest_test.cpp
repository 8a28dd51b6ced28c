// What accuracy_report concludes from its rows: the front, the cheapest within a tolerance, and
// what a yardstick would take. The rows are made up.
#include <cmath>

#include "generic.hpp"
#include "tools/accuracy_report/digest.hpp"

namespace rigid_body_sim::report {
namespace {

/// A report of made-up rows: rung, substeps, error, cost.
struct Made {
  std::string rung;
  int substeps;
  double error;
  double cost_ns;
};

Report reportOf(const std::vector<Made>& rows, double doubt = 1e-13) {
  Report report;
  report.name = "made_up";
  report.scene = sceneOfCase("sphere");
  report.scene.effects = {uniformGravity({0, 0, 0}, {0})};  // so that rounding is not measured
  report.ticks = 10;
  report.over_s = 0.2;
  report.truth.trajectory = fly(report.scene, {"exact"}, 10, 1);
  report.truth.doubt = {doubt, 0};
  for (const Made& one : rows) {
    report.rows.emplace_back();
    Row& row = report.rows.back();
    row.method = {one.rung, one.substeps};
    row.flight.worst.pose.attitude_rad = row.flight.end.pose.attitude_rad = one.error;
    row.flight.samples.resize(1);
    row.cost = {one.cost_ns, one.cost_ns};
  }
  markFront(report);
  return report;
}

std::vector<bool> frontOf(const Report& report) {
  std::vector<bool> marks;
  for (const Row& row : report.rows) marks.push_back(row.is_on_front);
  return marks;
}

TEST(Front, HoldsWhatNothingCheaperBeats) {
  const Report report = reportOf({{"split2", 1, 1e-3, 100},
                                  {"split2", 4, 1e-4, 400},
                                  {"exact", 1, 1e-4, 300},
                                  {"semi_implicit_velocity", 1, 0.5, 50},
                                  {"semi_implicit_velocity", 4, 0.1, 200}});
  EXPECT_EQ(frontOf(report), (std::vector<bool>{true, false, true, true, false}));
}

TEST(Front, ErrorsBelowTheDoubtAreAllTheSame) {
  const Report report = reportOf({{"split2", 1, 3e-9, 100}, {"exact", 1, 1e-12, 200}}, 1e-8);
  EXPECT_EQ(frontOf(report), (std::vector<bool>{true, false}));
}

TEST(Front, ErrorsThatDifferByLessThanTheDoubtAreTheSameAndTheCheaperWins) {
  const Report noise = reportOf({{"split2", 1, 1.9e-8, 100}, {"exact", 1, 1.1e-8, 200}}, 1e-8);
  EXPECT_EQ(frontOf(noise), (std::vector<bool>{true, false}));
  const Report more = reportOf({{"split2", 1, 3.1e-8, 100}, {"exact", 1, 1.1e-8, 200}}, 1e-8);
  EXPECT_EQ(frontOf(more), (std::vector<bool>{true, true}));
}

TEST(Front, OfThreeThatBeatEachOtherInTurnOneStays) {
  const Report report = reportOf(
      {{"rk4", 1, 2.8e-8, 100}, {"split2", 1, 1.9e-8, 100}, {"exact", 1, 1e-8, 100}}, 1e-8);
  EXPECT_EQ(frontOf(report), (std::vector<bool>{false, false, true}));
}

TEST(Front, OfRowsThatCostTheSameTheFirstIsOnIt) {
  const Report report =
      reportOf({{"exact", 1, 0, 100}, {"exact", 2, 0, 97}, {"split2", 1, 1e-3, 98}});
  EXPECT_EQ(frontOf(report), (std::vector<bool>{true, false, false}));
}

TEST(Front, WhatHasLostTheAttitudeIsNotOnIt) {
  const Report report =
      reportOf({{"explicit_euler_velocity", 1, 3.1, 10}, {"split2", 1, 1e-3, 100}});
  EXPECT_EQ(frontOf(report), (std::vector<bool>{false, true}));
}

TEST(Digest, ExtrapolatesByTheOrder) {
  const Report report = reportOf({{"semi_implicit_velocity", 64, 0.4, 1e3},
                                  {"semi_implicit_velocity", 256, 0.1, 4e3},
                                  {"exact", 1, 0, 200}});
  const auto needed = extrapolate(report, "semi_implicit_velocity", 1e-6, 1e-12);
  ASSERT_TRUE(needed);
  EXPECT_NEAR(needed->substeps, 256e5, 1);
  EXPECT_NEAR(needed->cost_ns, 4e8, 1);
  EXPECT_NEAR(needed->slope, 1, 1e-12);
  EXPECT_NEAR(needed->rounding, 1e-12 * std::sqrt(1e5), 1e-16);
  EXPECT_NEAR(needed->rounding_sum, 1e-7, 1e-13);
  EXPECT_EQ(cheapestWithin(report, 1e-6)->method.integrator, "exact");
  std::string all;
  for (const std::string& sentence : digest(report)) all += sentence + "\n";
  EXPECT_TRUE(
      contains(all, {"1e-06 rad: exact, 200 ns",
                     "semi_implicit_velocity would take 2.6e+07 substeps, 2e+06 times the time",
                     "extrapolated from 0.1 rad at 256"}));
}

TEST(Digest, DoesNotExtrapolateWhatDoesNotFallAsItsOrderSays) {
  const Report report =
      reportOf({{"semi_implicit_velocity", 64, 3.1, 1e3}, {"semi_implicit_velocity", 256, 2, 4e3}});
  EXPECT_FALSE(extrapolate(report, "semi_implicit_velocity", 1e-6, 0));
  EXPECT_TRUE(contains(digest(report).at(0), {"0.01 rad: nothing that was tried gets there"}));
}

TEST(Digest, PositionsAreReportedWhereTheyDifferByMoreThanRounding) {
  Report report = reportOf({{"semi_implicit", 1, 1e-3, 50}, {"exact", 1, 0, 200}});
  EXPECT_FALSE(positionsMatter(report));
  report.rows[0].flight.worst.pose.position_m = 1e-3;
  ASSERT_TRUE(positionsMatter(report));
  std::string all;
  for (const std::string& sentence : digest(report)) all += sentence + "\n";
  EXPECT_TRUE(contains(all, {"Positions: 0.01 m: semi_implicit, 50 ns a body and tick; 0.0001, "
                             "1e-06, 1e-08 m: exact, 200 ns a body and tick."}));
}

TEST(Digest, APositionBudgetIsReportedInAnyCase) {
  Report report = reportOf({{"exact", 1, 0, 200}});
  report.scene.accuracy = Budget{};
  EXPECT_FALSE(positionsMatter(report));
  report.scene.accuracy->position_m = 1e-3;
  EXPECT_TRUE(positionsMatter(report));
}

TEST(Digest, RoundingIsWhatAnotherAttitudeChanges) {
  Plan plan;
  plan.scene = sceneOfCase("tumbling_stone");
  plan.over_s = 2;
  plan.substeps = {1};
  plan.tolerances = {1e-6};
  plan.rungs = {"split2"};
  plan.repeats = 1;
  Report report = make(plan, [](const std::string&, double) {});
  const double rounding = roundingOf(report, {"split2", 64});
  EXPECT_GT(rounding, 1e-16);
  EXPECT_LT(rounding, 1e-11);
  report.scene.effects = {uniformGravity({0, 0, -1}, {0})};
  EXPECT_TRUE(std::isnan(roundingOf(report, {"split2", 64})));
}

}  // namespace
}  // namespace rigid_body_sim::report

#include "node/sim_time.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace rigid_body_sim {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;

ros::Time stampAt(std::int64_t ns) {
  ros::Time stamp;
  return stamp.fromNSec(static_cast<std::uint64_t>(ns));
}

ros::Duration durationOf(std::int64_t ns) {
  ros::Duration duration;
  return duration.fromNSec(ns);
}

struct Row {
  SimTime time;
  std::int64_t slack_ns;  ///< the least of 500 ns and a quarter of a step, by hand
};

// Simulated time from 1 s, a wall clock's, steps that divide a second and that do not, those about
// which the slack becomes a quarter of a step, the shortest.
const std::vector<Row> kRows = {
    {{kSecond, 20'000'000}, 500}, {{1'700'000'000 * kSecond + 123'456'789, 20'000'000}, 500},
    {{kSecond, 3'333'333}, 500},  {{kSecond, 1'000'000'000}, 500},
    {{kSecond, 2'000}, 500},      {{kSecond, 1'996}, 499},
    {{kSecond, 1'000}, 250}};

TEST(SimTime, ATickBeginsAWholeNumberOfStepsAfterTheStart) {
  const SimTime time = {kSecond, 20'000'000};
  EXPECT_EQ(time.at(0), ros::Time(1, 0));
  EXPECT_EQ(time.at(1), ros::Time(1, 20'000'000));
  EXPECT_EQ(time.at(4'320'000), ros::Time(86'401, 0));  // a day; no sum of doubles
}

TEST(SimTime, TheStampOfATickIsThatTick) {
  for (const Row& row : kRows)
    for (const Tick tick : {0, 1, 2, 3, 49, 1000, 4'320'000})
      EXPECT_EQ(row.time.firstTickFrom(row.time.at(tick)), tick) << row.time.step_ns;
}

TEST(SimTime, AStampThatIsOffByTheSlackMeansTheTick) {
  for (const auto& [time, slack_ns] : kRows) {
    const Tick tick = 37;
    const std::int64_t at_ns = time.start_ns + tick * time.step_ns;
    EXPECT_EQ(time.firstTickFrom(stampAt(at_ns + slack_ns)), tick) << time.step_ns;
    EXPECT_EQ(time.firstTickFrom(stampAt(at_ns - slack_ns)), tick) << time.step_ns;
  }
}

TEST(SimTime, AStampLaterThanTheSlackMeansTheNextTick) {
  for (const auto& [time, slack_ns] : kRows) {
    const Tick tick = 37;
    const std::int64_t at_ns = time.start_ns + tick * time.step_ns;
    EXPECT_EQ(time.firstTickFrom(stampAt(at_ns + slack_ns + 1)), tick + 1) << time.step_ns;
    EXPECT_EQ(time.firstTickFrom(stampAt(at_ns + time.step_ns / 2)), tick + 1) << time.step_ns;
  }
}

TEST(SimTime, TheSlackIsHalfAMicrosecondOrAQuarterOfAStep) {
  for (const auto& [time, slack_ns] : kRows) EXPECT_EQ(time.slack(), slack_ns) << time.step_ns;
}

TEST(SimTime, AStampInDecimalSecondsMeansTheTick) {
  // A double holds today's wall time to a quarter of a microsecond.
  for (const std::int64_t start_ns : {kSecond, 1'700'000'000 * kSecond}) {
    const SimTime time = {start_ns, 20'000'000};
    for (Tick tick = 0; tick < 5000; ++tick)
      ASSERT_EQ(time.firstTickFrom(ros::Time(time.at(tick).toSec())), tick);
  }
}

TEST(SimTime, AStampBeforeTheStartMeansTheFirstTick) {
  const SimTime time = {1'000 * kSecond, 20'000'000};
  EXPECT_EQ(time.firstTickFrom(ros::Time(0, 0)), 0);
  EXPECT_EQ(time.firstTickFrom(ros::Time(999, 999'999'999)), 0);
}

TEST(SimTime, TheLastStampThatRosCanHoldMeansATick) {
  const SimTime time = {kSecond, 20'000'000};
  EXPECT_EQ(time.firstTickFrom(ros::Time(std::numeric_limits<std::uint32_t>::max(), 0)),
            (std::int64_t{std::numeric_limits<std::uint32_t>::max()} - 1) * 50);
}

TEST(SimTime, AMultipleOfTheStepIsThatManyTicks) {
  for (const auto& [time, slack_ns] : kRows) {
    for (const Tick ticks : {0, 1, 2, 50, 1999}) {
      const std::int64_t ns = ticks * time.step_ns;
      EXPECT_EQ(time.wholeTicks(durationOf(ns)), ticks) << time.step_ns;
      EXPECT_EQ(time.wholeTicks(durationOf(ns + slack_ns)), ticks) << time.step_ns;
      EXPECT_EQ(time.wholeTicks(durationOf(ns - slack_ns)), ticks) << time.step_ns;
    }
  }
}

TEST(SimTime, ADurationInDecimalSecondsIsItsTicks) {
  const SimTime time = {kSecond, 20'000'000};
  for (Tick ticks = 1; ticks < 5000; ++ticks)
    ASSERT_EQ(time.wholeTicks(ros::Duration(0.02 * static_cast<double>(ticks))), ticks);
}

TEST(SimTime, ADurationOffByMoreThanTheSlackIsNoWholeNumberOfTicks) {
  for (const auto& [time, slack_ns] : kRows) {
    const std::int64_t ns = 3 * time.step_ns;
    EXPECT_EQ(time.wholeTicks(durationOf(ns + slack_ns + 1)), -1) << time.step_ns;
    EXPECT_EQ(time.wholeTicks(durationOf(ns - slack_ns - 1)), -1) << time.step_ns;
    EXPECT_EQ(time.wholeTicks(durationOf(ns + time.step_ns / 2)), -1) << time.step_ns;
  }
}

TEST(SimTime, ANegativeDurationIsNoNumberOfTicks) {
  const SimTime time = {kSecond, 20'000'000};
  for (const std::int64_t ns : {-501, -20'000'000, -40'000'000, -10'000'000})
    EXPECT_EQ(time.wholeTicks(durationOf(ns)), -1) << ns;
  EXPECT_EQ(time.wholeTicks(ros::Duration(std::numeric_limits<std::int32_t>::min(), 0)), -1);
}

}  // namespace
}  // namespace rigid_body_sim

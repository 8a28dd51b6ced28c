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

// Simulated time from 1 s, a wall clock's, steps that divide a second and that do not, the
// shortest.
const std::vector<SimTime> kTimes = {{kSecond, 20'000'000},
                                     {1'700'000'000 * kSecond + 123'456'789, 20'000'000},
                                     {kSecond, 3'333'333},
                                     {kSecond, 1'000'000'000},
                                     {kSecond, 1'000}};

TEST(SimTime, ATickBeginsAWholeNumberOfStepsAfterTheStart) {
  const SimTime time = {kSecond, 20'000'000};
  EXPECT_EQ(time.at(0), ros::Time(1, 0));
  EXPECT_EQ(time.at(1), ros::Time(1, 20'000'000));
  EXPECT_EQ(time.at(4'320'000), ros::Time(86'401, 0));  // a day; no sum of doubles
}

TEST(SimTime, TheStampOfATickIsThatTick) {
  for (const SimTime& time : kTimes)
    for (const Tick tick : {0, 1, 2, 3, 49, 1000, 4'320'000})
      EXPECT_EQ(time.firstTickFrom(time.at(tick)), tick) << time.step_ns;
}

TEST(SimTime, AStampThatIsOffByTheSlackMeansTheTick) {
  for (const SimTime& time : kTimes) {
    const Tick tick = 37;
    const std::int64_t at_ns = time.start_ns + tick * time.step_ns;
    EXPECT_EQ(time.firstTickFrom(stampAt(at_ns + time.slack())), tick) << time.step_ns;
    EXPECT_EQ(time.firstTickFrom(stampAt(at_ns - time.slack())), tick) << time.step_ns;
  }
}

TEST(SimTime, AStampLaterThanTheSlackMeansTheNextTick) {
  for (const SimTime& time : kTimes) {
    const Tick tick = 37;
    const std::int64_t at_ns = time.start_ns + tick * time.step_ns;
    EXPECT_EQ(time.firstTickFrom(stampAt(at_ns + time.slack() + 1)), tick + 1) << time.step_ns;
    EXPECT_EQ(time.firstTickFrom(stampAt(at_ns + time.step_ns / 2)), tick + 1) << time.step_ns;
  }
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
  for (const SimTime& time : kTimes) {
    for (const Tick ticks : {0, 1, 2, 50, 1999}) {
      const std::int64_t ns = ticks * time.step_ns;
      EXPECT_EQ(time.wholeTicks(durationOf(ns)), ticks) << time.step_ns;
      EXPECT_EQ(time.wholeTicks(durationOf(ns + time.slack())), ticks) << time.step_ns;
      EXPECT_EQ(time.wholeTicks(durationOf(ns - time.slack())), ticks) << time.step_ns;
    }
  }
}

TEST(SimTime, ADurationInDecimalSecondsIsItsTicks) {
  const SimTime time = {kSecond, 20'000'000};
  for (Tick ticks = 1; ticks < 5000; ++ticks)
    ASSERT_EQ(time.wholeTicks(ros::Duration(0.02 * static_cast<double>(ticks))), ticks);
}

TEST(SimTime, ADurationOffByMoreThanTheSlackIsNoWholeNumberOfTicks) {
  for (const SimTime& time : kTimes) {
    const std::int64_t ns = 3 * time.step_ns;
    EXPECT_EQ(time.wholeTicks(durationOf(ns + time.slack() + 1)), -1) << time.step_ns;
    EXPECT_EQ(time.wholeTicks(durationOf(ns - time.slack() - 1)), -1) << time.step_ns;
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

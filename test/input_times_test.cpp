// When an input begins to act, and for how long.

#include "input_rules_fixture.hpp"

namespace rigid_body_sim {
namespace {

// ---- Stamps

TEST(InputStamp, OfZeroMeansTheNextTick) {
  const Fixture f;
  EXPECT_EQ(f.rules.held(kAsset, wrenchIn("pod")).start, kNow);
  EXPECT_EQ(f.rules.impulse(kAsset, impulseIn("pod")).start, kNow);
  EXPECT_EQ(f.rules.scheduled(scheduledIn("pod")).start, kNow);
  EXPECT_EQ(f.rules.impulse(impulseAtPoint("pod")).start, kNow);
}

/// Start of an impulse with this stamp; the same for all kinds of input.
Tick startOf(const Fixture& f, const ros::Time& stamp) {
  auto message = impulseIn("pod");
  message.header.stamp = stamp;
  const Tick start = f.rules.impulse(kAsset, message).start;
  auto wrench = wrenchIn("pod");
  wrench.header.stamp = stamp;
  EXPECT_EQ(f.rules.held(kAsset, wrench).start, start);
  auto scheduled = scheduledIn("pod");
  scheduled.start = stamp;
  EXPECT_EQ(f.rules.scheduled(scheduled).start, start);
  auto at_point = impulseAtPoint("pod");
  at_point.start = stamp;
  EXPECT_EQ(f.rules.impulse(at_point).start, start);
  return start;
}

TEST(InputStamp, OfThePastMeansTheNextTickUntilItIsStale) {
  const Fixture f;
  EXPECT_EQ(startOf(f, f.now()), kNow);
  EXPECT_EQ(startOf(f, f.now() - ros::Duration(0.5)), kNow);
  EXPECT_EQ(startOf(f, f.now() - ros::Duration(1)), kNow);
}

TEST(InputStamp, ThatIsStaleIsRefusedWithItsAge) {
  const Fixture f("stale_after_s: 1.5");
  for (const ros::Duration age : {ros::Duration(1, 500'000'001), ros::Duration(3)}) {
    const Refused r = refused([&] { startOf(f, f.now() - age); });
    EXPECT_EQ(r.refusal, Refusal::kStale);
    EXPECT_TRUE(contains(r.what, {"s old", "stale_after_s is 1.5"}));
  }
  EXPECT_EQ(refused([&] { startOf(f, ros::Time(0, 1)); }).refusal, Refusal::kStale);
}

TEST(InputStamp, IsNeverStaleIfThatIsSwitchedOff) {
  const Fixture f("stale_after_s: 0");
  EXPECT_EQ(startOf(f, ros::Time(0, 1)), kNow);
}

TEST(InputStamp, OfTheFutureWaitsForTheFirstTickThatBeginsThen) {
  const Fixture f;
  EXPECT_EQ(startOf(f, f.time.at(kNow + 7)), kNow + 7);
  EXPECT_EQ(startOf(f, f.time.at(kNow + 7) + ros::Duration(0.001)), kNow + 8);
  EXPECT_EQ(startOf(f, ros::Time(f.time.at(kNow + 7).toSec())), kNow + 7);
  EXPECT_EQ(startOf(f, f.now() + ros::Duration(10)), kNow + 500);
}

TEST(InputStamp, MoreThanTenSecondsAheadIsRefused) {
  const Fixture f;
  const Refused r = refused([&] { startOf(f, f.now() + ros::Duration(10, 1)); });
  EXPECT_EQ(r.refusal, Refusal::kTooFarAhead);
  EXPECT_TRUE(contains(r.what, {"ahead of 4.0", "at most 10 s", "clock"}));
}

TEST(InputStamp, OfAnyClockIsRefusedAndNothingWorse) {
  // A wall clock's, the last that ROS can hold, and one with too many nanoseconds.
  ros::Time odd(1, 0);
  odd.sec = 4'294'967'295u;
  odd.nsec = 4'294'967'295u;
  const Fixture from_one_second;
  for (const ros::Time& stamp : {ros::Time(1'700'000'000, 0), ros::Time(4'294'967'295u, 0), odd})
    EXPECT_EQ(refused([&] { startOf(from_one_second, stamp); }).refusal, Refusal::kTooFarAhead);
  const Fixture late("start_time_s: 4.0e+9");
  EXPECT_EQ(refused([&] { startOf(late, ros::Time(1, 0)); }).refusal, Refusal::kStale);
}

TEST(InputStamp, OfTheFutureIsRefusedWhenTenThousandWaitAlready) {
  Fixture f;
  auto message = impulseIn("pod");
  message.header.stamp = f.now() + ros::Duration(5);
  for (int i = 0; i < 10'000; ++i) f.simulator.apply(f.rules.impulse(kAsset, message));
  const Refused r = refused([&] { f.rules.impulse(kAsset, message); });
  EXPECT_EQ(r.refusal, Refusal::kTooManyWaiting);
  EXPECT_TRUE(contains(r.what, {"10000"}));
  message.header.stamp = ros::Time();
  EXPECT_NO_THROW(f.rules.impulse(kAsset, message));
}

TEST(InputStamp, OfZeroIsRefusedWhenTwentyThousandWait) {
  Fixture f;  // as when a sender of impulses goes on while the simulation is paused
  const auto message = impulseIn("pod");
  for (int i = 0; i < 20'000; ++i) f.simulator.apply(f.rules.impulse(kAsset, message));
  EXPECT_EQ(refused([&] { f.rules.impulse(kAsset, message); }).refusal, Refusal::kTooManyWaiting);
  f.simulator.step();
  EXPECT_NO_THROW(f.rules.impulse(kAsset, message));
}

// ---- Durations

TEST(InputDuration, OfAHeldWrenchIsTheTimeout) {
  const std::vector<std::pair<std::string, Tick>> ticks = {
      {"1", 50},
      {"0.02", 1},
      {"0.3", 15},
      {"0.31", 16},
      {"0.019", 1},
      {"1.0e-12", 1},
      {"0", 0},
      // Quotients of doubles that round to just above the whole number: not a tick more.
      {"0.14", 7},
      {"0.28", 14},
      // Half a percent of a step over is over.
      {"0.3001", 16}};
  for (const auto& [timeout, expected] : ticks) {
    const Fixture f("wrench_timeout_s: " + timeout);
    const WrenchInput held = f.rules.held(kAsset, wrenchIn("pod"));
    EXPECT_EQ(held.ticks, expected) << timeout;  // 0: until it is replaced
    EXPECT_TRUE(held.replaces);
  }
}

TEST(InputDuration, OfZeroInAScheduleIsTheTimeoutToo) {
  const Fixture f("wrench_timeout_s: 0.5");
  const WrenchInput input = f.rules.scheduled(scheduledIn("pod"));
  EXPECT_EQ(input.ticks, 25);
  EXPECT_TRUE(input.replaces);
}

TEST(InputDuration, OfWholeStepsActsThatManyTicksAndAdds) {
  const Fixture f;
  BodyWrench message = scheduledIn("pod");
  for (const Tick ticks : {1, 3, 50, 1000}) {
    message.duration = ros::Duration(0.02 * static_cast<double>(ticks));
    const WrenchInput input = f.rules.scheduled(message);
    EXPECT_EQ(input.ticks, ticks);
    EXPECT_FALSE(input.replaces);
  }
}

TEST(InputDuration, IsRefusedUnlessItIsAPositiveNumberOfSteps) {
  const Fixture f;
  BodyWrench message = scheduledIn("pod");
  for (const ros::Duration duration :
       {ros::Duration(0, 1), ros::Duration(0.01), ros::Duration(0.03), ros::Duration(0.0201),
        ros::Duration(-0.02), ros::Duration(-1), ros::Duration(0, -1), ros::Duration(-0.04)}) {
    message.duration = duration;
    const Refused r = refused([&] { f.rules.scheduled(message); });
    EXPECT_EQ(r.refusal, Refusal::kDuration) << duration;
    EXPECT_TRUE(contains(r.what, {"duration", "0.02 s"}));
  }
}

TEST(InputDuration, AtTheEndsOfWhatRosCanHoldIsTakenOrRefused) {
  const Fixture f;
  BodyWrench message = scheduledIn("pod");
  message.duration.sec = std::numeric_limits<std::int32_t>::max();
  EXPECT_EQ(f.rules.scheduled(message).ticks, Tick{2147483647} * 50);
  message.duration.sec = std::numeric_limits<std::int32_t>::min();
  message.duration.nsec = std::numeric_limits<std::int32_t>::min();
  EXPECT_EQ(refused([&] { f.rules.scheduled(message); }).refusal, Refusal::kDuration);
}

TEST(Refusals, AllHaveAText) {
  for (int i = 0; i < kRefusalCount; ++i) EXPECT_STRNE(toText(static_cast<Refusal>(i)), "");
}

}  // namespace
}  // namespace rigid_body_sim

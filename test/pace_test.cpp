#include "node/pace.hpp"

#include <string>

#include "generic.hpp"

namespace rigid_body_sim {
namespace {

constexpr std::int64_t kPeriod = 20'000'000;  // [ns]
constexpr std::int64_t kSecond = 1'000'000'000;

/// The node's loop on a clock of its own.
struct Loop {
  explicit Loop(std::int64_t period_ns) : pace(period_ns) { pace.restart(now_ns); }

  /// One tick: `busy_ns` of work, then the wait, from which the system wakes `late_ns` too late.
  void tick(std::int64_t busy_ns, std::int64_t late_ns = 0) {
    now_ns += busy_ns;
    waited_ns = std::max<std::int64_t>(0, pace.untilDue(now_ns));
    if (waited_ns > 0) now_ns += waited_ns + late_ns;
    pace.tickDone(now_ns);
    ++ticks;
  }

  std::int64_t now_ns = 7 * kSecond + 3;
  Pace pace;
  std::int64_t waited_ns = 0;
  std::int64_t ticks = 0;
};

TEST(Pace, OnTimeEveryTickComesOnePeriodAfterTheLast) {
  Loop loop(kPeriod);
  const std::int64_t start_ns = loop.now_ns;
  for (int tick = 1; tick <= 1000; ++tick) {
    loop.tick(tick * 1000);
    ASSERT_EQ(loop.now_ns, start_ns + tick * kPeriod);
  }
  EXPECT_EQ(loop.pace.overruns(), 0u);
  EXPECT_EQ(loop.pace.rebases(), 0u);
}

TEST(Pace, ATickThatWakesUpLateDoesNotMakeTheNextOneLate) {
  Loop loop(kPeriod);
  const std::int64_t start_ns = loop.now_ns;
  loop.tick(0, kPeriod / 2);
  EXPECT_EQ(loop.now_ns, start_ns + kPeriod + kPeriod / 2);
  loop.tick(0);
  EXPECT_EQ(loop.now_ns, start_ns + 2 * kPeriod);
}

TEST(Pace, LateByOneToFiveTicksCatchesUpWithoutWaiting) {
  for (std::int64_t late = 1; late <= Pace::kCatchUpTicks; ++late) {
    SCOPED_TRACE(late);
    Loop loop(kPeriod);
    const std::int64_t start_ns = loop.now_ns;
    loop.tick((1 + late) * kPeriod + kPeriod / 2);
    for (std::int64_t i = 0; i < late; ++i) {
      loop.tick(0);
      ASSERT_EQ(loop.waited_ns, 0);
    }
    loop.tick(0);
    EXPECT_EQ(loop.waited_ns, kPeriod / 2);
    EXPECT_EQ(loop.now_ns, start_ns + loop.ticks * kPeriod);
    EXPECT_EQ(loop.pace.rebases(), 0u);
  }
}

TEST(Pace, LaterThanFiveTicksGivesUpTheLostTime) {
  Loop loop(kPeriod);
  const std::int64_t stall = (2 + Pace::kCatchUpTicks) * kPeriod + 1;
  loop.tick(stall);
  EXPECT_EQ(loop.pace.rebases(), 1u);
  const std::int64_t rebased_ns = loop.now_ns;
  for (int i = 0; i < 100; ++i) {
    loop.tick(0);
    ASSERT_EQ(loop.now_ns, rebased_ns + i * kPeriod);
  }
  EXPECT_EQ(loop.pace.rebases(), 1u);
}

TEST(Pace, FiveTicksAreTheMostThatIsCaughtUpWith) {
  Loop caught_up(kPeriod), given_up(kPeriod);
  const std::int64_t most = (1 + 1 + Pace::kCatchUpTicks) * kPeriod;
  caught_up.tick(most);
  given_up.tick(most + 1);
  EXPECT_EQ(caught_up.pace.rebases(), 0u);
  EXPECT_EQ(given_up.pace.rebases(), 1u);
}

TEST(Pace, CountsATickAsAnOverrunWhenItIsMoreThanAPeriodLate) {
  Loop loop(kPeriod);
  loop.tick(2 * kPeriod);
  EXPECT_EQ(loop.pace.overruns(), 0u);
  loop.tick(kPeriod + 1);
  EXPECT_EQ(loop.pace.overruns(), 1u);
}

TEST(Pace, TellsOnceHowLateTheLatestTickWas) {
  Loop loop(kPeriod);
  loop.tick(0, 3);
  loop.tick(0, 2'000);
  loop.tick(0, 100);
  EXPECT_EQ(loop.pace.takeLatest(), 2'000);
  EXPECT_EQ(loop.pace.takeLatest(), 0);
  loop.tick(kPeriod + kPeriod / 2);  // 100 ns of it were lost before
  EXPECT_EQ(loop.pace.takeLatest(), kPeriod / 2 + 100);
}

TEST(Pace, RunsSixtySecondsWithoutDrift) {
  // Work of up to one and a half periods and wake-ups up to 2 ms late, at periods that do and that
  // do not divide a minute.
  for (const std::int64_t period_ns : {kPeriod, kPeriod / 3, std::int64_t{7'000'001}}) {
    SCOPED_TRACE(period_ns);
    Sampler sampler(7);
    Loop loop(period_ns);
    const std::int64_t start_ns = loop.now_ns;
    while (loop.now_ns - start_ns < 60 * kSecond) {
      const double busy = sampler.between(0, 1);
      const double late_ns = sampler.between(0, 2e6);
      loop.tick(static_cast<std::int64_t>(1.5 * busy * busy * static_cast<double>(period_ns)),
                static_cast<std::int64_t>(late_ns));
    }
    EXPECT_NEAR(static_cast<double>(loop.ticks), static_cast<double>(60 * kSecond / period_ns), 1);
    EXPECT_EQ(loop.pace.rebases(), 0u);
  }
}

TEST(Pace, TooMuchWorkMakesItSlowerAndSaysSo) {
  Loop loop(kPeriod);
  for (int i = 0; i < 1000; ++i) {
    loop.tick(2 * kPeriod);
    ASSERT_EQ(loop.waited_ns, 0);
  }
  // Behind by one more period a tick, until more than five are given up.
  EXPECT_NEAR(static_cast<double>(loop.pace.rebases()), 1000.0 / 6, 2);
  EXPECT_GE(loop.pace.overruns(), 900u);
}

TEST(Pace, StartingAgainAfterAPauseOwesNothing) {
  Loop loop(kPeriod);
  loop.tick(0);
  loop.now_ns += 3600 * kSecond;
  loop.pace.restart(loop.now_ns);
  const std::int64_t start_ns = loop.now_ns;
  loop.tick(0);
  EXPECT_EQ(loop.now_ns, start_ns + kPeriod);
  EXPECT_EQ(loop.pace.overruns() + loop.pace.rebases(), 0u);
}

TEST(Pace, WithoutAPeriodNeverWaitsAndIsNeverLate) {
  Loop loop(0);
  for (int i = 0; i < 1000; ++i) {
    loop.tick(i * 1000);
    ASSERT_EQ(loop.waited_ns, 0);
  }
  EXPECT_EQ(loop.pace.overruns(), 0u);
  EXPECT_EQ(loop.pace.rebases(), 0u);
  EXPECT_EQ(loop.pace.takeLatest(), 0);
}

}  // namespace
}  // namespace rigid_body_sim

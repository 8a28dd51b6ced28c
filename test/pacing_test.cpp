// How ticks follow the wall clock.

#include <signal.h>

#include <algorithm>
#include <cmath>

#include "probe.hpp"
#include "ros_fixture.hpp"

namespace rigid_body_sim {
namespace {

constexpr char kLost[] = "times that lost time was given up";

/// When the states of a simulator came in.
class Arrivals {
 public:
  explicit Arrivals(const std::string& ns)
      : sim("/" + ns + "/sim"), states(sim, "/" + ns + "/states") {
    states.expect(1);
    states.on_message = [this] { times_s.push_back(ros::SteadyTime::now().toSec()); };
  }

  void forget() {
    times_s.clear();
    states.messages.clear();
  }

  std::uint64_t tick(std::size_t i) const { return states.messages[i].tick; }

  Sim sim;
  Recording<BodyStates> states;
  std::vector<double> times_s;
};

/// Wall time a tick [s]. Messages come late, never early, so the earliest of the first and of the
/// last quarter are compared; the scheduling of this process hardly matters.
double wallTimeOfATick(const Arrivals& arrivals, double nominal_s) {
  const std::size_t count = arrivals.times_s.size(), quarter = count / 4;
  const auto earliest = [&](std::size_t begin) {
    std::size_t best = begin;
    const auto lateness = [&](std::size_t i) {
      return arrivals.times_s[i] - nominal_s * static_cast<double>(arrivals.tick(i));
    };
    for (std::size_t i = begin; i < begin + quarter; ++i)
      if (lateness(i) < lateness(best)) best = i;
    return best;
  };
  const std::size_t first = earliest(0), last = earliest(count - quarter);
  return (arrivals.times_s[last] - arrivals.times_s[first]) /
         static_cast<double>(arrivals.tick(last) - arrivals.tick(first));
}

TEST(Pacing, TicksKeepToTheRealTimeFactorWithinOnePerCent) {
  Arrivals real("real"), half("half");
  real.forget();
  half.forget();
  real.sim.unpause();
  half.sim.unpause();
  need("three seconds", [&] { return real.times_s.size() >= 150 && half.times_s.size() >= 75; });
  real.sim.pause();
  half.sim.pause();
  EXPECT_NEAR(wallTimeOfATick(real, kStep_s), kStep_s, 0.01 * kStep_s);
  EXPECT_NEAR(wallTimeOfATick(half, 2 * kStep_s), 2 * kStep_s, 0.01 * 2 * kStep_s);
}

TEST(Pacing, FactorZeroRunsMuchFasterThanRealTime) {
  Arrivals fast("fast");
  const std::uint64_t first = fast.sim.step().tick;
  const ros::SteadyTime start = ros::SteadyTime::now();
  fast.sim.unpause();
  need("a minute simulated", [&] { return fast.states.messages.back().tick > first + 3000; });
  fast.sim.pause();
  const double wall_s = (ros::SteadyTime::now() - start).toSec();
  const double simulated_s =
      kStep_s * static_cast<double>(fast.states.messages.back().tick - first);
  EXPECT_GT(simulated_s / wall_s, 20);  // measured: 1,200
}

// Stopped for half a second, that is 25 ticks: at most five are caught up without waiting, the lost
// time is given up, no tick is left out, and it is said.
TEST(Pacing, AStalledSimulatorCatchesUpAtMostFiveTicksAndGivesUpTheRest) {
  Arrivals real("real"), half("half");
  real.sim.unpause();
  half.sim.unpause();
  real.states.expect(5);
  const std::uint64_t lost = real.sim.diagnostics().count(kLost);
  const std::size_t before = real.times_s.size(), meanwhile = half.times_s.size();
  const int process = real.sim.api.pid();
  kill(process, SIGSTOP);
  const bool is_over = waitFor([&] { return half.times_s.size() >= meanwhile + 13; });
  kill(process, SIGCONT);
  const double awake_s = ros::SteadyTime::now().toSec();
  ASSERT_TRUE(is_over);

  const Status status =
      real.sim.diagnostics([&](const Status& now) { return now.count(kLost) > lost; });
  EXPECT_EQ(status.count(kLost), lost + 1);
  EXPECT_GE(status.count("overruns"), 1u);
  EXPECT_EQ(status.level, diagnostic_msgs::DiagnosticStatus::WARN);
  need("ticks", [&] { return real.times_s.size() >= before + 20; });
  real.sim.pause();
  half.sim.pause();
  const auto& all = real.states.messages;
  for (std::size_t i = 1; i < all.size(); ++i) EXPECT_EQ(all[i].tick, all[i - 1].tick + 1);
  const auto soon =
      std::count_if(real.times_s.begin() + static_cast<std::ptrdiff_t>(before), real.times_s.end(),
                    [&](double time_s) { return time_s < awake_s + 1.5 * kStep_s; });
  EXPECT_LE(soon, 9) << "one before the stop, one on its way, five more, two in time";
}

TEST(Pacing, DiagnosticsWarnWhenTheFactorIsOutOfReach) {
  Sim hopeless("/hopeless/sim");
  hopeless.unpause();
  const Status status = hopeless.diagnostics(
      [](const Status& now) { return now.level == diagnostic_msgs::DiagnosticStatus::WARN; });
  hopeless.pause();
  EXPECT_NE(status.message.find("slower than the real-time factor"), std::string::npos)
      << status.message;
  EXPECT_GT(std::stod(status.values.at("real-time factor")), 1);
  EXPECT_EQ(status.values.at("real-time factor wanted"), "1e+06");
}

}  // namespace
}  // namespace rigid_body_sim

int main(int argc, char** argv) { return rigid_body_sim::runRostest(argc, argv, "pacing_test"); }

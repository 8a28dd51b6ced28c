// When pushes act, over real topics: stamps, durations, expiry. All forces are in world axes, so
// that momentum is their integral to the last bits whatever the body does.

#include <rosgraph_msgs/Log.h>

#include "probe_inputs.hpp"

namespace rigid_body_sim {
namespace {

const Vector3d kForce(2.1, -1.4, 0.9);
const Vector3d kTorque(-0.3, 0.5, 0.2);
const Momentum kPush = {kForce, kTorque};
constexpr int kTimeoutTicks = 50;  // wrench_timeout_s is 1 s

class Schedule : public PushTest {
 protected:
  void SetUp() override {
    PushTest::SetUp();
    now_ = sim.step(100).header.stamp;  // late enough for stamps in the past
  }

  ros::Time after(double ticks) const { return now_ + ros::Duration(ticks * kStep_s); }

  /// The momentum of the probe is the initial one and `factor` times force and torque.
  void expectGiven(const BodyStates& states, double factor) {
    expectMomentum(momentumOf(body, states), momentumAtStart(body) + factor * kPush);
  }

  /// Steps 30 ticks; the first after which the impulse has acted, counted from zero; -1: none.
  int tickOfImpulse() {
    int found = -1;
    for (int k = 0; k < 30; ++k) {
      const BodyStates states = sim.step();
      const double given = (momentumOf(body, states).P_WB - momentumAtStart(body).P_WB).norm();
      if (found < 0 && given > 0.5 * kForce.norm()) found = k;
      expectGiven(states, found < 0 ? 0 : 1);
    }
    return found;
  }

  static BodyWrench entry(int ticks, double factor = 1, const ros::Time& start = {}) {
    BodyWrench one =
        bodyWrench("probe", "world", factor * kForce, factor * kTorque, ticks * kStep_s);
    one.start = start;
    return one;
  }

  ros::Time now_;
};

TEST_F(Schedule, WithoutAStampAnImpulseActsInTheNextTick) {
  impulse.send(impulseIn("world", kForce, kTorque));
  EXPECT_EQ(tickOfImpulse(), 0);
}

TEST_F(Schedule, WithAStampOfNowOrThePastItActsInTheNextTick) {
  for (const double ago : {0.0, 0.5, 1.0, 17.0, 50.0}) {
    SCOPED_TRACE(ago);
    sim.reset();
    now_ = sim.step(100).header.stamp;
    impulse.send(impulseIn("world", kForce, kTorque, after(-ago)));
    EXPECT_EQ(tickOfImpulse(), 0);
  }
}

TEST_F(Schedule, WithAStampInTheFutureItWaitsForExactlyThatTick) {
  for (const int ahead : {1, 2, 13, 29}) {
    SCOPED_TRACE(ahead);
    sim.reset();
    now_ = sim.step(100).header.stamp;
    impulse.send(impulseIn("world", kForce, kTorque, after(ahead)));
    EXPECT_EQ(tickOfImpulse(), ahead);
  }
}

// Clients make stamps of decimal seconds, and truncate: a few nanoseconds must not cost a tick.
TEST_F(Schedule, BetweenTicksItWaitsForTheNextButRoundingOfStampsIsForgiven) {
  const std::vector<std::pair<double, int>> table = {
      {4.5, 5}, {4.001, 5}, {4.999, 5}, {5 - 5e-6, 5}, {5 + 5e-6, 5}};
  for (const auto& row : table) {
    SCOPED_TRACE(row.first);
    sim.reset();
    now_ = sim.step(100).header.stamp;
    sendImpulses([&] {
      BodyImpulse one = bodyImpulse("probe", "world", kForce, kTorque);
      one.start = after(row.first);
      return one;
    }());
    EXPECT_EQ(tickOfImpulse(), row.second);
  }
}

TEST_F(Schedule, TenSecondsAheadIsStillTaken) {
  impulse.send(impulseIn("world", kForce, kTorque, now_ + ros::Duration(10)));
  expectGiven(sim.step(500), 0);
  expectGiven(sim.step(), 1);
}

TEST_F(Schedule, ADurationOfNTicksGivesForceTimesNTicks) {
  for (const int ticks : {1, 2, 7, 49, 51, 333}) {
    SCOPED_TRACE(ticks);
    sim.reset();
    sendWrenches(entry(ticks));
    for (int k = 1; k < ticks && k < 5; ++k) expectGiven(sim.step(), k * kStep_s);
    if (ticks > 5) sim.step(static_cast<std::uint32_t>(ticks - 5));
    expectGiven(sim.step(), ticks * kStep_s);
    expectGiven(sim.step(), ticks * kStep_s);
    expectGiven(sim.step(100), ticks * kStep_s);
  }
}

TEST_F(Schedule, ADurationWithAStartGivesTheSameFromThere) {
  for (const double ahead : {0.0, 1.0, 3.5, 20.0}) {
    SCOPED_TRACE(ahead);
    sim.reset();
    now_ = sim.step().header.stamp;
    sendWrenches(entry(11, 1, after(ahead)));
    const auto begin = static_cast<std::uint32_t>(std::ceil(ahead));
    if (begin > 0) expectGiven(sim.step(begin), 0);
    expectGiven(sim.step(10), 10 * kStep_s);
    expectGiven(sim.step(), 11 * kStep_s);
    expectGiven(sim.step(40), 11 * kStep_s);
  }
}

TEST_F(Schedule, AStartInThePastDoesNotShortenTheDuration) {
  sendWrenches(entry(11, 1, after(-20)));
  expectGiven(sim.step(60), 11 * kStep_s);
}

TEST_F(Schedule, EntriesOfOneMessageAndOfSeveralAdd) {
  sendWrenches(entry(3), entry(5, 10), entry(2, 100, after(1)));
  sendWrenches(entry(3, 1000));
  const double wanted[] = {1011, 2122, 3233, 3243, 3253, 3253};
  for (const double factor : wanted) expectGiven(sim.step(), factor * kStep_s);
}

TEST_F(Schedule, EachEntryActsOnItsOwnBody) {
  BodyWrench other = entry(4, 3);
  other.body = "puck";
  sendWrenches(entry(2), other);
  const BodyStates states = sim.step(10);
  expectGiven(states, 2 * kStep_s);
  expectMomentum(momentumOf(puck(), states), momentumAtStart(puck()) + 12 * kStep_s * kPush);
}

TEST_F(Schedule, AHeldWrenchEndsAfterTheTimeoutWithOneLine) {
  Recording<rosgraph_msgs::Log> log(sim, "/rosout");
  wrench.send(wrenchIn("world", kForce, kTorque));
  expectGiven(sim.step(kTimeoutTicks - 1), (kTimeoutTicks - 1) * kStep_s);
  expectGiven(sim.step(), kTimeoutTicks * kStep_s);
  EXPECT_TRUE(log.messages.empty());
  expectGiven(sim.step(), kTimeoutTicks * kStep_s);
  expectGiven(sim.step(100), kTimeoutTicks * kStep_s);
  log.expect(1);
  ASSERT_EQ(log.messages.size(), 1u);
  for (const char* part : {"wrench on probe ended", "wrench_timeout_s", "/schedule"})
    EXPECT_NE(log.messages[0].msg.find(part), std::string::npos) << log.messages[0].msg;
}

TEST_F(Schedule, AHeldWrenchIsReplacedByItsSendersNext) {
  wrench.send(wrenchIn("world", kForce, kTorque));
  expectGiven(sim.step(30), 30 * kStep_s);
  wrench.send(wrenchIn("world", 3 * kForce, 3 * kTorque));
  expectGiven(sim.step(20), 90 * kStep_s);
  wrench.send(wrenchIn("world", Vector3d::Zero()));
  expectGiven(sim.step(20), 90 * kStep_s);
}

TEST_F(Schedule, ARepeatedWrenchLastsATimeoutFromItsLastMessage) {
  wrench.send(wrenchIn("world", kForce, kTorque));
  sim.step(30);
  wrench.send(wrenchIn("world", kForce, kTorque));
  expectGiven(sim.step(200), (30 + kTimeoutTicks) * kStep_s);
}

TEST_F(Schedule, AHeldWrenchOfTheFutureTakesOverAtItsTickAndLastsATimeoutFromThere) {
  wrench.send(
      {wrenchIn("world", kForce, kTorque), wrenchIn("world", 2 * kForce, 2 * kTorque, after(6))});
  expectGiven(sim.step(6), 6 * kStep_s);
  expectGiven(sim.step(10), 26 * kStep_s);
  expectGiven(sim.step(200), (6 + 2 * kTimeoutTicks) * kStep_s);
}

TEST_F(Schedule, WithoutADurationAnArraysWrenchesAreHeldAndReplacedTogether) {
  sendWrenches(entry(0), entry(0, 10));
  expectGiven(sim.step(5), 55 * kStep_s);
  sendWrenches(entry(0, 2));
  expectGiven(sim.step(5), 65 * kStep_s);
  expectGiven(sim.step(200), (55 + 2 * kTimeoutTicks) * kStep_s);
}

TEST_F(Schedule, AHeldWrenchDoesNotReplaceOneWithADuration) {
  sendWrenches(entry(9, 10));
  sendWrenches(entry(0));
  expectGiven(sim.step(9), 99 * kStep_s);
  expectGiven(sim.step(), 100 * kStep_s);
}

// 3 + 4 + 3 thousand pushes of all kinds; their momenta added up in extended precision.
TEST_F(Schedule, TenThousandImpulsesActExactlyOnceEachHoweverTheyArrive) {
  using Sum = Eigen::Matrix<long double, 3, 1>;
  Sum linear = Sum::Zero(), angular = Sum::Zero();
  int number = 0;
  const auto next = [&](const ros::Time& stamp) {
    ++number;  // a sum that is not small against its parts
    const Vector3d J = 0.01 * Vector3d(1.5 + std::sin(number), std::cos(3.0 * number) - 1.2, 0.7);
    const Vector3d H = 1e-4 * Vector3d(std::cos(2.0 * number), 0.9, std::sin(5.0 * number) + 1.1);
    linear += J.cast<long double>();
    angular += H.cast<long double>();
    return impulseIn("world", J, H, stamp);
  };
  for (int burst = 0; burst < 10; ++burst) {  // one by one, 300 a burst
    std::vector<ImpulseStamped> messages;
    for (int i = 0; i < 300; ++i) messages.push_back(next(burst % 2 ? now_ : ros::Time()));
    impulse.send(messages);
    if (burst % 3 == 0) sim.step(1 + static_cast<std::uint32_t>(burst));
  }
  for (int size : {1, 999, 3000}) {  // in arrays
    std::vector<BodyImpulse> entries;
    for (int i = 0; i < size; ++i) {
      const ImpulseStamped one = next({});
      entries.push_back(bodyImpulse("probe", "world", toEigen(one.linear), toEigen(one.angular)));
    }
    topics_->impulses.send(arrayOf<BodyImpulses>(entries));
  }
  now_ = sim.step().header.stamp;
  for (int burst = 0; burst < 10; ++burst) {  // for the future, latest first
    std::vector<ImpulseStamped> messages;
    for (int i = 0; i < 300; ++i) messages.push_back(next(after(300 - burst * 30 - i % 7)));
    impulse.send(messages);
  }
  ASSERT_EQ(number, 10'000);
  const Momentum start = momentumAtStart(body);
  expectMomentum(momentumOf(body, sim.step(400)),
                 {start.P_WB + linear.cast<double>(), start.L_WBcm_W + angular.cast<double>()});
}

TEST_F(Schedule, TenThousandMayWaitAndTheNextIsRefused) {
  std::vector<BodyImpulse> entries(10'000, bodyImpulse("probe", "world", kForce, kTorque));
  for (BodyImpulse& one : entries) one.start = after(5);
  topics_->impulses.send(arrayOf<BodyImpulses>(entries));
  impulse.send(impulseIn("world", 1e6 * kForce, kTorque, after(5)));
  impulse.send(impulseIn("world", kForce, kTorque));  // does not wait
  expectGiven(sim.step(), 1);
  const Status status =
      sim.diagnostics([](const Status& now) { return now.count("inputs waiting") == 10'000; });
  EXPECT_GE(status.count("inputs refused: too many waiting"), 1u);
  sim.step(5);
  impulse.send(impulseIn("world", kForce, kTorque, now_ + ros::Duration(1)));  // room again
  const Momentum momentum = momentumOf(body, sim.step(100));
  const Momentum wanted = momentumAtStart(body) + 10'002 * kPush;
  // 10,000 additions that round the same way each: half an ulp of the sum at most.
  EXPECT_LE((momentum.P_WB - wanted.P_WB).norm(), 1e4 * 1.1e-16 * wanted.P_WB.norm());
}

TEST_F(Schedule, DiagnosticsCountWhatIsHeldAndWhatExpired) {
  const std::uint64_t expired = sim.diagnostics().count("wrenches expired");
  wrench.send(wrenchIn("world", kForce));
  puck_wrench.send(wrenchIn("world", kForce));
  sendWrenches(entry(100, 0.1));
  sim.step();
  sim.diagnostics([](const Status& now) { return now.count("wrenches held") == 3; });
  sim.step(200);
  const Status after =
      sim.diagnostics([](const Status& now) { return now.count("wrenches held") == 0; });
  EXPECT_EQ(after.count("wrenches expired"), expired + 2) << "a duration that is over is no expiry";
}

}  // namespace
}  // namespace rigid_body_sim

int main(int argc, char** argv) { return rigid_body_sim::runRostest(argc, argv, "schedule_test"); }

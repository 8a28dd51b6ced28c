// Inputs that are refused, over real topics: nothing moves, it is counted and said.

#include <rosgraph_msgs/Log.h>

#include <limits>

#include "probe_inputs.hpp"

namespace rigid_body_sim {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kDenormal = std::numeric_limits<double>::denorm_min();

const Vector3d kForce(2.1, -1.4, 0.9);
const Vector3d kTorque(-0.3, 0.5, 0.2);
const Vector3d kZero = Vector3d::Zero();

class Refusals : public PushTest {
 protected:
  void SetUp() override {
    PushTest::SetUp();
    now_ = sim.step(150).header.stamp;  // late enough for stale stamps
  }

  // Each sends inputs that are refused for one reason, and returns how many.
  std::uint64_t sendNotFinite();
  std::uint64_t sendAboveLimits();
  std::uint64_t sendUnknownFrames();
  std::uint64_t sendUnknownBodies();
  std::uint64_t sendBadDurations();
  std::uint64_t sendStale();
  std::uint64_t sendFarAhead();

  /// The inputs sent since SetUp() move nothing by a single bit.
  void expectUnmoved() {
    const BodyStates after = sim.step(3);
    sim.reset();
    EXPECT_TRUE(sameBits(after, sim.step(153)));
  }

  std::uint64_t pushes(const std::string& frame) {
    wrench.send(wrenchIn(frame, kForce));
    impulse.send(impulseIn(frame, kForce));
    sendWrenches(bodyWrench("probe", frame, kForce, kTorque, kStep_s));
    sendImpulses(bodyImpulse("probe", frame, kForce, kTorque));
    return 4;
  }

  std::uint64_t pushesAt(const ros::Time& stamp) {
    wrench.send(wrenchIn("world", kForce, kTorque, stamp));
    impulse.send(impulseIn("world", kForce, kTorque, stamp));
    BodyWrench entry = bodyWrench("probe", "world", kForce, kTorque, kStep_s);
    entry.start = stamp;
    sendWrenches(entry);
    BodyImpulse other = bodyImpulse("probe", "world", kForce, kTorque);
    other.start = stamp;
    sendImpulses(other);
    return 4;
  }

  static BodyWrench wrenchAt(const Vector3d& point, const std::string& point_frame = "probe") {
    BodyWrench entry = bodyWrench("probe", "world", kForce, kTorque, kStep_s);
    entry.point = toPoint(point);
    entry.point_frame = point_frame;
    return entry;
  }

  ros::Time now_;
};

std::uint64_t Refusals::sendNotFinite() {
  for (const double bad : {kNaN, kInf, -kInf}) {
    wrench.send({wrenchIn("world", {bad, 0, 0}), wrenchIn("probe", {0, bad, 0}),
                 wrenchIn("thruster", kZero, {0, 0, bad}), wrenchIn("probe/com", {bad, bad, bad})});
    impulse.send({impulseIn("world", {0, 0, bad}), impulseIn("probe", kZero, {bad, 0, 0})});
    sendWrenches(wrenchAt({bad, 0, 0}), bodyWrench("probe", "world", {bad, 0, 0}, kZero, kStep_s));
    sendImpulses(bodyImpulse("probe", "thruster", kZero, {0, bad, 0}));
  }
  return 27;
}

// The limits of refusals.test; sizes whose squares overflow are above them too.
std::uint64_t Refusals::sendAboveLimits() {
  for (const double factor : {1.001, 1e10, 1e200, 1e300}) {
    wrench.send(
        {wrenchIn("world", {0, factor * 1000, 0}), wrenchIn("probe", kZero, {0, factor * 500, 0})});
    impulse.send({impulseIn("world", {0, 0, factor * 100}),
                  impulseIn("probe/com", kZero, {factor * 50, 0, 0})});
  }
  impulse.send(impulseIn("world", {20.1 * body.mass, 0, 0}));    // 20.1 m/s
  impulse.send(impulseIn("world", kZero, {0, 45, 0}));           // 300 rad/s about an axis of 0.15
  sendWrenches(wrenchAt({1e6, 0, 0}), wrenchAt({0, 1e300, 0}));  // spin by the arm
  return 20;
}

std::uint64_t Refusals::sendUnknownFrames() {
  std::uint64_t count = 0;
  const std::string endless(1'000'000, 'x');
  const std::vector<std::string> frames = {
      "",      "/",      "nowhere",      "puck",          "puck/com", "//probe",
      "Probe", "probe/", "thruster/com", "bad\x01\nname", endless};
  for (const std::string& frame : frames) count += pushes(frame);
  sendWrenches(wrenchAt(kZero, "world"), wrenchAt(kZero, "puck"), wrenchAt(kZero, "nowhere"));
  return count + 3;
}

std::uint64_t Refusals::sendUnknownBodies() {
  for (const char* name : {"", "nobody", "/probe", "thruster", "probe/com", "world"}) {
    sendWrenches(bodyWrench(name, "world", kForce, kTorque, kStep_s));
    sendImpulses(bodyImpulse(name, "world", kForce, kTorque));
  }
  return 12;
}

std::uint64_t Refusals::sendBadDurations() {
  for (const double duration_s : {0.03, 0.001, 1e-9, 0.020001, -0.02, -1.0})
    sendWrenches(bodyWrench("probe", "world", kForce, kTorque, duration_s));
  return 6;
}

std::uint64_t Refusals::sendStale() {
  return pushesAt(now_ - ros::Duration(1.02)) + pushesAt(now_ - ros::Duration(2.5)) +
         pushesAt(ros::Time(0, 1));
}

std::uint64_t Refusals::sendFarAhead() {
  return pushesAt(now_ + ros::Duration(10.02)) + pushesAt(now_ + ros::Duration(1000)) +
         pushesAt(ros::Time(1.7e9)) + pushesAt(ros::Time(0xffffffff, 999'999'999));
}

TEST_F(Refusals, NumbersThatAreNotFiniteMoveNothing) {
  sendNotFinite();
  expectUnmoved();
}

TEST_F(Refusals, SizesAboveTheLimitsMoveNothing) {
  sendAboveLimits();
  expectUnmoved();
}

TEST_F(Refusals, FramesThatAreNotOfTheBodyMoveNothing) {
  sendUnknownFrames();
  expectUnmoved();
}

TEST_F(Refusals, UnknownBodiesMoveNothing) {
  sendUnknownBodies();
  expectUnmoved();
}

TEST_F(Refusals, DurationsThatAreNoWholeNumberOfStepsMoveNothing) {
  sendBadDurations();
  expectUnmoved();
}

TEST_F(Refusals, StaleStampsMoveNothing) {
  sendStale();
  expectUnmoved();
}

TEST_F(Refusals, StampsMoreThanTenSecondsAheadMoveNothingAndDoNotWait) {
  sendFarAhead();
  expectMomentum(momentumOf(body, sim.step(600)), momentumAtStart(body));
  sim.reset();
  now_ = sim.step(150).header.stamp;
  sendFarAhead();
  expectUnmoved();
}

// The reports come once a second, so this is one test of all reasons.
TEST_F(Refusals, DiagnosticsCountThemByReasonAndWarnUntilItIsOver) {
  const Status before = sim.diagnostics();
  const std::map<std::string, std::uint64_t> sent = {
      {"inputs refused: not finite", sendNotFinite()},
      {"inputs refused: above a limit", sendAboveLimits()},
      {"inputs refused: unknown frame", sendUnknownFrames()},
      {"inputs refused: unknown body", sendUnknownBodies()},
      {"inputs refused: bad duration", sendBadDurations()},
      {"inputs refused: stale", sendStale()},
      {"inputs refused: too far ahead", sendFarAhead()}};
  bool was_warned = false;
  const Status after = sim.diagnostics([&](const Status& now) {
    was_warned |= now.level == diagnostic_msgs::DiagnosticStatus::WARN &&
                  now.message.find("inputs refused") != std::string::npos;
    return was_warned && now.level == diagnostic_msgs::DiagnosticStatus::OK;
  });
  for (const auto& reason : sent)
    EXPECT_EQ(after.count(reason.first) - before.count(reason.first), reason.second)
        << reason.first;
  EXPECT_EQ(after.count("inputs accepted"), before.count("inputs accepted"));
  EXPECT_EQ(after.count("inputs waiting"), 0u);
}

TEST_F(Refusals, AThrottledWarningNamesSenderAndTheFramesThatThereAre) {
  Recording<rosgraph_msgs::Log> log(sim, "/rosout");
  const ros::SteadyTime start = ros::SteadyTime::now();
  const std::string endless(1'000'000, 'x');
  const auto isWarned = [&] {
    wrench.send(wrenchIn(endless, kForce));
    return log.messages.size() >= 2;
  };
  need("two warnings", isWarned);
  EXPECT_GE((ros::SteadyTime::now() - start).toSec(), 0.9) << "two warnings within a second";
  const rosgraph_msgs::Log& line = log.messages[0];
  EXPECT_EQ(line.level, rosgraph_msgs::Log::WARN);
  for (const char* part :
       {"probe/wrench from /refusals", "world", "probe", "probe/com", "thruster"})
    EXPECT_NE(line.msg.find(part), std::string::npos) << line.msg;
  EXPECT_LT(line.msg.size(), 300u);
}

TEST_F(Refusals, TheWarningOfAnUnknownBodyNamesThoseThatThereAre) {
  Recording<rosgraph_msgs::Log> log(sim, "/rosout");
  need("a warning", [&] {
    sendImpulses(bodyImpulse("nobody", "world", kForce, kTorque));
    return !log.messages.empty();
  });
  EXPECT_NE(log.messages[0].msg.find("'nobody'; there are probe, puck"), std::string::npos)
      << log.messages[0].msg;
}

TEST_F(Refusals, OneBadEntryDoesNotStopTheOthers) {
  sendImpulses(bodyImpulse("probe", "world", kForce, kTorque),
               bodyImpulse("probe", "world", {kNaN, 0, 0}, kZero),
               bodyImpulse("nobody", "world", kForce, kTorque),
               bodyImpulse("probe", "world", kForce, kTorque));
  sendWrenches(bodyWrench("probe", "", kForce, kTorque, kStep_s),
               bodyWrench("probe", "world", kForce, kTorque, kStep_s));
  const double factor = 2 + kStep_s;
  expectMomentum(momentumOf(body, sim.step()),
                 momentumAtStart(body) + Momentum{factor * kForce, factor * kTorque});
}

TEST_F(Refusals, ARefusedWrenchDoesNotReplaceTheOneThatIsHeld) {
  wrench.send({wrenchIn("world", kForce, kTorque), wrenchIn("world", {kNaN, 0, 0}),
               wrenchIn("nowhere", kForce)});
  expectMomentum(momentumOf(body, sim.step()),
                 momentumAtStart(body) + Momentum{kStep_s * kForce, kStep_s * kTorque});
}

TEST_F(Refusals, SizesJustBelowTheLimitsAreTaken) {
  impulse.send({impulseIn("world", {0, 19.9 * body.mass, 0}), impulseIn("world", {0, 0, -61})});
  wrench.send(wrenchIn("world", {999, 0, 0}, {0, 100, 0}));
  expectMomentum(momentumOf(body, sim.step()),
                 momentumAtStart(body) +
                     Momentum{{999 * kStep_s, 19.9 * body.mass, -61}, {0, 100 * kStep_s, 0}});
}

// That nothing changes does not show that they were taken; the count does.
TEST_F(Refusals, DenormalsAndNegativeZerosAreTakenAndChangeNothing) {
  const std::uint64_t before = sim.diagnostics().count("inputs accepted");
  for (const double tiny : {kDenormal, -kDenormal, -0.0}) {
    const Vector3d v(tiny, tiny, tiny);
    wrench.send({wrenchIn("world", v, v), wrenchIn("thruster", v, v)});
    impulse.send({impulseIn("world", v, v), impulseIn("thruster", v, v)});
    sendWrenches(bodyWrench("probe", "probe", v, v, kStep_s));
    sendImpulses(bodyImpulse("probe", "probe/com", v, v));
  }
  expectUnmoved();
  const Status after = sim.diagnostics(
      [&](const Status& now) { return now.count("inputs accepted") >= before + 18; });
  EXPECT_EQ(after.count("inputs accepted"), before + 18);
}

}  // namespace
}  // namespace rigid_body_sim

int main(int argc, char** argv) { return rigid_body_sim::runRostest(argc, argv, "refusals_test"); }

// What the node sends, read over real topics. The transforms are in tf_test.cpp.

#include <geometry_msgs/TwistStamped.h>
#include <nav_msgs/Odometry.h>
#include <rosgraph_msgs/Clock.h>
#include <std_msgs/String.h>
#include <tf2_msgs/TFMessage.h>

#include "probe.hpp"
#include "rigid_body_sim/rotation.hpp"
#include "ros_fixture.hpp"

namespace rigid_body_sim {
namespace {

using geometry_msgs::TwistStamped;
using nav_msgs::Odometry;
using rosgraph_msgs::Clock;
using tf2_msgs::TFMessage;

constexpr std::int64_t kStep_ns = 20'000'000;

// The published numbers went through some ten products and sums of the size of the result.
constexpr double kRounding = 1e-14;

double difference(const Vector3d& a, const Vector3d& b) { return (a - b).norm(); }

template <class Message, class StampOf>
std::vector<ros::Time> stampsOf(const std::vector<Message>& messages, const StampOf& stampOf) {
  std::vector<ros::Time> stamps;
  for (const Message& one : messages) stamps.push_back(stampOf(one));
  return stamps;
}

using Outputs = NodeTest;

TEST_F(Outputs, ClockStartsAtOneSecondAndStepsByExactlyTwentyMilliseconds) {
  Recording<Clock> clock(sim, "/clock");
  const BodyStates states = sim.step(40);
  need("the last tick", [&] {
    return !clock.messages.empty() && clock.messages.back().clock == states.header.stamp;
  });
  EXPECT_GE(clock.messages.size(), 40u);  // the one before may still have been on its way
  EXPECT_EQ(states.header.stamp.toNSec(), 1'000'000'000u + states.tick * kStep_ns);
  for (std::size_t i = 1; i < clock.messages.size(); ++i) {
    EXPECT_EQ((clock.messages[i].clock - clock.messages[i - 1].clock).toNSec(), kStep_ns);
    EXPECT_FALSE(clock.messages[i].clock.isZero());
  }
}

TEST_F(Outputs, StatesHoldAllBodiesAndTheStepsAnswerIsTheLast) {
  Recording<BodyStates> states(sim, "/states");
  states.expect(1);
  const std::uint64_t first = states.messages[0].tick;
  const BodyStates answer = sim.step(3);
  states.expect(4);
  ASSERT_EQ(states.messages.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) {
    const BodyStates& one = states.messages[i];
    EXPECT_EQ(one.tick, first + i);
    EXPECT_EQ(one.header.stamp.toNSec(), 1'000'000'000u + one.tick * kStep_ns);
    EXPECT_EQ(one.header.frame_id, "world");
    EXPECT_EQ(one.names, (std::vector<std::string>{"probe", "puck"}));
  }
  EXPECT_EQ(answer.tick, states.messages[3].tick);
  EXPECT_TRUE(sameBits(answer, states.messages[3]));
}

TEST_F(Outputs, TheInitialStateIsTheScenes) {
  Recording<BodyStates> states(sim, "/states");
  states.expect(1);
  for (const Solid& body : {probe(), puck()}) {
    SCOPED_TRACE(body.name);
    const Motion motion = motionOf(states.messages[0], body.name);
    const Motion wanted = withMomentum(body, motion, momentumAtStart(body));
    EXPECT_LE(difference(motion.p_WL, body.X_WL.translation()), kRounding);
    EXPECT_LE((motion.R_WL() - body.X_WL.linear()).norm(), kRounding);
    EXPECT_LE(difference(motion.v_WL_L, wanted.v_WL_L), kRounding);
    EXPECT_LE(difference(motion.w_WL_L, body.w_WL_L), kRounding);
  }
}

// Free flight keeps P and L, so both velocities follow from the start and the attitude, and the
// position from the straight line of the centre of mass.
TEST_F(Outputs, TwistIsTheVelocityOfTheLinkOriginInLinkAxesOfATurnedBody) {
  Recording<TwistStamped> twists(sim, "/probe/twist");
  Recording<BodyStates> states(sim, "/states");
  sim.step(100);
  twists.expect(101);
  states.expect(101);
  ASSERT_EQ(twists.messages.size(), 101u);
  const Solid body = probe();
  for (std::size_t k = 1; k <= 100; ++k) {
    const TwistStamped& twist = twists.messages[k];
    ASSERT_EQ(twist.header.stamp, states.messages[k].header.stamp);
    ASSERT_EQ(twist.header.frame_id, "probe");
    const Motion motion = motionOf(states.messages[k].poses[0], twist.twist);
    const Motion wanted = withMomentum(body, motion, momentumAtStart(body));
    // 1e-12, as 100 steps may each round momentum and position once.
    ASSERT_LE(difference(motion.v_WL_L, wanted.v_WL_L), 1e-12);
    ASSERT_LE(difference(motion.w_WL_L, wanted.w_WL_L), 1e-12);
    const double time_s = kStep_s * static_cast<double>(k);
    ASSERT_LE(
        difference(centreOfMass(body, motion), body.X_WL * body.p_LBcm + time_s * body.v_WBcm),
        1e-12);
  }
  const Motion last = motionOf(states.messages[100], "probe");
  EXPECT_GT(rotationLog(Quaterniond(body.X_WL.linear()).conjugate() * last.q_WL).norm(), 0.5)
      << "the test is of a body that turns";
}

// Knows nothing of momentum: the central difference of published poses. Its error is h^2/6 times
// the third derivative; |c| (w^3 + 3 w w' + w'') <= 6 |c| w^3 bounds that of p_WL, as
// w' <= w^2 and w'' <= 2 w^3 for a body that obeys the triangle inequality. The step's own error of
// second order is no larger. A twist in the wrong axes or at the wrong point is off by 0.5.
TEST_F(Outputs, TwistIsTheRateOfThePublishedPose) {
  std::vector<Motion> motions;
  for (int k = 0; k < 60; ++k) motions.push_back(motionOf(sim.step(), "probe"));
  const Solid body = probe();
  for (std::size_t k = 1; k + 1 < motions.size(); ++k) {
    const Motion &before = motions[k - 1], &now = motions[k], &after = motions[k + 1];
    const double w = now.w_WL_L.norm();
    const Vector3d v_WL = (after.p_WL - before.p_WL) / (2 * kStep_s);
    const Vector3d w_L = (rotationLog(now.q_WL.conjugate() * after.q_WL) -
                          rotationLog(now.q_WL.conjugate() * before.q_WL)) /
                         (2 * kStep_s);
    const double bound = 2 * kStep_s * kStep_s * w * w * w;
    ASSERT_LE(difference(now.R_WL() * now.v_WL_L, v_WL), bound * body.p_LBcm.norm());
    ASSERT_LE(difference(now.w_WL_L, w_L), bound);
  }
}

TEST_F(Outputs, OdometryHasThePoseInTheWorldAndTheTwistInItsChildFrame) {
  Recording<Odometry> odometry(sim, "/probe/odom");
  const BodyStates states = sim.step(9);
  odometry.expect(10);
  const Odometry& last = odometry.messages.back();
  EXPECT_EQ(last.header.frame_id, "world");
  EXPECT_EQ(last.child_frame_id, "probe");
  EXPECT_EQ(last.header.stamp, states.header.stamp);
  BodyStates same = states;
  same.poses[0] = last.pose.pose;
  same.twists[0] = last.twist.twist;
  EXPECT_TRUE(sameBits(same, states));
}

TEST_F(Outputs, EachBodyHasItsOwnTopics) {
  Recording<TwistStamped> twists(sim, "/puck/twist");
  Recording<Odometry> odometry(sim, "/puck/odom");
  const BodyStates states = sim.step();
  twists.expect(2);
  odometry.expect(2);
  EXPECT_EQ(twists.messages[1].header.frame_id, "puck");
  EXPECT_EQ(odometry.messages[1].child_frame_id, "puck");
  EXPECT_EQ(toEigen(twists.messages[1].twist.linear), motionOf(states, "puck").v_WL_L);
  EXPECT_EQ(toEigen(odometry.messages[1].pose.pose.position), motionOf(states, "puck").p_WL);
}

TEST_F(Outputs, NothingIsSentWhilePaused) {
  Recording<TFMessage> tf(sim, "/tf");
  Recording<BodyStates> states(sim, "/states");
  Recording<Clock> clock(sim, "/clock");
  Recording<TwistStamped> twists(sim, "/probe/twist");
  Recording<Odometry> odometry(sim, "/probe/odom");
  tf.expect(1);
  states.expect(1);
  twists.expect(1);
  odometry.expect(1);
  sim.pause();
  EXPECT_FALSE(sim.tryStep(0).success);
  // Two reports of the node are a second apart: it lives, and has had time for 50 ticks.
  int reports = 0;
  sim.diagnostics([&](const Status&) { return ++reports == 2; });
  EXPECT_EQ(tf.messages.size(), 1u);
  EXPECT_EQ(states.messages.size(), 1u);
  EXPECT_EQ(clock.messages.size(), 0u);  // its connection is older
  EXPECT_EQ(twists.messages.size(), 1u);
  EXPECT_EQ(odometry.messages.size(), 1u);
}

TEST_F(Outputs, NoStampIsSentTwiceNorLeftOutThroughPausesStepsAndResets) {
  Recording<TFMessage> tf(sim, "/tf");
  Recording<BodyStates> states(sim, "/states");
  Recording<Clock> clock(sim, "/clock");
  Recording<Odometry> odometry(sim, "/probe/odom");
  for (int round = 0; round < 5; ++round) {
    const std::size_t ticks = states.messages.size();
    sim.unpause();
    states.expect(ticks + 3);
    if (round % 2 == 0) sim.reset();
    sim.pause();
    sim.pause();
    sim.step(2);
    sim.reset();
    sim.reset();
  }
  const std::uint64_t last = sim.step().tick;
  need("the last tick",
       [&] { return !states.messages.empty() && states.messages.back().tick == last; });
  const std::size_t count = states.messages.size();
  ASSERT_EQ(last - states.messages.front().tick + 1, count);
  std::vector<ros::Time> stamps;
  for (std::size_t i = 0; i < count; ++i) {
    EXPECT_EQ(states.messages[i].tick, states.messages[0].tick + i);
    stamps.push_back(states.messages[i].header.stamp);
  }
  tf.expect(count);
  odometry.expect(count);
  need("the last clock",
       [&] { return !clock.messages.empty() && clock.messages.back().clock == stamps.back(); });
  EXPECT_EQ(
      stampsOf(tf.messages, [](const auto& one) { return one.transforms.at(0).header.stamp; }),
      stamps);
  EXPECT_EQ(stampsOf(odometry.messages, [](const auto& one) { return one.header.stamp; }), stamps);
  // Its connection is older, so that it may or may not have brought the first again.
  std::vector<ros::Time> clocks =
      stampsOf(clock.messages, [](const auto& one) { return one.clock; });
  if (clocks.front() != stamps.front()) clocks.insert(clocks.begin(), stamps.front());
  EXPECT_EQ(clocks, stamps);
}

TEST_F(Outputs, TheImportReportIsLatched) {
  Recording<std_msgs::String> report(sim, "/import_report");
  report.expect(1);
  const std::string& text = report.messages[0].data;
  for (const char* part : {"body 'probe'", "mass [kg]", "3.1", "lumped link 'thruster'"})
    EXPECT_NE(text.find(part), std::string::npos) << part << " is not in\n" << text;
}

TEST_F(Outputs, DiagnosticsSayOnceASecondWhatIsSimulatedAndHowItGoes) {
  const BodyStates now = sim.step(7);
  std::vector<ros::SteadyTime> times;
  const Status status = sim.diagnostics([&](const Status&) {
    times.push_back(ros::SteadyTime::now());
    return times.size() == 2;
  });
  ASSERT_EQ(times.size(), 2u);
  EXPECT_NEAR((times[1] - times[0]).toSec(), 1, 0.2);  // each message is on its own way
  EXPECT_EQ(status.level, diagnostic_msgs::DiagnosticStatus::OK) << status.message;
  EXPECT_EQ(status.count("tick"), now.tick);
  EXPECT_NE(status.values.at("scene").find("2 bodies"), std::string::npos);
  EXPECT_NE(status.values.at("scene").find("exact, step 0.02 s"), std::string::npos);
  EXPECT_EQ(status.values.at("real-time factor wanted"), "1");
  for (const char* key :
       {"real-time factor", "overruns", "times that lost time was given up", "inputs accepted",
        "inputs refused: not finite", "inputs refused: unknown body",
        "inputs refused: unknown frame", "inputs refused: stale", "inputs refused: too far ahead",
        "inputs refused: too many waiting", "inputs refused: bad duration",
        "inputs refused: above a limit", "inputs refused: torque on a point mass",
        "wrenches expired", "wrenches held", "inputs waiting"})
    EXPECT_EQ(status.values.count(key), 1u) << key;
}

}  // namespace
}  // namespace rigid_body_sim

int main(int argc, char** argv) { return rigid_body_sim::runRostest(argc, argv, "outputs_test"); }

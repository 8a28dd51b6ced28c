// Topics at rates of their own, and topics that are left out.

#include <nav_msgs/Odometry.h>
#include <rigid_body_sim/BodyImpulses.h>
#include <tf2_msgs/TFMessage.h>

#include <set>

#include "ros_fixture.hpp"

namespace rigid_body_sim {
namespace {

constexpr std::uint64_t kStep_ns = 20'000'000;

std::uint64_t tickOf(const ros::Time& stamp) { return (stamp.toNSec() - 1'000'000'000) / kStep_ns; }

/// The ticks that a topic had messages of.
template <class Message, class StampOf>
std::vector<std::uint64_t> ticksOf(const Recording<Message>& recording, const StampOf& stampOf) {
  std::vector<std::uint64_t> ticks;
  for (const Message& message : recording.messages) ticks.push_back(tickOf(stampOf(message)));
  return ticks;
}

std::vector<std::uint64_t> ticksOf(const Recording<tf2_msgs::TFMessage>& recording) {
  return ticksOf(recording, [](const auto& tf) { return tf.transforms.at(0).header.stamp; });
}

std::vector<std::uint64_t> ticksOf(const Recording<nav_msgs::Odometry>& recording) {
  return ticksOf(recording, [](const auto& odometry) { return odometry.header.stamp; });
}

/// First, the multiples of `every` after it, and last.
std::vector<std::uint64_t> wanted(std::uint64_t first, std::uint64_t last, std::uint64_t every) {
  std::vector<std::uint64_t> ticks = {first};
  for (std::uint64_t tick = first + 1; tick <= last; ++tick)
    if (tick == last || tick % every == 0) ticks.push_back(tick);
  return ticks;
}

std::set<std::string> topicsOfTheMaster() {
  ros::master::V_TopicInfo topics;
  EXPECT_TRUE(ros::master::getTopics(topics));
  std::set<std::string> names;
  for (const ros::master::TopicInfo& topic : topics) names.insert(topic.name);
  return names;
}

using Rates = NodeTest;

TEST_F(Rates, TicksThatAreMultiplesOfTheNumberAndTheLastOfAStepAreSent) {
  Recording<tf2_msgs::TFMessage> tf(sim, "/tf");
  Recording<nav_msgs::Odometry> odometry(sim, "/ball/odom");
  Recording<BodyStates> states(sim, "/states");
  states.expect(1);
  const std::uint64_t first = states.messages[0].tick;
  for (const std::uint32_t ticks : {1u, 11u, 6u}) {
    tf.expect(1);
    odometry.expect(1);
    const std::uint64_t from = ticksOf(tf).back();
    EXPECT_EQ(ticksOf(odometry).back(), from) << "both know where it stands";
    const std::size_t tf_before = tf.messages.size(), odometry_before = odometry.messages.size();
    const std::uint64_t last = sim.step(ticks).tick;
    const auto tf_wanted = wanted(from, last, 3), odometry_wanted = wanted(from, last, 2);
    tf.expect(tf_before + tf_wanted.size() - 1);
    odometry.expect(odometry_before + odometry_wanted.size() - 1);
    states.expect(1 + last - first);
    const auto tf_ticks = ticksOf(tf), odometry_ticks = ticksOf(odometry);
    EXPECT_EQ(std::vector<std::uint64_t>(tf_ticks.begin() + tf_before - 1, tf_ticks.end()),
              tf_wanted);
    EXPECT_EQ(std::vector<std::uint64_t>(odometry_ticks.begin() + odometry_before - 1,
                                         odometry_ticks.end()),
              odometry_wanted);
  }
  EXPECT_EQ(states.messages.size(), 1 + 1 + 11 + 6u);
}

TEST_F(Rates, AtAPauseAllTopicsTellWhereItStands) {
  Recording<tf2_msgs::TFMessage> tf(sim, "/tf");
  Recording<BodyStates> states(sim, "/states");
  for (int i = 0; i < 5; ++i) {
    sim.unpause();
    states.expect(states.messages.size() + 4);
    sim.pause();
    const std::uint64_t last = sim.step().tick;  // behind what the pause has sent
    need("the last tick", [&] {
      return !tf.messages.empty() && ticksOf(tf).back() == last &&
             states.messages.back().tick == last;
    });
    const auto ticks = ticksOf(tf);
    EXPECT_EQ(ticks[ticks.size() - 2], last - 1) << "sent at the pause";
    EXPECT_EQ(std::set<std::uint64_t>(ticks.begin(), ticks.end()).size(), ticks.size())
        << "no stamp twice";
  }
}

TEST_F(Rates, AResetIsToldByAllTopics) {
  Recording<tf2_msgs::TFMessage> tf(sim, "/tf");
  tf.expect(1);
  const std::uint64_t last = sim.step(2).tick;
  need("the step's last tick", [&] { return ticksOf(tf).back() == last; });
  for (int i = 0; i < 3; ++i) {
    const std::uint64_t before = ticksOf(tf).back();
    sim.reset();
    need("the reset", [&] { return ticksOf(tf).back() > before; });
    EXPECT_EQ(ticksOf(tf).back(), before + 1);
    EXPECT_EQ(tf.messages.back().transforms.at(0).transform.translation.x, 0);
  }
}

TEST_F(Rates, TopicsThatAreNeverSentDoNotExist) {
  sim.step();
  const std::set<std::string> topics = topicsOfTheMaster();
  for (const char* name : {"/tf", "/states", "/ball/odom", "/brick/applied_wrench"})
    EXPECT_EQ(topics.count(name), 1u) << name;
  EXPECT_EQ(topics.count("/ball/twist"), 0u);
}

TEST_F(Rates, InputsOfAllBodiesAreTakenWhereSingleBodiesHaveNoTopics) {
  XmlRpc::XmlRpcValue request, response, state;
  request[0] = ros::this_node::getName();
  ASSERT_TRUE(ros::master::execute("getSystemState", request, response, state, false));
  std::set<std::string> subscribed;
  for (int i = 0; i < state[1].size(); ++i) subscribed.insert(state[1][i][0]);
  EXPECT_EQ(subscribed.count("/impulses"), 1u);
  EXPECT_EQ(subscribed.count("/ball/wrench"), 0u);
  EXPECT_EQ(subscribed.count("/ball/impulse"), 0u);

  const double before = sim.step().twists[0].linear.x;
  Input<BodyImpulses> impulses(sim, "/impulses");
  BodyImpulses message;
  message.impulses.resize(1);
  message.impulses[0].body = "ball";
  message.impulses[0].frame = "world";
  message.impulses[0].linear.x = 2;
  impulses.send(message);
  EXPECT_GT(sim.step().twists[0].linear.x, before + 0.1);
}

}  // namespace
}  // namespace rigid_body_sim

int main(int argc, char** argv) { return rigid_body_sim::runRostest(argc, argv, "rates_test"); }

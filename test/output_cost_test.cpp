// What publishing a tick allocates, counted in the thread that steps.

#include <numeric>

#include "allocation_count.hpp"
#include "generic.hpp"
#include "node/outputs.hpp"
#include "ros_fixture.hpp"

namespace rigid_body_sim {
namespace {

#ifdef COUNTS_ALLOCATIONS

constexpr int kTicks = 100;

NodeOptions options() {
  return readNodeOptions(Parameters(readYaml("{}", "test"), ""), false, 1'700'000'000'000'000'000);
}

Scene scene() {
  Scene scene;
  for (int i = 0; i < 50; ++i) scene.bodies.push_back(genericSceneBody("b" + std::to_string(i)));
  std::vector<Eigen::Index> all(scene.bodies.size());
  std::iota(all.begin(), all.end(), 0);
  scene.effects.push_back(uniformGravity({0, 0, -9.8}, all));
  return scene;
}

class OutputCost : public testing::Test {
 protected:
  /// Allocations of kTicks ticks in this thread, after those that happen once.
  long allocations() {
    for (int i = 0; i < 10; ++i) tick();
    const long before = allocations_here;
    for (int i = 0; i < kTicks; ++i) tick();
    return allocations_here - before;
  }

  void tick() {
    outputs.serveNewSubscribers();
    simulator.step();
    outputs.publish();
  }

  template <class Message>
  ros::Subscriber subscribe(const std::string& topic) {
    const boost::function<void(const boost::shared_ptr<Message const>&)> count =
        [this](const auto&) { ++received; };
    return nh.subscribe<Message>(topic, 10'000, count);
  }

  void expectReceived(int messages) {
    EXPECT_TRUE(waitFor([&] { return received >= messages; })) << received;
  }

  ros::NodeHandle nh;
  Simulator simulator{scene()};
  Outputs outputs{nh, simulator, SimTime{1'000'000'000, simulator.scene().step_ns}, options()};
  int received = 0;
};

TEST_F(OutputCost, NothingIsAllocatedForTopicsWithoutSubscribers) { EXPECT_EQ(allocations(), 0); }

// A message is put into a buffer of its own, which roscpp keeps until it is sent: the buffer, its
// count of owners, and now and then a longer queue for it.
TEST_F(OutputCost, AMessageTakesRoscppsBufferAndNothingElse) {
  const auto tf = subscribe<tf2_msgs::TFMessage>("/tf");
  const auto states = subscribe<BodyStates>("states");
  const auto odometry = subscribe<nav_msgs::Odometry>("b7/odom");
  const auto twist = subscribe<geometry_msgs::TwistStamped>("b8/twist");
  const int messages = 4 * kTicks;
  const long count = allocations();
  EXPECT_GE(count, 2 * messages);
  EXPECT_LE(count, 2 * messages + messages / 10);
  expectReceived(messages);
}

TEST_F(OutputCost, WhenTheLastSubscriberLeavesNothingIsAllocatedAgain) {
  {
    const auto odometry = subscribe<nav_msgs::Odometry>("b7/odom");
    tick();
    expectReceived(1);
  }
  EXPECT_EQ(allocations(), 0);
}

#endif

}  // namespace
}  // namespace rigid_body_sim

int main(int argc, char** argv) {
  return rigid_body_sim::runRostest(argc, argv, "output_cost_test");
}

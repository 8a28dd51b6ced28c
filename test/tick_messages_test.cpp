#include "node/tick_messages.hpp"

#include "allocation_count.hpp"
#include "effect_blocks.hpp"
#include "generic.hpp"

namespace rigid_body_sim {
namespace {

const ros::Time kStamp(12, 340'000'000);

/// Two bodies of unlike names that fall and tumble.
Simulator fallingBodies() {
  Scene scene;
  scene.bodies = {genericSceneBody("b"), genericSceneBody("a_body_with_quite_a_long_name")};
  scene.bodies[1].X_WL.translation() = Vector3d(1, 2, 3);
  scene.effects.push_back(uniformGravity({0.1, 0.2, -9.8}, {0, 1}));
  Simulator simulator(scene);
  WrenchInput push;
  push.body = 1;
  push.applied = {Axes::kBody, {{1, 2, 3}, {0.1, -0.2, 0.3}}, {0.1, 0, 0.2}};
  simulator.apply(push);
  for (int i = 0; i < 7; ++i) simulator.step();
  return simulator;
}

void expectSame(TickMessages& messages, const Simulator& simulator) {
  EXPECT_EQ(messages.tf(), toTf(simulator, "map", kStamp));
  EXPECT_EQ(messages.states(), toStates(simulator, "map", kStamp));
  EXPECT_EQ(messages.effectWrenches(), toEffectWrenches(simulator, "map", kStamp));
  for (const Eigen::Index body : {1, 0, 1}) {
    EXPECT_EQ(messages.odometry(body), toOdometry(simulator, body, "map", kStamp));
    EXPECT_EQ(messages.twist(body), toTwist(simulator, body, kStamp));
    EXPECT_EQ(messages.appliedWrench(body), toAppliedWrench(simulator, body, kStamp));
  }
}

TEST(TickMessages, AreToTheBitThoseOfTheConversions) {
  Simulator simulator = fallingBodies();
  TickMessages messages(simulator, "map");
  for (int i = 0; i < 3; ++i) {
    simulator.step();
    messages.begin(kStamp);
    expectSame(messages, simulator);
  }
}

TEST(TickMessages, FollowAnEffectThatEndsBetweenTwoTicks) {
  Simulator simulator = fallingBodies();
  TickMessages messages(simulator, "map");
  messages.begin(kStamp);
  EXPECT_EQ(messages.effectWrenches().effects.size(), 2u);
  simulator.switchEffect("gravity", false);
  messages.begin(kStamp);
  expectSame(messages, simulator);
  EXPECT_EQ(messages.effectWrenches().effects.size(), 1u);
}

TEST(TickMessages, AllocateNothingOnceTheyAreThere) {
#ifndef COUNTS_ALLOCATIONS
  GTEST_SKIP() << "allocations cannot be counted here";
#else
  Simulator simulator = fallingBodies();
  TickMessages messages(simulator, "map");
  const long before = allocation_count;
  for (int i = 0; i < 10; ++i) {
    simulator.step();
    messages.begin(kStamp);
    messages.tf();
    messages.states();
    for (const Eigen::Index body : {0, 1}) {
      messages.odometry(body);
      messages.twist(body);
    }
  }
  EXPECT_EQ(allocation_count, before);
  messages.effectWrenches();
  EXPECT_GT(allocation_count, before) << "the simulator makes that list anew: the counter counts";
#endif
}

}  // namespace
}  // namespace rigid_body_sim

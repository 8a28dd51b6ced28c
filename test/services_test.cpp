// ~pause, ~step and ~reset over real services.

#include "probe_inputs.hpp"

namespace rigid_body_sim {
namespace {

const Vector3d kForce(2.1, -1.4, 0.9);
const Vector3d kTorque(-0.3, 0.5, 0.2);

class Services : public PushTest {
 protected:
  /// Without the time of it.
  static bool sameMotion(const BodyStates& a, const BodyStates& b) { return sameBits(a, b); }

  template <class Service>
  Service call(const std::string& name, const typename Service::Request& request = {}) {
    Service service;
    service.request = request;
    EXPECT_TRUE(ros::service::call("/rigid_body_sim/" + name, service)) << "a failed call";
    return service;
  }

  std_srvs::SetBool::Response askPause(bool paused) {
    std_srvs::SetBool::Request request;
    request.data = paused;
    return call<std_srvs::SetBool>("pause", request).response;
  }
};

TEST_F(Services, PauseStopsTheTicksAndUnpauseLetsThemGoOn) {
  Recording<BodyStates> states(sim, "/states");
  states.expect(1);
  for (int round = 0; round < 3; ++round) {
    const std::size_t before = states.messages.size();
    EXPECT_TRUE(askPause(false).success);
    states.expect(before + 5);
    const std_srvs::SetBool::Response paused = askPause(true);
    EXPECT_TRUE(paused.success);
    EXPECT_EQ(paused.message, "paused");
    const std::uint64_t tick = sim.step().tick;
    need("the last tick", [&] { return states.messages.back().tick == tick; });
    EXPECT_EQ(states.messages.back().tick - states.messages[0].tick, states.messages.size() - 1)
        << "the step is the next tick after the pause";
  }
}

TEST_F(Services, PauseTwiceAndUnpauseTwiceAreNoErrors) {
  EXPECT_TRUE(askPause(true).success);
  EXPECT_TRUE(askPause(true).success);
  EXPECT_TRUE(askPause(false).success);
  const std_srvs::SetBool::Response again = askPause(false);
  EXPECT_TRUE(again.success);
  EXPECT_EQ(again.message, "running");
  EXPECT_TRUE(askPause(true).success);
}

TEST_F(Services, StepRefusesWhileTheSimulationRuns) {
  sim.unpause();
  const Step::Response response = sim.tryStep(1);
  EXPECT_FALSE(response.success);
  EXPECT_NE(response.message.find("running"), std::string::npos) << response.message;
  EXPECT_TRUE(response.states.names.empty());
}

TEST_F(Services, StepRefusesNoTicksAndMoreThanAMillionAndStepsNone) {
  const std::uint64_t tick = sim.step().tick;
  for (const std::uint32_t ticks : {0u, 1'000'001u, 0xffffffffu}) {
    const Step::Response response = sim.tryStep(ticks);
    EXPECT_FALSE(response.success);
    EXPECT_NE(response.message.find(std::to_string(ticks) + " ticks"), std::string::npos)
        << response.message;
    EXPECT_NE(response.message.find("1 to 1000000"), std::string::npos) << response.message;
  }
  EXPECT_EQ(sim.step().tick, tick + 1);
}

TEST_F(Services, StepAnswersWithTheStatesThatItHasPublished) {
  Recording<BodyStates> states(sim, "/states");
  states.expect(1);
  for (const std::uint32_t ticks : {1u, 2u, 30u}) {
    const std::size_t before = states.messages.size();
    const BodyStates answer = sim.step(ticks);
    states.expect(before + ticks);
    EXPECT_EQ(states.messages.size(), before + ticks);
    EXPECT_EQ(states.messages.back().header.stamp, answer.header.stamp);
    EXPECT_EQ(states.messages.back().tick, answer.tick);
    EXPECT_TRUE(sameMotion(states.messages.back(), answer));
  }
}

TEST_F(Services, OneStepOfManyTicksIsManyStepsOfOne) {
  const BodyStates at_once = sim.step(77);
  sim.reset();
  BodyStates one_by_one;
  for (int k = 0; k < 77; ++k) one_by_one = sim.step();
  EXPECT_TRUE(sameMotion(at_once, one_by_one));
}

// Ten seconds of allowance for 200 s simulated; measured 0.04 s.
TEST_F(Services, TenThousandTicksTakeSecondsNotMinutes) {
  const ros::SteadyTime start = ros::SteadyTime::now();
  sim.step(10'000);
  const double wall_s = (ros::SteadyTime::now() - start).toSec();
  EXPECT_LT(wall_s, 10);
}

TEST_F(Services, ResetRestoresTheInitialStateToTheBitAndTimeGoesOn) {
  Recording<BodyStates> states(sim, "/states");
  states.expect(1);
  const BodyStates initial = states.messages[0];
  impulse.send(impulseIn("thruster", kForce, kTorque));
  const BodyStates moved = sim.step(123);
  EXPECT_FALSE(sameMotion(moved, initial));
  const auto answer = call<std_srvs::Trigger>("reset").response;
  EXPECT_TRUE(answer.success);
  need("the reset's states", [&] { return states.messages.back().tick == moved.tick + 1; });
  EXPECT_TRUE(sameMotion(states.messages.back(), initial));
  EXPECT_EQ((states.messages.back().header.stamp - moved.header.stamp).toNSec(), 20'000'000);
}

TEST_F(Services, ResetClearsWhatIsHeldAndWhatWaits) {
  const BodyStates undisturbed = sim.step(40);
  sim.reset();
  const ros::Time now = sim.step().header.stamp;
  wrench.send({wrenchIn("world", kForce, kTorque),
               wrenchIn("thruster", kForce, kTorque, now + ros::Duration(0.3))});
  impulse.send(impulseIn("world", kForce, kTorque, now + ros::Duration(0.5)));
  sendWrenches(bodyWrench("probe", "world", kForce, kTorque, 1));
  sim.step(3);
  sim.reset();
  EXPECT_TRUE(sameMotion(sim.step(40), undisturbed));
}

TEST_F(Services, ResetClearsInputsThatNoTickHasSeen) {
  const BodyStates undisturbed = sim.step(4);
  sim.reset();
  impulse.send(impulseIn("world", kForce, kTorque));
  wrench.send(wrenchIn("world", kForce, kTorque));
  sim.reset();
  EXPECT_TRUE(sameMotion(sim.step(4), undisturbed));
}

TEST_F(Services, OfAThousandResetsNoneIsRefusedAndEachGivesTheInitialBits) {
  Recording<BodyStates> states(sim, "/states");
  states.expect(1);
  const BodyStates initial = states.messages[0];
  for (std::size_t i = 1; i <= 1000; ++i) {
    sim.reset();
    states.expect(i + 1);
    ASSERT_EQ(states.messages[i].tick, initial.tick + i);
    ASSERT_TRUE(sameMotion(states.messages[i], initial));
  }
  EXPECT_FALSE(sameMotion(sim.step(), initial));
}

TEST_F(Services, ResetWhileItRunsGoesOnFromTheInitialState) {
  Recording<BodyStates> states(sim, "/states");
  states.expect(1);
  const BodyStates initial = states.messages[0];
  sim.unpause();
  states.expect(6);
  sim.reset();
  states.expect(12);
  sim.pause();
  const auto& all = states.messages;
  std::size_t again = 1;
  while (again < all.size() && !sameMotion(all[again], initial)) ++again;
  ASSERT_LT(again + 3, all.size()) << "it goes on";
  for (std::size_t i = 1; i < all.size(); ++i)
    EXPECT_EQ((all[i].header.stamp - all[i - 1].header.stamp).toNSec(), 20'000'000);
  for (std::size_t i = 0; again + i < all.size() && i < again; ++i)
    EXPECT_TRUE(sameMotion(all[again + i], all[i])) << "tick " << i << " after the reset";
}

}  // namespace
}  // namespace rigid_body_sim

int main(int argc, char** argv) { return rigid_body_sim::runRostest(argc, argv, "services_test"); }

// One scene and one set of stamped inputs: the same bits at any speed, and after a reset.

#include "probe_inputs.hpp"

namespace rigid_body_sim {
namespace {

const Vector3d kForce(2.1, -1.4, 0.9);
const Vector3d kTorque(-0.3, 0.5, 0.2);
constexpr std::uint64_t kTicks = 90;  // the last input acts in tick 75

/// A simulator in a namespace, and this node's publishers to it.
class Copy {
 public:
  explicit Copy(const std::string& ns)
      : sim("/" + ns + "/sim"),
        states(sim, "/" + ns + "/states"),
        wrench_(sim, "/" + ns + "/probe/wrench"),
        impulse_(sim, "/" + ns + "/probe/impulse"),
        puck_impulse_(sim, "/" + ns + "/puck/impulse"),
        wrenches_(sim, "/" + ns + "/wrenches"),
        impulses_(sim, "/" + ns + "/impulses") {
    states.expect(1);
  }

  /// Pushes of every kind, several in some ticks, all stamped from the latest tick on.
  void sendInputs() {
    const ros::Time now = states.messages.back().header.stamp;
    const auto after = [&](int ticks) { return now + ros::Duration(ticks * kStep_s); };
    impulse_.send({impulseIn("thruster", kForce, kTorque, after(15)),
                   impulseIn("probe/com", kForce / 3, kTorque, after(35)),
                   impulseIn("world", -kForce / 7, kTorque / 9, after(35))});
    wrench_.send({wrenchIn("thruster", kForce, kTorque, after(25)),
                  wrenchIn("world", -kForce, kTorque, after(60))});
    std::vector<BodyWrench> entries;
    for (const int start : {10, 35, 50}) {
      entries.push_back(bodyWrench("probe", "probe", kForce / start, kTorque, 25 * kStep_s));
      entries.back().start = after(start);
      entries.push_back(bodyWrench("puck", "puck", kForce / 11, kTorque / 13, 7 * kStep_s));
      entries.back().start = after(start);
    }
    wrenches_.send(arrayOf<BodyWrenches>(entries));
    BodyImpulse entry = bodyImpulse("probe", "world", kForce / 17, kTorque / 19);
    entry.point_frame = "thruster";
    entry.start = after(35);
    impulses_.send(arrayOf<BodyImpulses>(std::vector<BodyImpulse>{entry, entry}));
    puck_impulse_.send(impulseIn("puck", kForce, kTorque, after(75)));
  }

  Sim sim;
  Recording<BodyStates> states;

 private:
  Input<WrenchStamped> wrench_;
  Input<ImpulseStamped> impulse_, puck_impulse_;
  Input<BodyWrenches> wrenches_;
  Input<BodyImpulses> impulses_;
};

/// The ticks that are in both, with the tick counted from the beginning of each.
std::size_t compare(const std::vector<BodyStates>& flown, const std::vector<BodyStates>& truth) {
  std::map<std::uint64_t, const BodyStates*> by_tick;
  for (const BodyStates& one : truth) by_tick[one.tick - truth.front().tick] = &one;
  std::size_t compared = 0;
  for (const BodyStates& one : flown) {
    const auto found = by_tick.find(one.tick - flown.front().tick);
    if (found == by_tick.end()) continue;
    EXPECT_TRUE(sameBits(one, *found->second)) << "tick " << found->first;
    ++compared;
  }
  return compared;
}

TEST(Determinism, TheSameSceneAndInputsGiveTheSameBitsAtAnySpeedAndAfterAReset) {
  Copy half("half"), real("real"), fast("fast");
  for (Copy* one : {&half, &real, &fast}) one->sendInputs();
  fast.sim.unpause();
  need("the fast one", [&] { return fast.states.messages.back().tick >= kTicks; });
  fast.sim.pause();
  const std::vector<BodyStates> flown = fast.states.messages;
  half.sim.unpause();
  real.sim.unpause();
  need("the slow ones", [&] {
    return half.states.messages.size() > kTicks && real.states.messages.size() > kTicks;
  });
  half.sim.pause();
  real.sim.pause();

  // The truth: after a reset and step by step. At full speed roscpp drops what its queue of 100
  // cannot hold, so beyond the slow ones' ticks those are stepped to that came through.
  const std::uint64_t tick = fast.sim.step().tick;
  fast.sim.reset();
  need("the reset", [&] { return fast.states.messages.back().tick == tick + 1; });
  std::vector<BodyStates> truth = {fast.states.messages.back()};
  fast.sendInputs();
  for (std::uint64_t k = 0; k < kTicks; ++k) truth.push_back(fast.sim.step());
  for (const BodyStates& one : flown) {
    const std::uint64_t ahead = one.tick - flown.front().tick;
    const std::uint64_t now = truth.back().tick - truth.front().tick;
    if (ahead > now) truth.push_back(fast.sim.step(static_cast<std::uint32_t>(ahead - now)));
  }

  EXPECT_GT(compare(half.states.messages, truth), kTicks);
  EXPECT_GT(compare(real.states.messages, truth), kTicks);
  EXPECT_EQ(compare(flown, truth), flown.size());
  EXPECT_GT(flown.back().tick, 75u) << "the last input has acted";
  EXPECT_GT((momentumOf(probe(), truth[kTicks]).P_WB - momentumAtStart(probe()).P_WB).norm(), 1)
      << "the inputs acted";
}

}  // namespace
}  // namespace rigid_body_sim

int main(int argc, char** argv) {
  return rigid_body_sim::runRostest(argc, argv, "determinism_test");
}

// What an input means: when it starts and ends, what it replaces, what is refused.
#include <algorithm>

#include "generic.hpp"

namespace rigid_body_sim {
namespace {

const Vector3d kForce(0.7, -1.9, 1.3);
const Vector3d kTorque(0.4, 0.9, -1.6);

Scene scene(const std::string& integrator = "split2") {
  Scene scene = sceneOf(genericSceneBody("a"), integrator);
  scene.bodies.push_back(genericSceneBody("b"));
  for (SceneBody& body : scene.bodies) {
    body.v_WBcm.setZero();
    body.w_WB_L.setZero();
  }
  return scene;
}

WrenchInput push(const Vector3d& f_W, Tick start = 0, Tick ticks = 0) {
  WrenchInput input;
  input.applied.wrench.f_F = f_W;
  input.start = start;
  input.ticks = ticks;
  return input;
}

/// As a topic gives it: held, replacing the same publisher's.
WrenchInput held(double fx, const std::string& source, std::uint64_t sequence,
                 std::uint64_t entry = 0) {
  WrenchInput input = push({fx, 0, 0});
  input.replaces = true;
  input.origin = {source, sequence, entry};
  return input;
}

ImpulseInput knock(const Vector3d& J_W, Tick start = 0) {
  ImpulseInput input;
  input.applied.wrench.f_F = J_W;
  input.start = start;
  return input;
}

void run(Simulator& simulator, Tick ticks) {
  for (Tick i = 0; i < ticks; ++i) simulator.step();
}

/// x component of the force that acted in the next tick on body 0.
double forceInNextTick(Simulator& simulator) {
  const double before = simulator.state(0).P_WB.x();
  simulator.step();
  return (simulator.state(0).P_WB.x() - before) / 0.02;
}

/// Rounding of forces of size ten found that way.
constexpr double kForceRounding = 100 * kEps * 10 / 0.02;

TEST(Impulse, ActsExactlyOnceInItsTick) {
  Simulator simulator(scene());
  simulator.apply(knock(kForce, 3));
  for (Tick tick = 0; tick < 10; ++tick) {
    EXPECT_EQ(simulator.state(0).P_WB, tick <= 3 ? Vector3d(0, 0, 0) : kForce) << tick;
    EXPECT_EQ(simulator.pendingCount(), tick <= 3 ? 1u : 0u);
    simulator.step();
  }
}

TEST(Impulse, OfThePastOrPresentActsInTheNextTick) {
  Simulator simulator(scene());
  run(simulator, 5);
  simulator.apply(knock(kForce, 2));
  simulator.apply(knock(kForce, 5));
  simulator.apply(knock(kForce, -7));
  EXPECT_EQ(simulator.state(0).P_WB, Vector3d(0, 0, 0));
  simulator.step();
  EXPECT_LE(difference(simulator.state(0).P_WB, 3 * kForce), 8 * kEps);
}

TEST(Impulse, MovesTheBodyFromItsTickOn) {
  Simulator simulator(scene());
  const Vector3d p0 = simulator.state(0).p_WBcm;
  simulator.apply(knock(kForce));
  simulator.step();
  EXPECT_LE(difference(simulator.state(0).p_WBcm, p0 + 0.02 * kForce / 2.7), 8 * kEps);
}

TEST(Impulse, OffTheCentreOfMassTurnsTheBodyToo) {
  Simulator simulator(scene());
  ImpulseInput input = knock(kForce);
  input.applied.wrench.t_Q_F = kTorque;
  input.applied.p_BcmQ_B << 0.3, -0.2, 0.5;
  const Vector3d arm_W = simulator.state(0).q_WB * input.applied.p_BcmQ_B;
  simulator.apply(input);
  simulator.step();
  const Vector3d expected = kTorque + arm_W.cross(kForce);
  EXPECT_LE(difference(simulator.state(0).L_WBcm_W, expected), 8 * kEps * expected.norm());
}

TEST(Impulse, AlwaysAdds) {
  Simulator simulator(scene());
  for (int i = 0; i < 1000; ++i) simulator.apply(knock(kForce, i / 10));
  run(simulator, 101);
  EXPECT_LE(difference(simulator.state(0).P_WB, 1000 * kForce), 1e-12 * 1000 * kForce.norm());
}

TEST(Wrench, OfSomeTicksGivesForceTimesDuration) {
  // split2 adds half a kick twice a tick: 2 n sums, each off by half an ulp of at most the end's
  // size, and the half kick by half an ulp itself. The velocity methods go to velocity and back:
  // five roundings a tick.
  for (const IntegratorRow& row : integrators()) {
    for (const Tick n : {1, 7, 100}) {
      for (const Tick start : {0, 13}) {
        Simulator simulator(scene(row.name));
        WrenchInput input = push(kForce, start, n);
        simulator.apply(input);
        run(simulator, start + n + 20);
        const Vector3d expected = static_cast<double>(n) * 0.02 * kForce;
        EXPECT_LE(difference(simulator.state(0).P_WB, expected),
                  static_cast<double>(3 * n + 1) * kEps * expected.norm())
            << row.name << " " << n << " ticks from " << start;
      }
    }
  }
}

TEST(Wrench, OfSomeTicksGivesTorqueTimesDuration) {
  for (const Tick n : {1, 7, 100}) {
    Simulator simulator(scene());
    WrenchInput input = push({0, 0, 0}, 4, n);
    input.applied.wrench.t_Q_F = kTorque;
    simulator.apply(input);
    run(simulator, n + 20);
    const Vector3d expected = static_cast<double>(n) * 0.02 * kTorque;
    EXPECT_LE(difference(simulator.state(0).L_WBcm_W, expected),
              static_cast<double>(n + 1) * kEps * expected.norm());
  }
}

TEST(Wrench, GivesTheSameBitsWhetherItStartsAtOnceOrLater) {
  Simulator at_once(scene()), later(scene());
  at_once.apply(push(kForce, 0, 9));
  later.apply(push(kForce, 31, 9));
  run(at_once, 9);
  run(later, 40);
  EXPECT_TRUE(sameBits(at_once.state(0).P_WB, later.state(0).P_WB));
}

TEST(Wrench, WaitsForItsStartAndEndsAfterItsTicks) {
  Simulator simulator(scene());
  simulator.apply(push({10, 0, 0}, 3, 2));
  for (Tick tick = 0; tick < 8; ++tick) {
    const bool acts = tick == 3 || tick == 4;
    EXPECT_NEAR(forceInNextTick(simulator), acts ? 10 : 0, kForceRounding) << tick;
    EXPECT_EQ(simulator.pendingCount(), tick < 3 ? 1u : 0u) << tick;
    EXPECT_EQ(simulator.heldWrenches().size(), acts ? 1u : 0u) << tick;
    EXPECT_EQ(simulator.endedWrenches().size(), tick == 5 ? 1u : 0u) << tick;
  }
}

TEST(Wrench, WithoutDurationActsUntilItIsReplaced) {
  Simulator simulator(scene());
  simulator.apply(held(10, "topic", 1));
  run(simulator, 1000);
  EXPECT_NEAR(forceInNextTick(simulator), 10, 2000 * kForceRounding);
}

TEST(Wrench, OfTheSameSourceReplaces) {
  Simulator simulator(scene());
  simulator.apply(held(10, "topic", 1));
  EXPECT_NEAR(forceInNextTick(simulator), 10, kForceRounding);
  simulator.apply(held(4, "topic", 2));
  EXPECT_NEAR(forceInNextTick(simulator), 4, kForceRounding);
  EXPECT_EQ(simulator.heldWrenches().size(), 1u);
  EXPECT_TRUE(simulator.endedWrenches().empty());  // replaced is not run out
}

TEST(Wrench, OfAnotherSourceAdds) {
  Simulator simulator(scene());
  simulator.apply(held(10, "topic /one", 1));
  simulator.apply(held(4, "topic /two", 1));
  simulator.apply(held(0.5, "topic /three", 9));
  EXPECT_NEAR(forceInNextTick(simulator), 14.5, kForceRounding);
  simulator.apply(held(1, "topic /two", 2));
  EXPECT_NEAR(forceInNextTick(simulator), 11.5, kForceRounding);
}

TEST(Wrench, ForcesAtSeveralPointsGiveTheirSumAndTheSumOfTheirMoments) {
  // F = sum f and t = sum r x f. Held for one tick of a nanosecond, in which no arm turns.
  Scene short_scene = scene();
  short_scene.step_ns = 1;
  Simulator simulator(short_scene);
  const Matrix3d R_WB = simulator.state(0).q_WB.toRotationMatrix();
  Sampler sample(43);
  Vector3d f_W = Vector3d::Zero(), t_W = Vector3d::Zero();
  for (std::uint64_t i = 0; i < 5; ++i) {
    WrenchInput input = push(3 * sample.vector(), 0, 1);
    input.applied.p_BcmQ_B = sample.vector();
    input.origin.entry = i;
    simulator.apply(input);
    f_W += input.applied.wrench.f_F;
    t_W += (R_WB * input.applied.p_BcmQ_B).cross(input.applied.wrench.f_F);
  }
  simulator.step();
  EXPECT_LE(difference(simulator.state(0).P_WB / 1e-9, f_W), 64 * kEps);
  EXPECT_LE(difference(simulator.state(0).L_WBcm_W / 1e-9, t_W), 64 * kEps);
}

TEST(Wrench, EntriesOfOneMessageAddAndAreReplacedTogether) {
  Simulator simulator(scene());
  for (std::uint64_t entry = 0; entry < 3; ++entry) simulator.apply(held(2, "topic", 1, entry));
  EXPECT_NEAR(forceInNextTick(simulator), 6, kForceRounding);
  simulator.apply(held(5, "topic", 2));
  EXPECT_NEAR(forceInNextTick(simulator), 5, kForceRounding);
}

TEST(Wrench, ThatDoesNotReplaceNeitherEndsNorIsEnded) {
  Simulator simulator(scene());
  WrenchInput scheduled = held(10, "topic", 1);
  scheduled.replaces = false;
  simulator.apply(scheduled);
  simulator.apply(held(4, "topic", 2));
  EXPECT_NEAR(forceInNextTick(simulator), 14, kForceRounding);
  scheduled.origin.sequence = 3;
  simulator.apply(scheduled);
  EXPECT_NEAR(forceInNextTick(simulator), 24, kForceRounding);
}

TEST(Wrench, OnAnotherBodyReplacesNothingHere) {
  Simulator simulator(scene());
  simulator.apply(held(10, "topic", 1));
  WrenchInput other = held(4, "topic", 2);
  other.body = 1;
  simulator.apply(other);
  EXPECT_NEAR(forceInNextTick(simulator), 10, kForceRounding);
  EXPECT_NEAR(simulator.state(1).P_WB.x(), 4 * 0.02, 4 * kEps);
}

TEST(Wrench, OfTwoMessagesInOneTickTheLaterCounts) {
  for (const bool later_first : {false, true}) {
    Simulator simulator(scene());
    simulator.apply(held(later_first ? 4 : 10, "topic", later_first ? 2 : 1));
    simulator.apply(held(later_first ? 10 : 4, "topic", later_first ? 1 : 2));
    EXPECT_NEAR(forceInNextTick(simulator), 4, kForceRounding);
  }
}

TEST(Wrench, OfASenderThatGoesOnWhileNothingIsSteppedWaitsAlone) {
  Simulator simulator(scene());
  for (std::uint64_t i = 1; i <= 1000; ++i) {
    simulator.apply(held(static_cast<double>(i), "topic", i));
    simulator.apply(held(1, "topic", i, 1));
  }
  EXPECT_LE(simulator.pendingCount(), 20u);  // the two entries of the last message, and some more
  EXPECT_NEAR(forceInNextTick(simulator), 1001, 1001 * kForceRounding);
}

TEST(Wrench, OfZeroEndsTheOneBefore) {
  Simulator simulator(scene());
  simulator.apply(held(10, "topic", 1));
  simulator.step();
  simulator.apply(held(0, "topic", 2));
  EXPECT_EQ(forceInNextTick(simulator), 0);
  EXPECT_TRUE(simulator.heldWrenches().empty());
}

TEST(Wrench, OfZeroIsBitIdenticalToNone) {
  for (const IntegratorRow& row : integrators()) {
    Scene moving = sceneOf(genericSceneBody("a"), row.name);
    moving.bodies[0].v_WBcm << -0.0, 1, 2;  // -0 + 0 is 0: that would show
    Simulator without(moving), with(moving);
    with.apply(held(0, "topic", 1));
    with.apply(knock({0, 0, 0}));
    run(without, 50);
    run(with, 50);
    EXPECT_TRUE(sameBits(without.state(0), with.state(0))) << row.name;
  }
}

TEST(Inputs, GiveTheSameBitsInWhateverOrderTheyArrive) {
  // Forces of very different size: another order of summation would round differently.
  Sampler sample(29);
  std::vector<WrenchInput> wrenches;
  std::vector<ImpulseInput> impulses;
  for (std::uint64_t i = 0; i < 24; ++i) {
    WrenchInput wrench;
    wrench.body = static_cast<Eigen::Index>(i % 2);
    wrench.applied = {i % 3 ? Axes::kBody : Axes::kWorld,
                      {std::exp2(sample.between(-10, 10)) * sample.vector(), sample.vector()},
                      sample.vector()};
    wrench.start = static_cast<Tick>(i % 4);
    wrench.ticks = static_cast<Tick>(i % 5) * 3;
    wrench.replaces = i % 2;
    wrench.origin = {"publisher " + std::to_string(i % 4), i / 8, i};
    wrenches.push_back(wrench);
    ImpulseInput impulse;
    impulse.body = wrench.body;
    impulse.applied = wrench.applied;
    impulse.start = wrench.start;
    impulse.origin = wrench.origin;
    impulses.push_back(impulse);
  }
  std::vector<BodyState> first;
  std::mt19937 shuffler(31);
  for (int round = 0; round < 10; ++round) {
    Simulator simulator(scene());
    for (const WrenchInput& input : wrenches) simulator.apply(input);
    for (const ImpulseInput& input : impulses) simulator.apply(input);
    run(simulator, 40);
    if (round == 0) first = {simulator.state(0), simulator.state(1)};
    EXPECT_TRUE(sameBits(simulator.state(0), first[0])) << round;
    EXPECT_TRUE(sameBits(simulator.state(1), first[1])) << round;
    std::shuffle(wrenches.begin(), wrenches.end(), shuffler);
    std::shuffle(impulses.begin(), impulses.end(), shuffler);
  }
}

TEST(Inputs, ThatAreBadAreRefusedAndChangeNothing) {
  Simulator simulator(scene()), untouched(scene());
  const auto refuse = [&](const auto& input, const std::string& part) {
    EXPECT_TRUE(contains(refusal([&] { simulator.apply(input); }), {part}));
  };
  for (const Eigen::Index body : {-1, 2, 1000000}) {
    WrenchInput wrench = push(kForce);
    ImpulseInput impulse = knock(kForce);
    wrench.body = impulse.body = body;
    refuse(wrench, "no body " + std::to_string(body));
    refuse(impulse, "no body " + std::to_string(body));
  }
  for (const double bad : {kNaN, kInf, -kInf}) {
    for (int i = 0; i < 9; ++i) {
      WrenchInput wrench = push(kForce);
      Vector3d* const parts[] = {&wrench.applied.wrench.f_F, &wrench.applied.wrench.t_Q_F,
                                 &wrench.applied.p_BcmQ_B};
      (*parts[i / 3])(i % 3) = bad;
      ImpulseInput impulse;
      impulse.applied = wrench.applied;
      refuse(wrench, "not finite");
      refuse(impulse, "not finite");
    }
  }
  refuse(push(kForce, 0, -1), "negative number of ticks");
  EXPECT_EQ(simulator.pendingCount(), 0u);
  run(simulator, 3);
  run(untouched, 3);
  EXPECT_TRUE(sameBits(simulator.state(0), untouched.state(0)));
  EXPECT_TRUE(sameBits(simulator.state(1), untouched.state(1)));
}

}  // namespace
}  // namespace rigid_body_sim

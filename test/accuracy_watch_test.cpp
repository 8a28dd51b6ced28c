// What a running simulation says of its accuracy, and what it does about it.
#include "core/accuracy_watch.hpp"

#include "accuracy_scenes.hpp"

namespace rigid_body_sim {
namespace {

/// A thruster's body and a free one, to 1e-4 rad over ten seconds.
Scene pair(bool replan) {
  Scene scene = swarmScene(2).scene;
  scene.accuracy = Budget();
  scene.accuracy->attitude_rad = 1e-4;
  scene.accuracy->over_s = 10;
  scene.accuracy->replan = replan;
  return scene;
}

ImpulseInput spinUp(Eigen::Index body) {
  ImpulseInput input;
  input.body = body;
  input.applied.wrench.t_Q_F << 9, -14, 12;
  return input;
}

void run(Simulator& simulator, int ticks) {
  for (int k = 0; k < ticks; ++k) simulator.step();
}

const Method& methodOf(const Simulator& simulator, Eigen::Index body) {
  for (const MethodOfBodies& part : simulator.scene().methods)
    for (const Eigen::Index one : part.bodies)
      if (one == body) return part.method;
  throw std::logic_error("no method");
}

TEST(AccuracyWatch, LooksAtOneBodyAfterTheOtherEveryThirtyTicks) {
  Simulator simulator(pair(false));
  EXPECT_FALSE(simulator.accuracy()->latest);
  std::vector<Eigen::Index> bodies;
  std::vector<Tick> ticks;
  for (int k = 0; k < 90; ++k) {
    const std::size_t before = simulator.accuracy()->samples;
    simulator.step();
    if (simulator.accuracy()->samples == before) continue;
    bodies.push_back(simulator.accuracy()->latest->body);
    ticks.push_back(simulator.accuracy()->latest->tick);
  }
  EXPECT_EQ(bodies, (std::vector<Eigen::Index>{0, 1, 0, 1, 0, 1}));
  EXPECT_EQ(ticks, (std::vector<Tick>{0, 15, 30, 45, 60, 75}));
}

TEST(AccuracyWatch, LooksAtNoMoreThanOneBodyATick) {
  Scene scene = swarmScene(50).scene;
  scene.effects.clear();
  scene.accuracy = pair(false).accuracy;
  Simulator simulator(scene);
  run(simulator, 120);
  EXPECT_EQ(simulator.accuracy()->samples, 120u);
}

TEST(AccuracyWatch, OfASceneWithoutABudgetIsNotThere) {
  Scene scene = pair(false);
  scene.accuracy.reset();
  EXPECT_EQ(Simulator(scene).accuracy(), nullptr);
}

TEST(AccuracyWatch, ChangesNoBitOfTheMotion) {
  Simulator watched(pair(false));
  Scene scene = watched.scene();
  scene.accuracy.reset();
  Simulator plain(scene);  // by the same methods
  for (Simulator* simulator : {&watched, &plain}) {
    run(*simulator, 50);
    simulator->apply(spinUp(0));
    run(*simulator, 100);
  }
  for (Eigen::Index i : {0, 1}) EXPECT_TRUE(sameBits(watched.state(i), plain.state(i)));
}

TEST(AccuracyWatch, SaysWhenAnInputBreaksTheBudget) {
  Simulator simulator(pair(false));
  run(simulator, 100);
  EXPECT_TRUE(simulator.accuracy()->keepsBudget());
  const Deviation before = simulator.accuracy()->worst_now->error;
  simulator.apply(spinUp(0));
  simulator.step();
  const AccuracyState& now = *simulator.accuracy();
  EXPECT_FALSE(now.keepsBudget());
  EXPECT_EQ(now.worst_now->body, 0);
  EXPECT_GT(now.worst_now->error.attitude_rad, 10 * before.attitude_rad);
  EXPECT_GT(now.worst_now->predicted.attitude_rad, 1e-4);
  EXPECT_EQ(now.bills, 1);
  EXPECT_TRUE(contains(toText(*now.worst_now, simulator.scene()), {"body_0: ", "in tick"}));
}

/// The error over ten seconds from here, against the truth from here.
double errorFromHere(Simulator& simulator) {
  Scene here = simulator.scene();
  here.accuracy.reset();
  const AppliedWrenches none;
  const Part start = wholeOf({here, simulator.bodies(), none, simulator.tick()});
  StepCount steps;
  const Trajectory truth = flyTruly(start, 500, 1, steps).trajectory;
  double worst = 0;
  for (std::size_t k = 1; k <= 500; ++k) {
    simulator.step();
    for (Eigen::Index i : {0, 1})
      worst = std::max(worst, deviation(simulator.bodies(), truth.samples[k], i).attitude_rad);
  }
  return worst;
}

TEST(AccuracyWatch, ReplansSoThatTheBudgetIsKeptAgain) {
  Simulator left(pair(false)), replanned(pair(true));
  for (Simulator* simulator : {&left, &replanned}) {
    run(*simulator, 100);
    simulator->apply(spinUp(0));
    simulator->step();  // which takes the new method already
  }
  EXPECT_EQ(replanned.accuracy()->bills, 2);
  EXPECT_FALSE(methodOf(replanned, 0) == methodOf(left, 0));
  EXPECT_TRUE(methodOf(replanned, 1) == methodOf(left, 1));
  EXPECT_TRUE(replanned.accuracy()->keepsBudget());
  EXPECT_GT(errorFromHere(left), 1e-4);
  EXPECT_LE(errorFromHere(replanned), 1e-4);
  EXPECT_EQ(replanned.accuracy()->bills, 2);
}

TEST(AccuracyWatch, ReplansTheSameWayEachTime) {
  std::vector<BodyState> ends;
  std::string bill;
  for (int round = 0; round < 2; ++round) {
    Simulator simulator(pair(true));
    run(simulator, 100);
    simulator.apply(spinUp(0));
    run(simulator, 200);
    ASSERT_EQ(simulator.accuracy()->bills, 2);
    const std::string text = toText(simulator.accuracy()->bill, simulator.scene());
    if (round == 0) {
      ends = {simulator.state(0), simulator.state(1)};
      bill = text;
    }
    EXPECT_EQ(text, bill);
    for (Eigen::Index i : {0, 1}) EXPECT_TRUE(sameBits(simulator.state(i), ends[i]));
  }
}

TEST(AccuracyWatch, TakesTheWrenchesThatAreHeldIntoTheNewPlan) {
  Simulator simulator(pair(true));
  run(simulator, 20);
  WrenchInput input;
  input.body = 1;  // free until now, and stepped exactly
  input.applied = {Axes::kBody, {{0, 0, 0}, {0.5, 0.3, -0.4}}, Vector3d::Zero()};
  const Method before = methodOf(simulator, 1);
  simulator.apply(input);
  run(simulator, 60);
  EXPECT_EQ(simulator.accuracy()->bills, 2);
  EXPECT_FALSE(methodOf(simulator, 1) == before) << toText(before);
  EXPECT_TRUE(simulator.accuracy()->keepsBudget());
}

TEST(AccuracyWatch, KeepsTheBestWhereNothingKeepsTheBudget) {
  Scene scene = pair(true);
  scene.accuracy->attitude_rad = 3e-12;
  Simulator simulator(scene);
  run(simulator, 20);
  ImpulseInput input = spinUp(0);
  input.applied.wrench.t_Q_F *= 10;  // some 4 rad a tick: the reference's doubt alone is too much
  simulator.apply(input);
  EXPECT_NO_THROW(run(simulator, 40));  // it is not tried again for a second
  const AccuracyState& now = *simulator.accuracy();
  EXPECT_EQ(now.bills, 2);
  const auto hopeless = [](const ClassBill& one) { return !one.keeps_budget; };
  const auto& classes = now.bill.classes;
  EXPECT_TRUE(std::any_of(classes.begin(), classes.end(), hopeless));
  EXPECT_TRUE(contains(toText(now.bill, simulator.scene()), {"BREAKS THE BUDGET"}));
}

/// A body that is free until somebody pushes it, to 1e-4 rad in a minute.
Scene freeUntilPushed(bool replan) {
  SceneBody body = genericSceneBody("box");
  body.w_WB_L << 1, 2, 3;
  Scene scene = sceneOf(body);
  scene.accuracy = Budget();
  scene.accuracy->attitude_rad = 1e-4;
  scene.accuracy->over_s = 60;
  scene.accuracy->replan = replan;
  return scene;
}

WrenchInput burst(Tick ticks) {
  WrenchInput input;
  input.applied = {Axes::kBody, {{0, 0, 0}, {16, -8, 16}}, Vector3d::Zero()};
  input.start = 203;
  input.ticks = ticks;
  return input;
}

class AfterABurst : public testing::TestWithParam<int> {};

TEST_P(AfterABurst, WhatItIsOffByIsMeasuredAndStaysKnown) {
  Simulator simulator(freeUntilPushed(false));
  Scene true_scene = withMethod(freeUntilPushed(false), {"adaptive", 1, 1e-14});
  Simulator truth(true_scene);
  for (Simulator* one : {&simulator, &truth}) {
    one->apply(burst(GetParam()));
    run(*one, 203);
  }
  EXPECT_TRUE(simulator.accuracy()->keepsBudget());
  double worst = 0;
  for (int tick = 203; tick < 3000; ++tick) {
    simulator.step();
    truth.step();
    const double error = deviation(simulator.bodies(), truth.bodies(), 0).attitude_rad;
    worst = std::max(worst, error);
    ASSERT_TRUE(simulator.accuracy()->spent);
    // Rounding of the two truths, some kEps a tick that grow with the square of the time.
    ASSERT_NEAR(simulator.accuracy()->spent->error.attitude_rad, error, 1e-9) << tick;
  }
  EXPECT_GT(worst, 1.3e-4) << "this burst should break the budget";
  ASSERT_TRUE(simulator.accuracy()->broken);
  EXPECT_FALSE(simulator.accuracy()->keepsBudget());
  EXPECT_EQ(simulator.accuracy()->broken->since, 203);
  EXPECT_TRUE(contains(toText(*simulator.accuracy()->broken, simulator.scene()),
                       {"box: ", "by inputs since tick 203"}));
  simulator.reset();
  EXPECT_TRUE(simulator.accuracy()->keepsBudget());
}

TEST_P(AfterABurst, ANewMethodKeepsTheBudget) {
  Simulator simulator(freeUntilPushed(true));
  simulator.apply(burst(GetParam()));
  run(simulator, 3000);
  EXPECT_EQ(simulator.accuracy()->bills, 2);
  ASSERT_TRUE(simulator.accuracy()->spent);
  EXPECT_LE(simulator.accuracy()->spent->error.attitude_rad, 1e-4);
  EXPECT_TRUE(simulator.accuracy()->keepsBudget());
}

INSTANTIATE_TEST_SUITE_P(OfTicks, AfterABurst, testing::Values(1, 3, 10, 50));

/// Pulls bodies 1 and 2 of three together; the first one is free.
class TetherOfTheLastTwo : public Effect {
 public:
  std::string name() const override { return "tether"; }
  std::size_t bodyCount() const override { return 2; }
  void addWrenches(const Instant& now, Wrenches& wrenches) const override {
    const Vector3d pull = 0.3 * (now.bodies().p_WBcm.row(2) - now.bodies().p_WBcm.row(1));
    wrenches.f_W.row(1) += pull;
    wrenches.f_W.row(2) -= pull;
  }
  std::shared_ptr<const Effect> restrictedTo(
      const std::vector<Eigen::Index>& bodies) const override {
    const bool is_first = bodies == std::vector<Eigen::Index>{0};
    return is_first ? std::make_shared<None>() : nullptr;
  }

 private:
  class None : public Effect {
   public:
    std::string name() const override { return "tether"; }
    std::size_t bodyCount() const override { return 0; }
    void addWrenches(const Instant&, Wrenches&) const override {}
  };
};

TEST(AccuracyWatch, LooksAtAndReplansTheWholeIfAnyBodyCannotBeHadAlone) {
  for (const Eigen::Index pushed : {0, 1, 2}) {
    Scene scene = swarmScene(3).scene;
    scene.effects = {std::make_shared<TetherOfTheLastTwo>()};
    scene.accuracy = pair(true).accuracy;
    scene.accuracy->position_m = 1e-4;
    Simulator simulator(scene);
    run(simulator, 20);
    ImpulseInput input = spinUp(pushed);
    input.applied.wrench.f_F << 300, -200, 100;
    simulator.apply(input);
    const AccuracyState& now = *simulator.accuracy();
    for (int k = 0; k < 100; ++k) {
      simulator.step();
      EXPECT_EQ(now.latest->body, 0) << "the whole stands for its first body";
    }
    EXPECT_GT(now.samples, 1u);
    EXPECT_EQ(now.bill.classes.size(), 1u) << pushed;
    EXPECT_EQ(now.bill.classes[0].bodies.size(), 3u) << pushed;
  }
}

TEST(AccuracyWatch, ForgetsItsNewPlanWithTheReset) {
  Simulator simulator(pair(true)), fresh(pair(true));
  run(simulator, 10);
  simulator.apply(spinUp(0));
  run(simulator, 40);
  ASSERT_EQ(simulator.accuracy()->bills, 2);
  simulator.reset();
  EXPECT_EQ(simulator.accuracy()->bills, 3);
  EXPECT_EQ(simulator.accuracy()->samples, 0u);
  for (Eigen::Index i : {0, 1}) EXPECT_TRUE(methodOf(simulator, i) == methodOf(fresh, i));
  run(simulator, 40);
  run(fresh, 40);
  for (Eigen::Index i : {0, 1}) EXPECT_TRUE(sameBits(simulator.state(i), fresh.state(i)));
  EXPECT_EQ(simulator.accuracy()->samples, fresh.accuracy()->samples);
}

}  // namespace
}  // namespace rigid_body_sim

// What each row of the registry promises, measured. A new row joins by being there.
#include "integrator_laws.hpp"

#include <cmath>

#include "allocation_count.hpp"
#include "reference/free_rotation.hpp"

namespace rigid_body_sim {
namespace {

TEST_P(IntegratorLaws, AStepBackUndoesAStepIfSoStatedAndOnlyThen) {
  if (GetParam().order == 0) return;
  const AppliedWrench applied = {Axes::kWorld, {{1.7, -0.2, 1.4}, {0, 0, 0}}, {0.8, -0.5, 0.6}};
  const Push push(applied);
  Bodies bodies = bodiesOf(reference::caseNamed("tumbling_stone"));
  const BodyState start = bodies.state(0);
  ActiveEffects effects;
  effects.add(&push);
  const auto integrator = make();
  const int steps = 20;
  const double h = 0.2;
  for (int i = 0; i < steps; ++i) integrator->step(bodies, effects, i * h, h);
  EXPECT_GT(distance(bodies.state(0), start), 1);
  for (int i = steps; i > 0; --i) integrator->step(bodies, effects, i * h, -h);
  // Rounding, some kEps of numbers up to 10 a step; the push spreads it.
  const double back = distance(bodies.state(0), start);
  RecordProperty("back", std::to_string(back * 1e12) + "e-12");
  if (GetParam().is_reversible)
    EXPECT_LE(back, 1e-11);
  else
    EXPECT_GE(back, 1e-9);
}

TEST_P(IntegratorLaws, UpToTheLargestTurnEnergyDoesNotGrow) {
  const double turn = GetParam().max_turn;
  if (std::isinf(turn)) return;
  Bodies bodies = bodiesOf(reference::caseNamed("tumbling_stone"));
  const double w = angularVelocityInBody(bodies.state(0), bodies.moments(0)).norm();
  const double start = energy(bodies);
  const auto integrator = make();
  ActiveEffects none;
  const int steps = GetParam().order == 0 ? 20 : 1000;  // of up to a thousand steps each
  for (int i = 0; i < steps; ++i) {
    integrator->step(bodies, none, 0, turn / w);
    ASSERT_LE(energy(bodies), 1.01 * start) << i;
    ASSERT_GE(energy(bodies), 0.5 * start) << i;
  }
}

TEST_P(IntegratorLaws, SphereTurnsAtAConstantRateToRounding) {
  const reference::Case& sphere = reference::caseNamed("sphere");
  const int steps = 500;
  const auto exact =
      reference::symmetricTop(sphere.I_BBcm_B, {genericAttitude(), sphere.w_WB_B}, steps * 0.02);
  const BodyState end = run(sphere, nullptr, steps * 0.02, steps);
  EXPECT_LE(angleBetween(end.q_WB, exact.q_WB), steadyTurnRounding(steps, sphere.w_WB_B));
}

TEST_P(IntegratorLaws, BodyOnAPrincipalAxisTurnsAtAConstantRateToRounding) {
  reference::Case one = reference::caseNamed("tumbling_stone");
  for (const int axis : {0, 2}) {  // the middle one is unstable
    one.w_WB_B = 4 * Vector3d::Unit(axis);
    const int steps = 500;
    const BodyState end = run(one, nullptr, steps * 0.02, steps);
    const Vector3d turn = steps * 0.02 * 4 * (genericAttitude() * Vector3d::Unit(axis));
    EXPECT_LE(angleBetween(end.q_WB, rotationExp(turn) * genericAttitude()),
              steadyTurnRounding(steps, one.w_WB_B));
  }
}

TEST_P(IntegratorLaws, CentreOfMassOfAFreeBodyMovesInAStraightLine) {
  const reference::Case& one = reference::caseNamed("tumbling_stone");
  const int steps = 500;
  const BodyState end = run(one, nullptr, steps * 0.02, steps);
  const Vector3d expected = steps * 0.02 * Vector3d(0.3, -0.8, 0.5) / one.mass;
  EXPECT_LE(difference(end.p_WBcm, expected), steps * kEps * expected.norm());
}

TEST_P(IntegratorLaws, WithoutTheGyroscopicTermEveryBodyTurnsAtAConstantRate) {
  for (const reference::Case& one : reference::cases()) {
    if (one.name == "thin_rod") continue;      // its spin is lost in the rounding of L
    if (one.name == "fast_spinner") continue;  // 1.9 rad a step: polynomials cannot follow
    Bodies bodies = bodiesOf(one);
    const Vector3d w_WB = angularVelocity(bodies.state(0), one.I_BBcm_B);
    const auto integrator = make(Gyroscopic::kOff);
    ActiveEffects none;
    const int steps = 500;
    for (int i = 0; i < steps; ++i) integrator->step(bodies, none, i * 0.02, 0.02);
    EXPECT_LE(difference(angularVelocity(bodies.state(0), one.I_BBcm_B), w_WB),
              steps * 2 * kEps * w_WB.norm())
        << one.name;
    EXPECT_LE(
        angleBetween(bodies.state(0).q_WB, rotationExp(steps * 0.02 * w_WB) * genericAttitude()),
        steps * kEps * 0.02 * steps * w_WB.norm())  // each rate's error turns it ever after
        << one.name;
  }
}

TEST_P(IntegratorLaws, AngularMomentumStaysToTheBitIfSoStated) {
  if (!GetParam().keeps_angular_momentum) return;
  for (const reference::Case& one : reference::cases()) {
    const BodyState end = run(one, nullptr, 5000 * 0.02, 5000);
    EXPECT_TRUE(sameBits(end.L_WBcm_W, bodiesOf(one).state(0).L_WBcm_W)) << one.name;
    EXPECT_NEAR(end.q_WB.squaredNorm(), 1, 4 * kEps) << one.name;
  }
}

TEST_P(IntegratorLaws, EnergyStaysBoundedWithoutATrendIfSoStated) {
  if (!GetParam().bounded_energy) return;
  Bodies bodies = bodiesOf(reference::caseNamed("dzhanibekov"));
  const Vector3d L_W = bodies.L_WBcm_W.row(0);
  const double start = energy(bodies);
  const auto integrator = make();
  ActiveEffects none;
  std::vector<double> worst;  // relative, in each minute of ten
  for (int step = 0; step < 30000; ++step) {
    if (step % 3000 == 0) worst.push_back(0);
    integrator->step(bodies, none, step * 0.02, 0.02);
    worst.back() = std::max(worst.back(), std::abs(energy(bodies) / start - 1));
    const Vector3d L_now = bodies.L_WBcm_W.row(0);
    ASSERT_LE((L_now - L_W).norm(), 1e-12 * L_W.norm());
  }
  RecordProperty("first_minute", std::to_string(worst.front() * 1e6) + "e-6");
  RecordProperty("last_minute", std::to_string(worst.back() * 1e6) + "e-6");
  // The body turns over some twenty times a minute, and the error peaks at each turn: a minute's
  // maximum is the peak, sampled every 0.02 s. A trend would add to it minute by minute. Rounding
  // walks by some kEps a step.
  const auto [least, most] = std::minmax_element(worst.begin(), worst.end());
  EXPECT_LE(*most, 1.1 * *least + 30000 * kEps);
  EXPECT_LE(*most, 2e-4);  // measured for split2: 1.195e-4 in every minute
}

TEST_P(IntegratorLaws, EvaluationsOfTheEffectsAreAsManyAsStated) {
  const Push push({Axes::kBody, {{1, 0, 0}, {0, 1, 0}}, {0, 0, 1}});
  if (GetParam().evaluations == 0) return;  // as many as it needs
  run(reference::caseNamed("tumbling_stone"), &push, 1, 50);
  EXPECT_EQ(push.evaluations, 50 * GetParam().evaluations);
}

TEST_P(IntegratorLaws, StepsAllocateNothingAfterTheFirst) {
#ifndef COUNTS_ALLOCATIONS
  GTEST_SKIP() << "allocations cannot be counted here";
#else
  const long before_any = allocation_count;
  std::make_unique<Bodies>(7)->mass(0) = 1;
  ASSERT_GE(allocation_count, before_any + 7);  // the counter sees new and Eigen

  const Push push({Axes::kBody, {{1, 0, 0}, {0, 1, 0}}, {0, 0, 1}});
  for (const Gyroscopic gyroscopic : {Gyroscopic::kOn, Gyroscopic::kOff}) {
    Bodies bodies = bodiesOf(reference::caseNamed("tumbling_stone"));
    ActiveEffects effects;
    effects.add(&push);
    const auto integrator = make(gyroscopic);
    integrator->step(bodies, effects, 0, 0.02);
    const long before = allocation_count;
    for (int i = 1; i < 100; ++i) integrator->step(bodies, effects, i * 0.02, 0.02);
    EXPECT_EQ(allocation_count, before);
  }

  Scene scene = sceneOf(genericSceneBody("b"), GetParam().name);
  scene.effects.push_back(uniformGravity({0, 0, -9.8}, {0}));
  Simulator simulator(scene);
  WrenchInput input;
  input.applied.wrench.f_F << 1, 2, 3;
  simulator.apply(input);
  simulator.step();
  const long before = allocation_count;
  for (int i = 0; i < 100; ++i) simulator.step();
  EXPECT_EQ(allocation_count, before);
#endif
}

TEST_P(IntegratorLaws, BodiesDoNotKnowOfEachOther) {
  // The same bits alone and in company.
  const reference::Case& one = reference::caseNamed("tumbling_stone");
  Bodies three(3);
  for (int i = 0; i < 3; ++i) {
    const Bodies other = bodiesOf(i == 1 ? one : reference::caseNamed("dzhanibekov"));
    three.mass(i) = other.mass(0);
    three.I_BBcm_B.row(i) = other.I_BBcm_B.row(0);
    three.setState(i, other.state(0));
  }
  ActiveEffects none;
  const auto integrator = make();
  for (int i = 0; i < 100; ++i) integrator->step(three, none, i * 0.02, 0.02);
  EXPECT_TRUE(sameBits(three.state(1), run(one, nullptr, 2, 100)));
}

TEST_P(IntegratorLaws, IsFoundByItsName) {
  EXPECT_EQ(integratorNamed(GetParam().name).name, GetParam().name);
  EXPECT_EQ(integratorNamed(GetParam().name).make, GetParam().make);
  EXPECT_FALSE(GetParam().summary.empty());
}

INSTANTIATE_TEST_SUITE_P(Every, IntegratorLaws, testing::ValuesIn(integrators()), nameOfRow);

TEST(IntegratorNamed, ListsAllThatThereAre) {
  const std::string what = refusal([] { integratorNamed("rk44"); });
  EXPECT_TRUE(contains(what, {"'rk44' is not an integrator"}));
  for (const IntegratorRow& row : integrators()) EXPECT_TRUE(contains(what, {row.name}));
}

}  // namespace
}  // namespace rigid_body_sim

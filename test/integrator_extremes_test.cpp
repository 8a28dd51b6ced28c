// What no order law sees: bodies that are braked to rest, pushed while they coast, given steps of
// another length, or wrenches that are no numbers. Every row of the registry.
#include <algorithm>
#include <cmath>

#include "integrator_laws.hpp"
#include "reference/free_rotation.hpp"

namespace rigid_body_sim {
namespace {

using reference::Real;
using reference::Vector3r;

class IntegratorExtremes : public IntegratorLaws {
 protected:
  bool isUnitAndFinite(const Bodies& bodies) const {
    return isFinite(bodies.state(0)) &&
           std::abs(bodies.state(0).q_WB.squaredNorm() - 1) <= 8 * kEps;
  }
};

Bodies randomBody(std::mt19937& generator) {
  std::uniform_real_distribution<double> u(0, 1);
  Vector3d I(0.5 + u(generator), 0.5 + u(generator), 0);
  I.z() = std::max(I.x(), I.y()) + 0.8 * u(generator) * std::min(I.x(), I.y());
  std::sort(I.data(), I.data() + 3);
  Bodies bodies(1);
  bodies.mass << 1;
  bodies.I_BBcm_B.row(0) = I;
  BodyState state;
  state.q_WB = genericAttitude();
  state.L_WBcm_W = 3 * Vector3d(u(generator) - 0.5, u(generator) - 0.5, u(generator) - 0.5);
  bodies.setState(0, state);
  return bodies;
}

TEST_P(IntegratorExtremes, ABodyThatIsBrakedToRestKeepsItsAttitude) {
  if (GetParam().order == 1) return;  // too far off to tell
  std::mt19937 generator(5);
  for (int round = 0; round < 40; ++round) {
    Bodies bodies = randomBody(generator);
    const BodyState start = bodies.state(0);
    const Vector3r brake = -start.L_WBcm_W.cast<Real>() / Real(0.2);
    const reference::PushLaw law = [=](Real, const reference::State&) {
      return reference::Push{Vector3r::Zero(), brake};
    };
    const BodyState rest = reference::fly(start, 1, bodies.moments(0), law, 0.2).end;
    const Obeying push(law);
    ActiveEffects braking, none;
    braking.add(&push);
    const auto integrator = make();
    for (int i = 0; i < 10; ++i) integrator->step(bodies, braking, i * 0.02, 0.02);
    EXPECT_TRUE(isUnitAndFinite(bodies)) << round;
    for (int i = 10; i < 20; ++i) integrator->step(bodies, none, i * 0.02, 0.02);
    EXPECT_TRUE(isUnitAndFinite(bodies)) << round;
    // What the second order leaves of 0.2 s; measured: 3e-4 at worst.
    EXPECT_LE(angleBetween(bodies.state(0).q_WB, rest.q_WB), 2e-3) << round;
  }
}

TEST_P(IntegratorExtremes, AStepThatLeavesLittleOfASpinIsNotAlignedWithTheRest) {
  if (GetParam().order < 4) return;
  // A thousandth of L is left, and in body axes m is off by more than that in its direction.
  std::mt19937 generator(7);
  double worst = 0;
  for (int round = 0; round < 40; ++round) {
    Bodies bodies = randomBody(generator);
    BodyState start = bodies.state(0);
    start.L_WBcm_W *= 4;
    bodies.setState(0, start);
    const Vector3r brake = -start.L_WBcm_W.cast<Real>() * (Real(0.999) / Real(0.02));
    const reference::PushLaw law = [=](Real, const reference::State&) {
      return reference::Push{Vector3r::Zero(), brake};
    };
    const BodyState end = reference::fly(start, 1, bodies.moments(0), law, 0.02).end;
    const Obeying push(law);
    ActiveEffects braking;
    braking.add(&push);
    make()->step(bodies, braking, 0, 0.02);
    worst = std::max(worst, angleBetween(bodies.state(0).q_WB, end.q_WB));
  }
  RecordProperty("worst", std::to_string(worst * 1e6) + "e-6");
  // Measured: 2.3e-5 (rk4), 3e-11 (rk8); aligned 1.2e-2 and 2e-7.
  EXPECT_LE(worst, GetParam().order == 4 ? 1e-4 : 1e-9);
}

TEST_P(IntegratorExtremes, ABodyBrakedBelowTheSmallestNumbersIsNotTurned) {
  if (GetParam().order_under_drag == 0 && GetParam().order != 0) return;  // refused at load
  std::mt19937 generator(5);
  Bodies bodies = randomBody(generator);
  const double rate = 50;  // [1/s]
  const auto law = [&](Real, const reference::State& at) {
    return reference::Push{Vector3r::Zero(), Vector3r(-Real(rate) * at.L_WBcm_W)};
  };
  const Obeying push(law);
  ActiveEffects braking;
  braking.add(&push);
  const auto integrator = make();
  for (int i = 0; i < 600; ++i) integrator->step(bodies, braking, i * 0.02, 0.02);
  const Quaterniond before = bodies.state(0).q_WB;  // |L| is some 1e-255 with rk4
  for (int i = 600; i < 1500; ++i) integrator->step(bodies, braking, i * 0.02, 0.02);
  EXPECT_LE(angleBetween(bodies.state(0).q_WB, before), 1e-12);
}

TEST_P(IntegratorExtremes, DragStopsABodyForGood) {
  if (GetParam().order_under_drag == 0 && GetParam().order != 0) return;  // refused at load
  for (const double damping : {0.3, 3.0}) {
    Bodies bodies = bodiesOf(reference::caseNamed("tumbling_stone"));
    const Vector3r I = bodies.moments(0).cast<Real>();
    const reference::PushLaw law = [=](Real, const reference::State& body) {
      const Vector3r w_B = (body.q_WB.conjugate() * body.L_WBcm_W).cwiseQuotient(I);
      return reference::Push{Vector3r::Zero(), -Real(damping) * (body.q_WB * w_B)};
    };
    const Obeying drag(law);
    ActiveEffects effects;
    effects.add(&drag);
    const auto integrator = make();
    double spin = bodies.state(0).L_WBcm_W.norm();
    for (int second = 0; second < 400; ++second) {
      for (int i = 0; i < 50; ++i) integrator->step(bodies, effects, 0, 0.02);
      ASSERT_TRUE(isUnitAndFinite(bodies)) << damping << ", " << second << " s";
      const double now = bodies.state(0).L_WBcm_W.norm();
      ASSERT_LE(now, spin) << damping << ", " << second << " s";
      spin = now;
    }
  }
}

TEST_P(IntegratorExtremes, WrenchesThatAreNoNumbersEndTheStep) {
  for (const double torque : {kNaN, kInf, 1e200, 1e5}) {
    Bodies bodies = bodiesOf(reference::caseNamed("tumbling_stone"));
    const Push push({Axes::kBody, {{torque, 0, 0}, {torque, 1, 2}}, {0, 0, 0}});
    ActiveEffects effects;
    effects.add(&push);
    const auto integrator = make();
    for (int i = 0; i < 3; ++i) integrator->step(bodies, effects, i * 0.02, 0.02);
    EXPECT_LE(push.evaluations, 1'000'000) << torque;  // and it came back at all
  }
}

TEST_P(IntegratorExtremes, ScaleDoesNotCount) {
  // Moments and momenta times a power of two: the same turn, but for where squares underflow.
  const Bodies unit = bodiesOf(reference::caseNamed("tumbling_stone"));
  if (!GetParam().keeps_angular_momentum) return;  // those of velocities invert matrices of I
  const auto flown = [&](double power) {
    Bodies bodies = unit;
    bodies.I_BBcm_B *= std::exp2(power);
    bodies.L_WBcm_W *= std::exp2(power);
    const auto integrator = make();
    ActiveEffects none;
    for (int i = 0; i < 50; ++i) integrator->step(bodies, none, i * 0.02, 0.02);
    return bodies.state(0).q_WB;
  };
  const Quaterniond expected = flown(0);
  for (const double power : {-530, -300, 300, 500})
    EXPECT_LE(angleBetween(flown(power), expected), 100 * kEps) << power;
}

/// Coasting, then a push, then coasting again, each with steps of two lengths: against the truth.
TEST_P(IntegratorExtremes, PushesBetweenFreeFlightsCount) {
  if (GetParam().order == 1) return;
  const reference::Case& one = reference::caseNamed("tumbling_stone");
  Bodies bodies = bodiesOf(one);
  const reference::PushLaw law = lawOf({Axes::kBody, {{0, 0, 0}, {3, -2, 1}}, {0, 0, 0}});
  const Push push({Axes::kBody, {{0, 0, 0}, {3, -2, 1}}, {0, 0, 0}});
  ActiveEffects pushing, none;
  pushing.add(&push);
  const auto integrator = make();
  reference::State truth = reference::extended(bodies.state(0));
  const auto fly = [&](bool is_pushed, double h, int steps) {
    for (int i = 0; i < steps; ++i) integrator->step(bodies, is_pushed ? pushing : none, i * h, h);
    truth = reference::fly(truth, one.mass, one.I_BBcm_B, is_pushed ? law : reference::nothing,
                           h * steps)
                .extended_end;
  };
  for (int round = 0; round < 3; ++round) {
    fly(false, 0.02, 10);
    fly(true, 0.02, 1);
    fly(false, 0.01, 10);
    fly(true, 0.01, 2);
  }
  // Measured: 9.4e-6 (split2), 2.8e-6 (exact), 2.7e-10 (rk4), 4e-13 (exact4), rounding for the
  // rest.
  const double error = angleBetween(bodies.state(0).q_WB, reference::rounded(truth).q_WB);
  RecordProperty("error", std::to_string(error * 1e9) + "e-9");
  EXPECT_LE(error, GetParam().order == 2 ? 2e-5 : 1e-9);
}

TEST_P(IntegratorExtremes, FreeRotationUnderGravityIsTheFreeRotation) {
  if (GetParam().order == 1) return;
  const reference::Case& one = reference::caseNamed("tumbling_stone");
  Bodies bodies = bodiesOf(one), free = bodies;
  const auto gravity = uniformGravity({1, -2, -9.8}, {0});
  ActiveEffects falling, none;
  falling.add(gravity.get());
  const auto integrator = make(), other = make();
  for (int i = 0; i < 500; ++i) {
    integrator->step(bodies, falling, i * 0.02, 0.02);
    other->step(free, none, i * 0.02, 0.02);
  }
  // The same but for roundings: kEps a rotation, which turn the body ever after.
  EXPECT_LE(angleBetween(bodies.state(0).q_WB, free.state(0).q_WB),
            500 * std::max(GetParam().evaluations, 12) * kEps);
  EXPECT_TRUE(sameBits(bodies.state(0).L_WBcm_W, free.state(0).L_WBcm_W));
}

INSTANTIATE_TEST_SUITE_P(Every, IntegratorExtremes, testing::ValuesIn(integrators()), nameOfRow);

TEST(Exact, KeepsTheSpinOfAThinRodUnderTorque) {
  // R^T L would lose it: by 1e-6 rad here. A weak torque across, in body axes.
  const reference::Case& rod = reference::caseNamed("thin_rod");
  const AppliedWrench applied = {Axes::kBody, {{0, 0, 0}, {0, 0.05, 0.02}}, {0, 0, 0}};
  const BodyState start = bodiesOf(rod).state(0);
  const BodyState truth = reference::fly(start, rod.mass, rod.I_BBcm_B, lawOf(applied), 20).end;
  const Push push(applied);
  Bodies bodies = bodiesOf(rod);
  ActiveEffects effects;
  effects.add(&push);
  const auto integrator = integratorNamed("exact6").make({});
  for (int i = 0; i < 1000; ++i) integrator->step(bodies, effects, i * 0.02, 0.02);
  const double error = angleBetween(bodies.state(0).q_WB, truth.q_WB);
  RecordProperty("error", std::to_string(error * 1e12) + "e-12");
  EXPECT_LE(error, 1e-9);
}

TEST(Adaptive, KeepsItsToleranceUpToItsLargestTurnAndNotFarBeyond) {
  const IntegratorRow& row = integratorNamed("adaptive");
  const auto lossOf = [&](double turn) {
    reference::Case plate = reference::caseNamed("tumbling_stone");
    plate.I_BBcm_B = {0.3, 0.9, 1.2};  // of some shapes tried the one that loses most
    plate.w_WB_B = Vector3d(1, -4, 2).normalized() * turn / 0.02;
    Bodies bodies = bodiesOf(plate);
    const double start = energy(bodies);
    ActiveEffects none;
    row.make({})->step(bodies, none, 0, 0.02);
    return std::abs(energy(bodies) / start - 1);
  };
  // A thousand steps, each allowed 4 ulps, of four numbers; measured: 1.2e-12 and 1.1e-8.
  EXPECT_LE(lossOf(row.max_turn), 1000 * 4 * 4 * kEps);
  EXPECT_GE(lossOf(2.5 * row.max_turn), 1e-9);
}

TEST(Adaptive, IsRefusedForASpinThatItsStepsCannotFollow) {
  Scene scene;
  scene.integrator = "adaptive";
  SceneBody body;
  body.name = "top";
  body.mass_properties = {1, Vector3d::Zero(), Vector3d(1, 1.3, 2.1).asDiagonal()};
  body.w_WB_L = Vector3d(0, 0, 1.01 * 200 / scene.step_s());
  scene.bodies = {body};
  EXPECT_TRUE(contains(refusal([&] { Simulator simulator(scene); }),
                       {"rad a step", "'adaptive' bears 200", "2 substeps or more"}));
  scene.substeps = 2;
  EXPECT_NO_THROW(Simulator{scene});
}

TEST(Adaptive, GetsOverAJump) {
  // Dry friction: no step is small enough where the velocity changes its sign.
  const reference::PushLaw law = [](Real, const reference::State& body) {
    return reference::Push{-Real(0.1) * body.P_WB.cwiseSign(), Vector3r::Zero()};
  };
  const Obeying friction(law);
  ActiveEffects effects;
  effects.add(&friction);
  Bodies bodies = bodiesOf(reference::caseNamed("sphere"));
  bodies.P_WB.row(0) << 0.01, -0.02, 0.015;
  const auto integrator = integratorNamed("adaptive").make({});
  for (int i = 0; i < 15; ++i) integrator->step(bodies, effects, i * 0.02, 0.02);
  EXPECT_LE(bodies.P_WB.row(0).norm(), 1e-3);  // stopped after 0.2 s, but for the least steps
}

}  // namespace
}  // namespace rigid_body_sim

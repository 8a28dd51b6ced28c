#include "rigid_body_sim/simulator.hpp"

#include <cmath>

#include "generic.hpp"
#include "rigid_body_sim/conserved.hpp"

namespace rigid_body_sim {
namespace {

void run(Simulator& simulator, int ticks) {
  for (int i = 0; i < ticks; ++i) simulator.step();
}

WrenchInput push(Axes axes, const Wrench& wrench, const Vector3d& p_BcmQ_B = Vector3d::Zero()) {
  WrenchInput input;
  input.applied = {axes, wrench, p_BcmQ_B};
  return input;
}

ImpulseInput knock(const Vector3d& linear, const Vector3d& angular = Vector3d::Zero(),
                   const Vector3d& p_BcmQ_B = Vector3d::Zero()) {
  ImpulseInput input;
  input.applied = {Axes::kWorld, {linear, angular}, p_BcmQ_B};
  return input;
}

SceneBody pointMass(const std::string& name, double mass) {
  SceneBody body;
  body.name = name;
  body.is_point_mass = true;
  body.mass_properties.mass = mass;
  return body;
}

TEST(Simulator, StartsWithTheStateOfTheScene) {
  const SceneBody body = genericSceneBody("b");
  const Simulator simulator(sceneOf(body));
  EXPECT_EQ(simulator.tick(), 0);
  EXPECT_TRUE(sameBits(simulator.state(0), stateOfLink(bodyFrame(body.mass_properties), body.X_WL,
                                                       body.v_WBcm, body.w_WB_L)));
  const LinkMotion link = simulator.linkMotion(0);
  EXPECT_LE(difference(link.p_WL, body.X_WL.translation()), 16 * kEps);
  EXPECT_LE(difference(link.w_WL_L, body.w_WB_L), 16 * kEps);
}

TEST(Simulator, RefusesScenesThatCannotBeSimulated) {
  const SceneBody good = genericSceneBody("b");
  EXPECT_TRUE(contains(refusal([&] { Simulator{Scene()}; }), {"no body"}));
  Scene twice = sceneOf(good);
  twice.bodies.push_back(good);
  EXPECT_TRUE(contains(refusal([&] { Simulator{twice}; }), {"'b'", "twice"}));
  Scene timeless = sceneOf(good);
  timeless.step_ns = 0;
  EXPECT_TRUE(contains(refusal([&] { Simulator{timeless}; }), {"step must be positive"}));
  EXPECT_TRUE(contains(refusal([&] { Simulator{sceneOf(good, "rk44")}; }),
                       {"'rk44' is not an integrator", "split2"}));
  SceneBody flat = good;
  flat.mass_properties.I_BBcm_F.setZero();
  EXPECT_TRUE(contains(refusal([&] { Simulator{sceneOf(flat)}; }), {"body 'b'", "positive"}));
  SceneBody fast = good;
  fast.v_WBcm.x() = 1e308;
  EXPECT_TRUE(contains(refusal([&] { Simulator{sceneOf(fast)}; }), {"body 'b'", "not finite"}));
  Scene crowded = sceneOf(good);
  crowded.threads = -1;
  EXPECT_TRUE(contains(refusal([&] { Simulator{crowded}; }), {"threads", "negative"}));
  SceneBody nowhere = good;
  nowhere.X_WL.translation().y() = kNaN;
  EXPECT_TRUE(contains(refusal([&] { Simulator{sceneOf(nowhere)}; }), {"body 'b'", "pose"}));
  Simulator simulator(sceneOf(good));
  EXPECT_TRUE(contains(refusal([&] { simulator.advance(-5); }), {"backwards"}));
  EXPECT_EQ(simulator.tick(), 0);
  Scene empty = sceneOf(good);
  empty.effects.push_back(nullptr);
  EXPECT_TRUE(contains(refusal([&] { Simulator{empty}; }), {"effect", "null"}));
}

TEST(Simulator, RefusesAPoseThatIsNoRigidTransform) {
  const Matrix3d R_WL = genericPose().linear();
  Matrix3d sheared = R_WL;
  sheared.col(0) += 1e-6 * R_WL.col(1);
  const std::vector<Matrix3d> bad = {
      1.001 * R_WL,     -R_WL,      R_WL * Vector3d(1, 1, -1).asDiagonal(), sheared,
      Matrix3d::Zero(), kNaN * R_WL};
  for (const Matrix3d& linear : bad) {
    for (const bool is_point_mass : {false, true}) {
      SceneBody body = genericSceneBody("skewed");
      body.is_point_mass = is_point_mass;
      body.X_WL.linear() = linear;
      EXPECT_TRUE(contains(refusal([&] { Simulator{sceneOf(body)}; }), {"body 'skewed'", "rigid"}))
          << linear;
    }
  }
}

TEST(Simulator, GoesOnAfterItWasMovedAsIfItHadNotBeen) {
  const auto pushed = [] {
    auto simulator = std::make_unique<Simulator>(sceneOf(genericSceneBody("b")));
    simulator->apply(push(Axes::kBody, {{1, 2, 3}, {4, 5, 6}}, {0.1, 0.2, 0.3}));
    run(*simulator, 5);
    return simulator;
  };
  auto origin = pushed();
  Simulator moved(std::move(*origin));
  auto second_origin = pushed();
  Simulator assigned(sceneOf(pointMass("another", 3)));
  assigned.apply(push(Axes::kWorld, {{1, 0, 0}, {0, 0, 0}}));
  run(assigned, 3);
  assigned = std::move(*second_origin);
  origin.reset();  // with all that a stale pointer may point to
  second_origin.reset();
  const auto stayed = pushed();
  ASSERT_EQ(moved.heldWrenches().size(), 1u);
  ASSERT_EQ(assigned.heldWrenches().size(), 1u);
  const BodyState before = stayed->state(0);
  run(*stayed, 20);
  run(moved, 20);
  run(assigned, 20);
  EXPECT_GT(difference(stayed->state(0).P_WB, before.P_WB), 0.1);  // it does act
  EXPECT_TRUE(sameBits(moved.state(0), stayed->state(0)));
  EXPECT_TRUE(sameBits(assigned.state(0), stayed->state(0)));
}

TEST(Simulator, OffCentreImpulseOnATurnedBodyGivesTheClosedForm) {
  // dv = J / m and dw = I^-1 (r x J + A), with the full tensor turned to world axes. One short tick
  // after the impulse changes w by the gyroscopic term, so the momenta are compared at its start.
  const SceneBody body = genericSceneBody("b");
  Simulator simulator(sceneOf(body));
  const BodyFrame& frame = simulator.bodyFrame(0);
  const BodyState before = simulator.state(0);
  const Vector3d J(1.2, -0.5, 0.9), A(0.3, 0.2, -0.7), p_LQ(0.5, 0.4, -0.2);
  const Vector3d p_BcmQ_B = frame.q_LB.conjugate() * (p_LQ - frame.p_LBcm);
  simulator.apply(knock(J, A, p_BcmQ_B));
  simulator.step();
  BodyState kicked = before;  // the drift leaves P and L alone
  kicked.P_WB = simulator.state(0).P_WB;
  kicked.L_WBcm_W = simulator.state(0).L_WBcm_W;

  const Matrix3d R_WL = body.X_WL.linear();
  const Matrix3d I_W = R_WL * body.mass_properties.I_BBcm_F * R_WL.transpose();
  const Vector3d r_W = R_WL * (p_LQ - body.mass_properties.p_FBcm);
  const Vector3d dv = J / body.mass_properties.mass;
  const Vector3d dw = I_W.inverse() * (r_W.cross(J) + A);
  const Vector3d found_dv = velocity(kicked, frame.mass) - velocity(before, frame.mass);
  const Vector3d found_dw =
      angularVelocity(kicked, frame.I_BBcm_B) - angularVelocity(before, frame.I_BBcm_B);
  EXPECT_LE((found_dv - dv).norm(), 1e-12 * dv.norm());  // as promised; measured: 2e-16
  EXPECT_LE((found_dw - dw).norm(), 1e-12 * dw.norm());  // measured: 4e-16
}

TEST(Simulator, ConstantForceGivesTheExactParabola) {
  SceneBody body = genericSceneBody("b");
  Simulator simulator(sceneOf(body));
  const Vector3d f_W(0.7, -1.9, 1.3);
  simulator.apply(push(Axes::kWorld, {f_W, Vector3d::Zero()}));
  const Vector3d p0 = simulator.state(0).p_WBcm, a = f_W / body.mass_properties.mass;
  const int ticks = 1000;
  run(simulator, ticks);
  const double T = ticks * 0.02;
  const Vector3d expected = p0 + T * body.v_WBcm + 0.5 * T * T * a;
  // A sum a tick, of numbers up to the end's size, on top of a momentum with two sums a tick.
  EXPECT_LE((simulator.state(0).p_WBcm - expected).norm(), 2 * ticks * kEps * expected.norm());
}

TEST(Simulator, BallUnderGravityFallsExactly) {
  Scene scene = sceneOf(genericSceneBody("ball"));
  const Vector3d g_W(0, 0, -9.80665);
  scene.effects.push_back(uniformGravity(g_W, {0}));
  Simulator simulator(scene);
  const BodyState start = simulator.state(0);
  const int ticks = 500;
  run(simulator, ticks);
  const double T = ticks * 0.02, mass = simulator.bodyFrame(0).mass;
  const Vector3d expected = start.p_WBcm + T * velocity(start, mass) + 0.5 * T * T * g_W;
  EXPECT_LE((simulator.state(0).p_WBcm - expected).norm(), 2 * ticks * kEps * expected.norm());
  EXPECT_TRUE(sameBits(simulator.state(0).L_WBcm_W, start.L_WBcm_W));
}

/// A body that turns steadily about its third axis, however its third axis is turned.
SceneBody steadySpinner(double rate) {
  SceneBody body = sceneBodyOf(reference::caseNamed("oblate_top"), genericAttitude());
  body.w_WB_L << 0, 0, rate;
  return body;
}

TEST(Simulator, BodyAxesPushTurnsWithTheBody) {
  // f along the body's x while the body turns at w about its z: m v = f / w (sin wT, 1 - cos wT) in
  // the starting axes. The scheme is of second order in the step: measured 2.000.
  const double rate = 3, T = 1.7;
  const auto error = [&](int ticks) {
    Scene scene = sceneOf(steadySpinner(rate));
    scene.step_ns = static_cast<std::int64_t>(T * 1e9) / ticks;
    Simulator simulator(scene);
    simulator.apply(push(Axes::kBody, {{2, 0, 0}, {0, 0, 0}}));
    run(simulator, ticks);
    const Vector3d expected = 2 / rate * Vector3d(std::sin(rate * T), 1 - std::cos(rate * T), 0);
    return difference(genericAttitude().conjugate() * simulator.state(0).P_WB, expected);
  };
  EXPECT_NEAR(std::log2(error(100) / error(200)), 2, 0.05);
  EXPECT_LT(error(200), 1e-3);
}

TEST(Simulator, WorldAxesPushDoesNotTurnWithTheBody) {
  Simulator simulator(sceneOf(steadySpinner(3)));
  const Vector3d f_W(2, -1, 0.5);
  simulator.apply(push(Axes::kWorld, {f_W, Vector3d::Zero()}));
  run(simulator, 85);
  EXPECT_LE(difference(simulator.state(0).P_WB, 1.7 * f_W), 86 * kEps * 1.7 * f_W.norm());
}

TEST(Simulator, BodyAxesTorqueAboutTheSpinAxisSpinsUpTheBody) {
  // dL = M dt about a fixed axis: the torque keeps its direction, as the axis does not tilt.
  Simulator simulator(sceneOf(steadySpinner(3)));
  simulator.apply(push(Axes::kBody, {{0, 0, 0}, {0, 0, 0.4}}));
  const Vector3d before = simulator.state(0).L_WBcm_W;
  run(simulator, 100);
  const Vector3d gained = simulator.state(0).L_WBcm_W - before;
  // Every half kick rounds L once and takes the axis from a rotation: measured 22 kEps.
  EXPECT_LE(difference(gained, 0.8 * (genericAttitude() * Vector3d::UnitZ())),
            100 * kEps * simulator.state(0).L_WBcm_W.norm());
}

TEST(Simulator, WorldForceAtABodyPointSwingsTheBodyLikeAPendulum) {
  // f pulls the point at r: the energy I w^2 / 2 - f.(R r) of the swing stays, to second order.
  SceneBody body = sceneBodyOf(reference::caseNamed("sphere"));
  body.w_WB_L.setZero();
  const Vector3d f_W(0, 0, -3), r_B(0.5, 0, 0);
  const auto worst = [&](int per_second) {
    Scene scene = sceneOf(body);
    scene.step_ns = 1'000'000'000 / per_second;
    Simulator simulator(scene);
    simulator.apply(push(Axes::kWorld, {f_W, Vector3d::Zero()}, r_B));
    double error = 0;
    for (int i = 0; i < 5 * per_second; ++i) {
      simulator.step();
      const BodyState state = simulator.state(0);
      const double swing = 0.5 * state.L_WBcm_W.squaredNorm() / 0.7 - f_W.dot(state.q_WB * r_B);
      error = std::max(error, std::abs(swing));  // zero at the start
    }
    return error;
  };
  EXPECT_NEAR(std::log2(worst(50) / worst(100)), 2, 0.05);  // measured: 2.000
  EXPECT_LT(worst(50), 1e-2);
}

TEST(Simulator, FreeBodiesAtRestDoNotMoveAtAll) {
  SceneBody body = genericSceneBody("b");
  body.v_WBcm.setZero();
  body.w_WB_L.setZero();
  Simulator simulator(sceneOf(body));
  const BodyState start = simulator.state(0);
  run(simulator, 10000);
  EXPECT_TRUE(sameBits(simulator.state(0), start));
}

TEST(PointMass, MovesAsAParticleAndIsNeverRotated) {
  // F = m a, and J = m dv.
  SceneBody body = pointMass("p", 0.5);
  body.X_WL.linear() = genericAttitude().toRotationMatrix();
  body.v_WBcm << 1, 2, 3;
  Simulator simulator(sceneOf(body));
  const Quaterniond q_WB = simulator.state(0).q_WB;
  simulator.apply(push(Axes::kWorld, {{1, 0, 0}, {0, 0, 0}}));
  simulator.apply(knock({0, 0.25, 0}));
  run(simulator, 100);
  const BodyState end = simulator.state(0);
  EXPECT_LE(difference(velocity(end, 0.5), Vector3d(1 + 2 * 2, 2.5, 3)), 100 * 5 * kEps);
  EXPECT_LE(difference(end.p_WBcm, Vector3d(2 + 0.5 * 2 * 4, 5, 6)), 100 * 2 * 6 * kEps);
  EXPECT_TRUE(sameBits(end.q_WB.coeffs(), q_WB.coeffs()));
  EXPECT_EQ(end.L_WBcm_W, Vector3d::Zero());
}

TEST(PointMass, StaysWithoutRotationWhateverItsSceneSays) {
  SceneBody body = pointMass("dot", 0.5);
  body.w_WB_L << 1, -2, 3;
  for (const IntegratorRow& row : integrators()) {
    Simulator simulator(sceneOf(body, row.name));
    run(simulator, 10);
    EXPECT_TRUE(sameBits(simulator.state(0).L_WBcm_W, Vector3d(0, 0, 0))) << row.name;
    EXPECT_EQ(simulator.linkMotion(0).w_WL_L, Vector3d::Zero()) << row.name;
    EXPECT_EQ(simulator.linkMotion(0).q_WL.coeffs(), Quaterniond::Identity().coeffs()) << row.name;
  }
}

TEST(PointMass, TakesNoTorqueAndNoArm) {
  Scene scene = sceneOf(pointMass("dot", 0.5));
  Simulator simulator(scene);
  const std::vector<std::string> parts = {"torque", "point mass 'dot'"};
  EXPECT_TRUE(contains(refusal([&] {
                         simulator.apply(push(Axes::kWorld, {{1, 0, 0}, {0, 1e-9, 0}}));
                       }),
                       parts));
  EXPECT_TRUE(contains(refusal([&] {
                         simulator.apply(push(Axes::kBody, {{1, 0, 0}, {0, 0, 0}}, {0, 1, 0}));
                       }),
                       parts));
  EXPECT_TRUE(contains(refusal([&] { simulator.apply(knock({1, 0, 0}, {0, 0, 1})); }), parts));
  EXPECT_EQ(simulator.pendingCount(), 0u);
}

/// Two bodies; the first of them takes what is thrown at it.
Scene twoBodies() {
  Scene scene = sceneOf(genericSceneBody("victim"));
  scene.bodies.push_back(genericSceneBody("other"));
  scene.effects.push_back(uniformGravity({0.1, 0.2, -9.8}, {0, 1}));
  return scene;
}

TEST(Freezing, StopsABodyAtItsLastGoodStateAndLeavesTheOthersAlone) {
  struct Row {
    const char* what;
    ImpulseInput impulse;
  };
  const Vector3d huge(1.7e308, 0, 0), none = Vector3d::Zero();
  for (const Row& row : {Row{"momentum overflows", knock(huge)},
                         Row{"angular momentum overflows", knock(none, huge)}}) {
    Simulator simulator(twoBodies()), undisturbed(twoBodies());
    run(simulator, 10);
    run(undisturbed, 10);
    const BodyState last_good = simulator.state(0);
    simulator.apply(row.impulse);
    simulator.apply(row.impulse);
    run(simulator, 5);
    run(undisturbed, 5);
    ASSERT_EQ(simulator.frozenBodies().size(), 1u) << row.what;
    EXPECT_EQ(simulator.frozenBodies()[0].body, 0);
    EXPECT_EQ(simulator.frozenBodies()[0].tick, 10);
    EXPECT_TRUE(sameBits(simulator.state(0), last_good)) << row.what;
    EXPECT_TRUE(sameBits(simulator.state(1), undisturbed.state(1))) << row.what;
    EXPECT_EQ(simulator.tick(), 15);
  }
}

TEST(Freezing, LastsUntilTheReset) {
  Simulator simulator(twoBodies());
  simulator.apply(knock({1.7e308, 0, 0}));
  simulator.apply(knock({1.7e308, 0, 0}));
  simulator.step();
  const BodyState frozen = simulator.state(0);
  simulator.apply(knock({1, 0, 0}));
  simulator.apply(push(Axes::kWorld, {{1, 2, 3}, {4, 5, 6}}));
  run(simulator, 10);
  EXPECT_TRUE(sameBits(simulator.state(0), frozen));
  EXPECT_EQ(simulator.frozenBodies().size(), 1u);
  simulator.reset();
  EXPECT_TRUE(simulator.frozenBodies().empty());
  run(simulator, 10);
  Simulator fresh(twoBodies());
  run(fresh, 10);
  EXPECT_TRUE(sameBits(simulator.state(0), fresh.state(0)));
}

TEST(Reset, GoesBackToTheStartWithoutInputsAndTakesATick) {
  Simulator simulator(twoBodies());
  const BodyState start = simulator.state(0);
  simulator.apply(push(Axes::kBody, {{1, 2, 3}, {4, 5, 6}}));
  ImpulseInput later = knock({1, 0, 0});
  later.start = 1000;
  simulator.apply(later);
  run(simulator, 7);
  simulator.reset();
  EXPECT_EQ(simulator.tick(), 8);
  EXPECT_TRUE(sameBits(simulator.state(0), start));
  EXPECT_EQ(simulator.pendingCount(), 0u);
  EXPECT_TRUE(simulator.heldWrenches().empty());
  EXPECT_TRUE(simulator.endedWrenches().empty());
}

TEST(Reset, ForgetsTheWrenchesThatRanOutInTheTickBefore) {
  Simulator simulator(twoBodies());
  WrenchInput input = push(Axes::kBody, {{1, 2, 3}, {4, 5, 6}});
  input.ticks = 1;
  simulator.apply(input);
  run(simulator, 2);
  ASSERT_EQ(simulator.endedWrenches().size(), 1u);
  simulator.reset();
  EXPECT_TRUE(simulator.endedWrenches().empty());
}

TEST(Reset, RerunsTheSameBits) {
  Simulator simulator(twoBodies());
  std::vector<BodyState> first;
  for (int round = 0; round < 3; ++round) {
    simulator.apply(push(Axes::kBody, {{1, 2, 3}, {4, 5, 6}}, {0.1, 0.2, 0.3}));
    simulator.apply(knock({1, -1, 0.5}, {0.1, 0.2, 0.3}, {-0.3, 0.2, 0.1}));
    run(simulator, 100);
    if (round == 0) first = {simulator.state(0), simulator.state(1)};
    EXPECT_TRUE(sameBits(simulator.state(0), first[0]));
    EXPECT_TRUE(sameBits(simulator.state(1), first[1]));
    simulator.reset();
  }
}

}  // namespace
}  // namespace rigid_body_sim

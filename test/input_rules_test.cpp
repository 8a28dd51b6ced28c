// Which body, which axes, which point an input means.

#include "input_rules_fixture.hpp"

namespace rigid_body_sim {
namespace {

// ---- Frames

/// What (f, t about the origin of F plus p_FQ) in the axes of F amounts to about the centre of mass
/// in world axes, worked out in the root link: no principal axes in it.
Wrench expectedAboutCom(const Isometry3d& X_WL, const Isometry3d& X_LF,
                        const Vector3d& p_FQ = Vector3d::Zero()) {
  const Vector3d p_BcmQ_L = X_LF * p_FQ - genericBody().p_FBcm;
  const Vector3d f_L = X_LF.linear() * kForce;
  const Vector3d t_L = X_LF.linear() * kTorque + p_BcmQ_L.cross(f_L);
  return {X_WL.linear() * f_L, X_WL.linear() * t_L};
}

/// Checks `applied` at the attitude that the body has, and at another one.
void expectInFrame(const Fixture& f, const AppliedWrench& applied, const Isometry3d& X_LF,
                   const Vector3d& p_FQ = Vector3d::Zero()) {
  EXPECT_EQ(applied.axes, Axes::kBody);
  const Quaterniond q_LB = f.simulator.bodyFrame(kAsset).q_LB;
  for (const Quaterniond& q_WL : {f.simulator.linkMotion(kAsset).q_WL, genericAttitude()}) {
    const Wrench is = inWorldAboutCom(applied, q_WL * q_LB);
    const Wrench expected = expectedAboutCom(Isometry3d(q_WL), X_LF, p_FQ);
    EXPECT_LE(difference(is.f_F, expected.f_F), kTolerance);
    EXPECT_LE(difference(is.t_Q_F, expected.t_Q_F), kTolerance);
  }
}

TEST(InputFrame, ARootLinkMeansItsAxesAndItsOrigin) {
  const Fixture f;
  expectInFrame(f, f.rules.held(kAsset, wrenchIn("asset")).applied, Isometry3d::Identity());
  expectInFrame(f, f.rules.impulse(kAsset, impulseIn("asset")).applied, Isometry3d::Identity());
}

TEST(InputFrame, ALumpedLinkMeansItsAxesAndItsOrigin) {
  const Fixture f;
  expectInFrame(f, f.rules.held(kAsset, wrenchIn("pod")).applied, podInLink());
  expectInFrame(f, f.rules.impulse(kAsset, impulseIn("pod")).applied, podInLink());
}

TEST(InputFrame, TheComFrameMeansPrincipalAxesAtTheCentreOfMass) {
  const Fixture f;
  const BodyFrame& B = f.simulator.bodyFrame(kAsset);
  Isometry3d X_LB = Isometry3d(B.q_LB);
  X_LB.translation() = genericBody().p_FBcm;
  expectInFrame(f, f.rules.held(kAsset, wrenchIn("asset/com")).applied, X_LB);
  const AppliedWrench applied = f.rules.impulse(kAsset, impulseIn("asset/com")).applied;
  EXPECT_EQ(applied.wrench.f_F, kForce);
  EXPECT_EQ(applied.wrench.t_Q_F, kTorque);
  EXPECT_EQ(applied.p_BcmQ_B, Vector3d(0, 0, 0));
}

TEST(InputFrame, TheWorldMeansItsAxesAtTheCentreOfMassWithoutTurning) {
  const Fixture f;
  for (const AppliedWrench& applied : {f.rules.held(kAsset, wrenchIn("world")).applied,
                                       f.rules.impulse(kAsset, impulseIn("world")).applied}) {
    EXPECT_EQ(applied.axes, Axes::kWorld);
    EXPECT_EQ(applied.wrench.f_F, kForce);
    EXPECT_EQ(applied.wrench.t_Q_F, kTorque);
    EXPECT_EQ(applied.p_BcmQ_B, Vector3d(0, 0, 0));
  }
}

TEST(InputFrame, IsWorkedOutByHandForAQuarterTurn) {
  // Principal axes are link axes here: B is L shifted to (1, 2, 3). The pod is turned about z by 90
  // degrees: its x is the link's y.
  SceneBody body;
  body.name = "asset";
  body.mass_properties = {2, {1, 2, 3}, Vector3d(1, 1.5, 2).asDiagonal()};
  Isometry3d X_LF = Isometry3d::Identity();
  X_LF.linear() << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  X_LF.translation() << 4, 0, 0;
  body.frames = {{"pod", X_LF}};
  const Fixture f("{}", sceneOf(body));
  BodyWrench message = scheduledIn("pod");
  set(message.wrench.force, {1, 0, 0});
  set(message.wrench.torque, {0, 7, 5});
  set(message.point, {10, 0, 0.5});
  const AppliedWrench applied = f.rules.scheduled(message).applied;
  EXPECT_EQ(applied.axes, Axes::kBody);
  EXPECT_EQ(applied.wrench.f_F, Vector3d(0, 1, 0));
  EXPECT_EQ(applied.wrench.t_Q_F, Vector3d(-7, 0, 5));
  EXPECT_EQ(applied.p_BcmQ_B, Vector3d(4 - 1, 10 - 2, 0.5 - 3));
}

TEST(InputFrame, MayHaveALeadingSlash) {
  const Fixture f;
  for (const std::string frame : {"asset", "asset/com", "pod", "world"}) {
    const AppliedWrench without = f.rules.held(kAsset, wrenchIn(frame)).applied;
    const AppliedWrench with = f.rules.held(kAsset, wrenchIn("/" + frame)).applied;
    EXPECT_EQ(with.axes, without.axes);
    EXPECT_EQ(with.wrench.f_F, without.wrench.f_F);
    EXPECT_EQ(with.p_BcmQ_B, without.p_BcmQ_B);
    EXPECT_NO_THROW(f.rules.scheduled(scheduledIn("/" + frame, "/pod")));
  }
}

TEST(InputFrame, OfTheWorldHasTheNameThatTheUserGivesIt) {
  const Fixture f("world_frame: map");
  EXPECT_EQ(f.rules.held(kAsset, wrenchIn("map")).applied.axes, Axes::kWorld);
  EXPECT_EQ(refused([&] { f.rules.held(kAsset, wrenchIn("world")); }).refusal,
            Refusal::kUnknownFrame);
}

TEST(InputFrame, IsRefusedWithTheKnownOnesUnlessItIsFixedToTheBodyOrTheWorld) {
  const Fixture f;
  for (const std::string frame :
       {"", "/", "//asset", "Asset", "asset/", "com", "base_link", "other", "other/com",
        "other_pod", "dust", "world/com", " world", "asset\n"}) {
    const Refused r = refused([&] { f.rules.held(kAsset, wrenchIn(frame)); });
    EXPECT_EQ(r.refusal, Refusal::kUnknownFrame) << frame;
    EXPECT_TRUE(contains(r.what, {"world", "asset", "asset/com", "pod"}));
    EXPECT_EQ(r.what.find("other_pod,"), std::string::npos);
    EXPECT_EQ(r.what.find('\n'), std::string::npos);
    EXPECT_EQ(refused([&] { f.rules.impulse(kAsset, impulseIn(frame)); }).refusal,
              Refusal::kUnknownFrame);
    EXPECT_EQ(refused([&] { f.rules.scheduled(scheduledIn(frame)); }).refusal,
              Refusal::kUnknownFrame);
    EXPECT_EQ(refused([&] { f.rules.impulse(impulseAtPoint(frame, "pod")); }).refusal,
              Refusal::kUnknownFrame);
  }
}

TEST(InputFrame, OfAnyLengthGivesAShortMessage) {
  const Fixture f;
  const Refused r = refused([&] { f.rules.held(kAsset, wrenchIn(std::string(10'000'000, 'x'))); });
  EXPECT_EQ(r.refusal, Refusal::kUnknownFrame);
  EXPECT_LT(r.what.size(), 300u);
}

// ---- Points

TEST(InputPoint, IsGivenInTheFrameOfTheWrenchUnlessAnotherIsNamed) {
  const Fixture f;
  expectInFrame(f, f.rules.scheduled(scheduledIn("pod")).applied, podInLink(), kPoint);
  expectInFrame(f, f.rules.impulse(impulseAtPoint("pod")).applied, podInLink(), kPoint);
  expectInFrame(f, f.rules.scheduled(scheduledIn("asset")).applied, Isometry3d::Identity(), kPoint);
}

TEST(InputPoint, MayBeGivenInAnotherFrameThanTheWrench) {
  const Fixture f;
  // Axes of the pod, at a point of the link: the same as in the pod at its coordinates there.
  const Vector3d p_FQ = podInLink().inverse() * kPoint;
  expectInFrame(f, f.rules.scheduled(scheduledIn("pod", "asset")).applied, podInLink(), p_FQ);
  expectInFrame(f, f.rules.impulse(impulseAtPoint("pod", "asset")).applied, podInLink(), p_FQ);
}

TEST(InputPoint, OfAForceInWorldAxesIsFixedToTheBody) {
  const Fixture f;
  for (const AppliedWrench& applied : {f.rules.scheduled(scheduledIn("world", "pod")).applied,
                                       f.rules.impulse(impulseAtPoint("world", "pod")).applied}) {
    EXPECT_EQ(applied.axes, Axes::kWorld);
    for (const Quaterniond& q_WL : {f.simulator.linkMotion(kAsset).q_WL, genericAttitude()}) {
      const Wrench is = inWorldAboutCom(applied, q_WL * f.simulator.bodyFrame(kAsset).q_LB);
      const Vector3d p_BcmQ_W = q_WL * (podInLink() * kPoint - genericBody().p_FBcm);
      EXPECT_EQ(is.f_F, kForce);
      EXPECT_LE(difference(is.t_Q_F, kTorque + p_BcmQ_W.cross(kForce)), kTolerance);
    }
  }
}

TEST(InputPoint, OfAForceInWorldAxesIsInTheComFrameUnlessAnotherIsNamed) {
  const Fixture f;
  EXPECT_EQ(f.rules.scheduled(scheduledIn("world")).applied.p_BcmQ_B, kPoint);
  EXPECT_EQ(f.rules.impulse(impulseAtPoint("world")).applied.p_BcmQ_B, kPoint);
  EXPECT_EQ(f.rules.scheduled(scheduledIn("world", "asset/com")).applied.p_BcmQ_B, kPoint);
}

TEST(InputPoint, IsRefusedInAFrameThatIsNotFixedToTheBody) {
  const Fixture f;
  for (const std::string frame : {"world", "/world", "other", "nowhere"}) {
    for (const std::string axes : {"world", "pod"}) {
      const Refused r = refused([&] { f.rules.scheduled(scheduledIn(axes, frame)); });
      EXPECT_EQ(r.refusal, Refusal::kUnknownFrame) << frame;
      EXPECT_TRUE(contains(r.what, {"asset", "asset/com", "pod"}));
      EXPECT_EQ(refused([&] { f.rules.impulse(impulseAtPoint(axes, frame)); }).refusal,
                Refusal::kUnknownFrame);
    }
  }
}

// ---- Bodies

TEST(InputBody, IsTheOneThatIsNamed) {
  const Fixture f;
  BodyWrench wrench = scheduledIn("world");
  wrench.body = "other";
  EXPECT_EQ(f.rules.scheduled(wrench).body, kOther);
  BodyImpulse impulse = impulseAtPoint("world");
  impulse.body = "other";
  EXPECT_EQ(f.rules.impulse(impulse).body, kOther);
  EXPECT_EQ(f.rules.held(kOther, wrenchIn("other")).body, kOther);
}

TEST(InputBody, ThatIsUnknownIsRefusedNamingThoseThereAre) {
  const Fixture f;
  for (const std::string name : {"", "Asset", "/asset", "pod", "nobody"}) {
    BodyWrench wrench = scheduledIn("world");
    wrench.body = name;
    const Refused r = refused([&] { f.rules.scheduled(wrench); });
    EXPECT_EQ(r.refusal, Refusal::kUnknownBody);
    EXPECT_TRUE(contains(r.what, {"'" + name + "'", "asset, dust, other"}));
    BodyImpulse impulse = impulseAtPoint("world");
    impulse.body = name;
    EXPECT_EQ(refused([&] { f.rules.impulse(impulse); }).refusal, Refusal::kUnknownBody);
  }
}

TEST(InputBody, ThatIsUnknownAmongManyIsRefusedNamingTen) {
  Scene scene;
  for (const char letter : std::string("abcdefghijkl"))
    scene.bodies.push_back(genericSceneBody(std::string(1, letter)));
  const Fixture f("{}", scene);
  const std::string what = refused([&] { f.rules.scheduled(scheduledIn("world")); }).what;
  EXPECT_TRUE(contains(what, {"a, b, c, d, e, f, g, h, i, j, ..."}));
}

}  // namespace
}  // namespace rigid_body_sim

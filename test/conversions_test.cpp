#include "node/conversions.hpp"

#include "generic.hpp"

namespace rigid_body_sim {
namespace {

const ros::Time kStamp(12, 340'000'000);

/// `asset` with a full tensor, an offset centre of mass and two lumped links, at a general attitude
/// and turning; and a second body elsewhere.
Simulator turningBodies() {
  Scene scene = sceneOf(genericSceneBody("asset"));
  Isometry3d X_LF = Isometry3d::Identity();
  X_LF.linear() = Quaterniond(-0.2, 0.5, 0.7, 0.3).normalized().toRotationMatrix();
  X_LF.translation() << 0.6, 0.3, -0.8;
  scene.bodies[0].frames = {{"pod", X_LF}, {"arm/tip", X_LF * X_LF}};
  scene.bodies.push_back(genericSceneBody("other"));
  scene.bodies[1].X_WL.translation() << -3, 4, 5;
  Simulator simulator(scene);
  for (int i = 0; i < 25; ++i) simulator.step();
  return simulator;
}

Quaterniond toQuaternion(const geometry_msgs::Quaternion& q) { return {q.w, q.x, q.y, q.z}; }

Isometry3d toPose(const Vector3d& p, const geometry_msgs::Quaternion& q) {
  Isometry3d X = Isometry3d::Identity();
  X.linear() = toQuaternion(q).toRotationMatrix();
  X.translation() = p;
  return X;
}

Isometry3d toPose(const geometry_msgs::Transform& transform) {
  return toPose(toVector(transform.translation), transform.rotation);
}

Isometry3d toPose(const geometry_msgs::Pose& pose) {
  return toPose(toVector(pose.position), pose.orientation);
}

// Sums of a few products of numbers below 10.
constexpr double kTolerance = 100 * kEps;

TEST(ToTf, PutsEveryBodyIntoOneMessage) {
  const tf2_msgs::TFMessage tf = toTf(turningBodies(), "map", kStamp);
  ASSERT_EQ(tf.transforms.size(), 2u);
  EXPECT_EQ(tf.transforms[0].child_frame_id, "asset");
  EXPECT_EQ(tf.transforms[1].child_frame_id, "other");
  for (const auto& transform : tf.transforms) {
    EXPECT_EQ(transform.header.frame_id, "map");
    EXPECT_EQ(transform.header.stamp, kStamp);
  }
}

TEST(ToTf, TakesTheCentreOfMassInTheLinkToTheOneInTheWorld) {
  const Simulator simulator = turningBodies();
  const tf2_msgs::TFMessage tf = toTf(simulator, "world", kStamp);
  for (Eigen::Index i = 0; i < 2; ++i) {
    const Isometry3d X_WL = toPose(tf.transforms[i].transform);
    EXPECT_LE(difference(X_WL * genericBody().p_FBcm, simulator.state(i).p_WBcm), kTolerance);
  }
}

TEST(ToTf, RotatesTheTensorInTheLinkToTheOneInTheWorld) {
  const Simulator simulator = turningBodies();
  const Matrix3d R_WL = toPose(toTf(simulator, "world", kStamp).transforms[0].transform).linear();
  const Matrix3d R_WB = simulator.state(0).q_WB.toRotationMatrix();
  const Matrix3d I_B = simulator.bodyFrame(0).I_BBcm_B.asDiagonal();
  EXPECT_LE(
      difference(R_WL * genericBody().I_BBcm_F * R_WL.transpose(), R_WB * I_B * R_WB.transpose()),
      kTolerance);
}

TEST(ToStaticTf, PutsTheComFrameAtTheCentreOfMassAlongThePrincipalAxes) {
  const auto frames = toStaticTf(turningBodies(), false, kStamp);
  ASSERT_EQ(frames.size(), 2u);
  EXPECT_EQ(frames[0].header.frame_id, "asset");
  EXPECT_EQ(frames[0].header.stamp, kStamp);
  EXPECT_EQ(frames[0].child_frame_id, "asset/com");
  EXPECT_EQ(frames[1].child_frame_id, "other/com");
  const Isometry3d X_LB = toPose(frames[0].transform);
  EXPECT_EQ(Vector3d(X_LB.translation()), genericBody().p_FBcm);
  Matrix3d I_B = X_LB.linear().transpose() * genericBody().I_BBcm_F * X_LB.linear();
  EXPECT_LT(I_B(0, 0), I_B(1, 1));
  EXPECT_LT(I_B(1, 1), I_B(2, 2));
  I_B.diagonal().setZero();
  EXPECT_LE(I_B.cwiseAbs().maxCoeff(), kTolerance);
}

TEST(ToStaticTf, FollowsOnTfToTheStateThatIsSimulated) {
  const Simulator simulator = turningBodies();
  const Isometry3d X_WB = toPose(toTf(simulator, "world", kStamp).transforms[0].transform) *
                          toPose(toStaticTf(simulator, false, kStamp)[0].transform);
  EXPECT_LE(difference(Vector3d(X_WB.translation()), simulator.state(0).p_WBcm), kTolerance);
  EXPECT_LE(difference(X_WB.linear(), simulator.state(0).q_WB.toRotationMatrix()), kTolerance);
}

TEST(ToStaticTf, GivesTheLumpedLinksInTheRootLinkIfAskedFor) {
  const Simulator simulator = turningBodies();
  const auto frames = toStaticTf(simulator, true, kStamp);
  ASSERT_EQ(frames.size(), 4u);
  EXPECT_EQ(frames[1].child_frame_id, "pod");
  EXPECT_EQ(frames[2].child_frame_id, "arm/tip");
  for (int i = 0; i < 2; ++i) {
    EXPECT_EQ(frames[1 + i].header.frame_id, "asset");
    const Isometry3d X_LF = simulator.scene().bodies[0].frames[i].X_LF;
    EXPECT_LE(difference(toPose(frames[1 + i].transform).matrix(), X_LF.matrix()), kTolerance);
  }
}

TEST(ToOdometry, HoldsThePoseOfTf) {
  const Simulator simulator = turningBodies();
  const nav_msgs::Odometry odometry = toOdometry(simulator, 0, "map", kStamp);
  const geometry_msgs::Transform transform = toTf(simulator, "map", kStamp).transforms[0].transform;
  EXPECT_EQ(odometry.header.frame_id, "map");
  EXPECT_EQ(odometry.header.stamp, kStamp);
  EXPECT_EQ(odometry.child_frame_id, "asset");
  EXPECT_EQ(toPose(odometry.pose.pose).matrix(), toPose(transform).matrix());
}

TEST(ToOdometry, GivesTheVelocityOfTheLinkOriginInLinkAxes) {
  const Simulator simulator = turningBodies();
  const BodyState state = simulator.state(0);
  const nav_msgs::Odometry odometry = toOdometry(simulator, 0, "world", kStamp);
  const Isometry3d X_WL = toPose(odometry.pose.pose);
  const Matrix3d R_WL = X_WL.linear();
  // From momenta and the full tensor, without principal axes.
  const Matrix3d I_W = R_WL * genericBody().I_BBcm_F * R_WL.transpose();
  const Vector3d w_W = I_W.inverse() * state.L_WBcm_W;
  const Vector3d v_W =
      state.P_WB / genericBody().mass + w_W.cross(X_WL.translation() - state.p_WBcm);
  EXPECT_LE(difference(toVector(odometry.twist.twist.angular), R_WL.transpose() * w_W), kTolerance);
  EXPECT_LE(difference(toVector(odometry.twist.twist.linear), R_WL.transpose() * v_W), kTolerance);
  EXPECT_GT(difference(toVector(odometry.twist.twist.linear), v_W), 0.1);  // the axes matter here
}

TEST(ToOdometry, GivesTheDerivativeOfItsPose) {
  Scene scene = sceneOf(genericSceneBody("asset"));
  scene.step_ns = 100'000;
  Simulator simulator(scene);
  const Isometry3d before = toPose(toOdometry(simulator, 0, "world", kStamp).pose.pose);
  simulator.step();
  const nav_msgs::Odometry now = toOdometry(simulator, 0, "world", kStamp);
  simulator.step();
  const Isometry3d after = toPose(toOdometry(simulator, 0, "world", kStamp).pose.pose);
  const Matrix3d R_WL = toPose(now.pose.pose).linear();
  // A central difference is off by h^2/6 of the third derivative, about (w^3 r, w^3) = 6 at most.
  const double h = scene.step_s();
  const Vector3d v_W = (after.translation() - before.translation()) / (2 * h);
  EXPECT_LE(difference(R_WL * toVector(now.twist.twist.linear), v_W), h * h);
  const Quaterniond turned(before.linear().transpose() * after.linear());
  EXPECT_LE(difference(toVector(now.twist.twist.angular), rotationLog(turned) / (2 * h)), h * h);
}

TEST(ToTwist, IsTheTwistOfTheOdometryInTheLinkFrame) {
  const Simulator simulator = turningBodies();
  const geometry_msgs::TwistStamped twist = toTwist(simulator, 1, kStamp);
  EXPECT_EQ(twist.header.frame_id, "other");
  EXPECT_EQ(twist.header.stamp, kStamp);
  EXPECT_EQ(twist.twist, toOdometry(simulator, 1, "world", kStamp).twist.twist);
}

/// `asset` under gravity and a wrench that is held in the world's axes.
Simulator pushedBodies(const Vector3d& g_W, const Wrench& held) {
  Scene scene = turningBodies().scene();
  scene.effects.push_back(uniformGravity(g_W, {0, 1}));
  Simulator simulator(scene);
  WrenchInput push;
  push.applied = {Axes::kWorld, held, {0, 0, 0}};
  simulator.apply(push);
  for (int i = 0; i < 25; ++i) simulator.step();
  return simulator;
}

TEST(ToAppliedWrench, IsTheSumOfEffectsAndInputsInTheAxesOfTheComFrame) {
  const Vector3d g_W(0.3, -0.4, -9.8);
  const Wrench held = {{2.1, -1.4, 0.9}, {0.3, 0.5, -0.2}};
  const Simulator simulator = pushedBodies(g_W, held);
  const geometry_msgs::WrenchStamped message = toAppliedWrench(simulator, 0, kStamp);
  EXPECT_EQ(message.header.frame_id, "asset/com");
  EXPECT_EQ(message.header.stamp, kStamp);
  const Quaterniond q_WB = simulator.state(0).q_WB;
  const Vector3d weight = simulator.bodyFrame(0).mass * g_W;
  EXPECT_LE((q_WB * toVector(message.wrench.force) - weight - held.f_F).norm(), 30 * kTolerance);
  EXPECT_LE((q_WB * toVector(message.wrench.torque) - held.t_Q_F).norm(), kTolerance);
}

TEST(ToEffectWrenches, HasARowForEachEffectWithAllBodies) {
  const Vector3d g_W(0.3, -0.4, -9.8);
  const EffectWrenches message =
      toEffectWrenches(pushedBodies(g_W, {{1, 2, 3}, {0, 0, 0}}), "map", kStamp);
  EXPECT_EQ(message.header.frame_id, "map");
  EXPECT_EQ(message.names, (std::vector<std::string>{"asset", "other"}));
  ASSERT_EQ(message.effects.size(), 2u);
  EXPECT_EQ(message.effects[0].effect, "gravity");
  EXPECT_EQ(message.effects[1].effect, "applied");
  for (const EffectWrench& effect : message.effects) ASSERT_EQ(effect.wrenches.size(), 2u);
  EXPECT_EQ(toVector(message.effects[0].wrenches[1].force), 2.7 * g_W);
  EXPECT_EQ(toVector(message.effects[1].wrenches[0].force), Vector3d(1, 2, 3));
  EXPECT_EQ(toVector(message.effects[1].wrenches[1].force), Vector3d::Zero());
}

TEST(ToStates, HoldsAllBodiesInTheOrderOfTheScene) {
  const Simulator simulator = turningBodies();
  const BodyStates states = toStates(simulator, "map", kStamp);
  EXPECT_EQ(states.header.frame_id, "map");
  EXPECT_EQ(states.header.stamp, kStamp);
  EXPECT_EQ(states.tick, 25u);
  EXPECT_EQ(states.names, (std::vector<std::string>{"asset", "other"}));
  ASSERT_EQ(states.poses.size(), 2u);
  ASSERT_EQ(states.twists.size(), 2u);
  for (int i = 0; i < 2; ++i) {
    const nav_msgs::Odometry odometry = toOdometry(simulator, i, "map", kStamp);
    EXPECT_EQ(states.poses[i], odometry.pose.pose);
    EXPECT_EQ(states.twists[i], odometry.twist.twist);
  }
}

TEST(ToValue, KeepsTheTypesOfTheParameterServer) {
  XmlRpc::XmlRpcValue tree;
  tree["flag"] = true;
  tree["count"] = -3;
  tree["number"] = 0.02;
  tree["text"] = std::string("0.02");
  tree["list"][0] = 1;
  tree["list"][1] = 2.5;
  tree["map"]["inner"] = false;
  const auto map = std::get<Value::Map>(toValue(tree).data);
  EXPECT_EQ(std::get<bool>(map.at("flag").data), true);
  EXPECT_EQ(std::get<std::int64_t>(map.at("count").data), -3);
  EXPECT_EQ(std::get<double>(map.at("number").data), 0.02);
  EXPECT_EQ(std::get<std::string>(map.at("text").data), "0.02");
  const auto list = std::get<Value::List>(map.at("list").data);
  ASSERT_EQ(list.size(), 2u);
  EXPECT_EQ(std::get<std::int64_t>(list[0].data), 1);
  EXPECT_EQ(std::get<double>(list[1].data), 2.5);
  const auto inner = std::get<Value::Map>(map.at("map").data);
  EXPECT_EQ(std::get<bool>(inner.at("inner").data), false);
}

TEST(ToValue, GivesNothingForAnEmptyValue) {
  XmlRpc::XmlRpcValue nothing;
  EXPECT_TRUE(std::holds_alternative<std::monostate>(toValue(nothing).data));
}

TEST(ToValue, RefusesDatesAndBinaryData) {
  std::tm date = {};
  XmlRpc::XmlRpcValue tree;
  tree["when"] = XmlRpc::XmlRpcValue(&date);
  EXPECT_TRUE(contains(refusal([&] { toValue(tree); }), {"date", "binary"}));
  char bytes[] = "bytes";
  XmlRpc::XmlRpcValue binary(bytes, 5);
  EXPECT_TRUE(contains(refusal([&] { toValue(binary); }), {"date", "binary"}));
}

}  // namespace
}  // namespace rigid_body_sim

#include "node/input_rules.hpp"

#include <functional>

#include "generic.hpp"

namespace rigid_body_sim {
namespace {

const Vector3d kForce(1.3, -0.7, 2.1);
const Vector3d kTorque(0.4, 0.9, -1.6);
const Vector3d kPoint(0.5, -0.2, 0.9);
constexpr Eigen::Index kAsset = 0, kOther = 1, kDust = 2;
constexpr Tick kNow = 150;  // 4 s: it began at 1 s

// Sums of products of a few numbers below 10.
constexpr double kTolerance = 100 * kEps;

Isometry3d podInLink() {
  Isometry3d X_LF = Isometry3d::Identity();
  X_LF.linear() = Quaterniond(-0.2, 0.5, 0.7, 0.3).normalized().toRotationMatrix();
  X_LF.translation() << 0.6, 0.3, -0.8;
  return X_LF;
}

/// A turning body with a full tensor, an offset centre of mass and a lumped link `pod`; another
/// one; and a point mass.
Scene sceneOfThree() {
  Scene scene = sceneOf(genericSceneBody("asset"));
  scene.bodies[0].frames = {{"pod", podInLink()}};
  scene.bodies.push_back(genericSceneBody("other"));
  scene.bodies[1].frames = {{"other_pod", podInLink()}};
  SceneBody dust;
  dust.name = "dust";
  dust.mass_properties.mass = 0.5;
  dust.is_point_mass = true;
  scene.bodies.push_back(dust);
  return scene;
}

NodeOptions optionsFrom(const std::string& yaml) {
  return readNodeOptions(Parameters(readYaml(yaml, "test"), ""), true, 0);
}

/// The rules of a simulation that is in its tick kNow.
struct Fixture {
  explicit Fixture(const std::string& options_yaml = "{}", const Scene& scene = sceneOfThree())
      : simulator(scene),
        options(optionsFrom(options_yaml)),
        time{options.start_time_ns, scene.step_ns},
        rules(simulator, time, options) {
    while (simulator.tick() < kNow) simulator.step();
  }

  ros::Time now() const { return time.at(kNow); }

  Simulator simulator;
  NodeOptions options;
  SimTime time;
  InputRules rules;
};

void set(geometry_msgs::Vector3& message, const Vector3d& vector) {
  message.x = vector.x();
  message.y = vector.y();
  message.z = vector.z();
}

void set(geometry_msgs::Point& message, const Vector3d& vector) {
  message.x = vector.x();
  message.y = vector.y();
  message.z = vector.z();
}

geometry_msgs::WrenchStamped wrenchIn(const std::string& frame) {
  geometry_msgs::WrenchStamped message;
  message.header.frame_id = frame;
  set(message.wrench.force, kForce);
  set(message.wrench.torque, kTorque);
  return message;
}

ImpulseStamped impulseIn(const std::string& frame) {
  ImpulseStamped message;
  message.header.frame_id = frame;
  set(message.linear, kForce);
  set(message.angular, kTorque);
  return message;
}

BodyWrench scheduledIn(const std::string& frame, const std::string& point_frame = "") {
  BodyWrench message;
  message.body = "asset";
  message.frame = frame;
  message.point_frame = point_frame;
  set(message.point, kPoint);
  set(message.wrench.force, kForce);
  set(message.wrench.torque, kTorque);
  return message;
}

BodyImpulse impulseAtPoint(const std::string& frame, const std::string& point_frame = "") {
  BodyImpulse message;
  message.body = "asset";
  message.frame = frame;
  message.point_frame = point_frame;
  set(message.point, kPoint);
  set(message.linear, kForce);
  set(message.angular, kTorque);
  return message;
}

/// The refusal of the input that `f` gives, and what it says.
struct Refused {
  Refusal refusal = static_cast<Refusal>(-1);
  std::string what;
};

Refused refused(const std::function<void()>& f) {
  try {
    f();
  } catch (const RefusedInput& refused) {
    return {refused.refusal, refused.what()};
  }
  ADD_FAILURE() << "not refused";
  return {};
}

// ---- Frames
// --------------------------------------------------------------------------------------

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
// --------------------------------------------------------------------------------------

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
// --------------------------------------------------------------------------------------

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

// ---- Numbers
// -------------------------------------------------------------------------------------

std::vector<double*> components(geometry_msgs::Vector3& v) { return {&v.x, &v.y, &v.z}; }
std::vector<double*> components(geometry_msgs::Point& p) { return {&p.x, &p.y, &p.z}; }

std::vector<double*> operator+(std::vector<double*> a, const std::vector<double*>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

/// Gives `value` to each component of each kind of message in each kind of frame, one at a time,
/// and hands every message to `expect`, as what turns it into an input.
void forEachComponent(const Fixture& f, double value,
                      const std::function<void(const std::function<void()>&)>& expect) {
  const auto tryAll = [&](const std::vector<double*>& all, const std::function<void()>& convert) {
    for (double* component : all) {
      const double before = *component;
      *component = value;
      SCOPED_TRACE(component - all.front());
      expect(convert);
      *component = before;
    }
  };
  for (const std::string frame : {"asset", "asset/com", "pod", "world"}) {
    SCOPED_TRACE(frame);
    auto wrench = wrenchIn(frame);
    tryAll(components(wrench.wrench.force) + components(wrench.wrench.torque),
           [&] { f.rules.held(kAsset, wrench); });
    auto impulse = impulseIn(frame);
    tryAll(components(impulse.linear) + components(impulse.angular),
           [&] { f.rules.impulse(kAsset, impulse); });
    auto scheduled = scheduledIn(frame);
    tryAll(components(scheduled.wrench.force) + components(scheduled.wrench.torque) +
               components(scheduled.point),
           [&] { f.rules.scheduled(scheduled); });
    auto at_point = impulseAtPoint(frame);
    tryAll(components(at_point.linear) + components(at_point.angular) + components(at_point.point),
           [&] { f.rules.impulse(at_point); });
  }
}

TEST(InputNumbers, ThatAreNotFiniteAreRefusedInEveryComponent) {
  const Fixture f;
  for (const double value : {kNaN, kInf, -kInf}) {
    forEachComponent(f, value, [](const auto& convert) {
      EXPECT_EQ(refused(convert).refusal, Refusal::kNotFinite);
    });
  }
}

TEST(InputNumbers, WhoseSquaresOverflowAreRefusedInEveryComponent) {
  const Fixture f;
  for (const double value : {1e155, -1e200, 1e308, -1.7e308}) {
    forEachComponent(f, value, [](const auto& convert) {
      const Refused r = refused(convert);
      EXPECT_TRUE(r.refusal == Refusal::kLimit || r.refusal == Refusal::kNotFinite);
    });
  }
}

TEST(InputNumbers, OfZeroForceAtAPointBeyondAllMeasureAreRefused) {
  const Fixture f;
  BodyWrench message = scheduledIn("world");
  message.wrench = {};
  set(message.point, {0, -1e200, 0});
  EXPECT_EQ(refused([&] { f.rules.scheduled(message); }).refusal, Refusal::kLimit);
}

TEST(InputNumbers, MayBeDenormalOrMinusZero) {
  const Fixture f;
  for (const double value : {5e-324, -1e-310, -0.0, 0.0})
    forEachComponent(f, value, [](const auto& convert) { EXPECT_NO_THROW(convert()); });
}

/// A limit, the option that sets it to 10, and messages that give `size` of it.
struct Limited {
  std::string option;
  std::string unit;
  std::function<void(const Fixture&, double size)> give;
};

/// A body of 2 kg and (2, 2, 2) kg m^2, in steps of 0.5 s.
Scene sceneOfABall() {
  SceneBody ball;
  ball.name = "ball";
  ball.mass_properties = {2, Vector3d::Zero(), 2 * Matrix3d::Identity()};
  Scene scene = sceneOf(ball);
  scene.step_ns = 500'000'000;
  return scene;
}

/// Of the given length, along no axis; exact for multiples of 7.
Vector3d ofLength(double length) { return Vector3d(2, -3, 6) * (length / 7); }

void giveWrench(const Fixture& f, const Vector3d& force, const Vector3d& torque) {
  auto message = wrenchIn("world");
  set(message.wrench.force, force);
  set(message.wrench.torque, torque);
  f.rules.held(0, message);
}

void giveImpulse(const Fixture& f, const Vector3d& linear, const Vector3d& angular) {
  auto message = impulseIn("world");
  set(message.linear, linear);
  set(message.angular, angular);
  f.rules.impulse(0, message);
}

std::vector<Limited> limits() {
  const Vector3d zero = Vector3d::Zero();
  return {
      {"force", "N", [=](const Fixture& f, double x) { giveWrench(f, ofLength(x), zero); }},
      {"torque", "N m", [=](const Fixture& f, double x) { giveWrench(f, zero, ofLength(x)); }},
      {"linear_impulse", "N s",
       [=](const Fixture& f, double x) { giveImpulse(f, ofLength(x), zero); }},
      {"angular_impulse", "N m s",
       [=](const Fixture& f, double x) { giveImpulse(f, zero, ofLength(x)); }},
      // F dt / m = F / 4, T dt / I = T / 4
      {"speed", "m/s", [=](const Fixture& f, double x) { giveWrench(f, ofLength(4 * x), zero); }},
      {"speed", "m/s", [=](const Fixture& f, double x) { giveImpulse(f, ofLength(2 * x), zero); }},
      {"angular_speed", "rad/s",
       [=](const Fixture& f, double x) { giveWrench(f, zero, ofLength(4 * x)); }},
      {"angular_speed", "rad/s",
       [=](const Fixture& f, double x) { giveImpulse(f, zero, ofLength(2 * x)); }},
      {"angular_speed", "rad/s",
       [=](const Fixture& f, double x) {  // by a force of 4 N: (T + r F) dt / I
         BodyWrench message = scheduledIn("world");
         message.body = "ball";
         set(message.wrench.force, {4, 0, 0});
         set(message.wrench.torque, {0, 0, 0});
         set(message.point, ofLength(x));
         f.rules.scheduled(message);
       }},
  };
}

TEST(InputLimits, AreAllowedThemselvesAndNothingAbove) {
  for (const Limited& limited : limits()) {
    SCOPED_TRACE(limited.option);
    const Fixture f("limits: {" + limited.option + ": 14}", sceneOfABall());
    EXPECT_NO_THROW(limited.give(f, 14));
    const Refused r = refused([&] { limited.give(f, 14 * (1 + 4 * kEps)); });
    EXPECT_EQ(r.refusal, Refusal::kLimit);
    EXPECT_TRUE(contains(r.what, {"limit of 14 " + limited.unit}));
    EXPECT_EQ(refused([&] { limited.give(f, 1e300); }).refusal, Refusal::kLimit);
  }
}

TEST(InputLimits, BoundWhatTheSmallestMomentOfInertiaWouldSpinTo) {
  SceneBody rod;
  rod.name = "rod";
  rod.mass_properties = {1, Vector3d::Zero(), Vector3d(1, 1, 0.001).asDiagonal()};
  const Fixture f("limits: {angular_speed: 10}", sceneOf(rod));
  giveImpulse(f, Vector3d::Zero(), {0, 0, 0.0099});
  EXPECT_EQ(refused([&] {
              giveImpulse(f, Vector3d::Zero(), {0, 0, 0.0101});
            }).refusal,
            Refusal::kLimit);
}

TEST(InputLimits, KeepTheStateFiniteByDefaultWhateverIsGiven) {
  Fixture f;
  for (int exponent = -320; exponent <= 308; ++exponent) {
    const double value = std::pow(10.0, exponent);
    forEachComponent(f, value, [&](const auto& convert) {
      try {
        convert();
      } catch (const RefusedInput&) {
      }
    });
    BodyImpulse impulse = impulseAtPoint("pod");
    set(impulse.linear, {value, -value, value});
    set(impulse.angular, {-value, value, value});
    try {
      f.simulator.apply(f.rules.impulse(impulse));
    } catch (const RefusedInput&) {
    }
    f.simulator.step();
    ASSERT_TRUE(f.simulator.frozenBodies().empty()) << value;
  }
}

// ---- Point masses
// --------------------------------------------------------------------------------

TEST(InputToAPointMass, MayBeAForceAtIt) {
  Fixture f;
  auto message = wrenchIn("dust");
  message.wrench.torque = {};
  const WrenchInput input = f.rules.held(kDust, message);
  EXPECT_EQ(input.applied.wrench.f_F, kForce);
  EXPECT_NO_THROW(f.simulator.apply(input));
}

TEST(InputToAPointMass, IsRefusedWheneverTheSimulatorWouldNotTakeIt) {
  Fixture f;
  // Tiny numbers too, whose squares and products are zero.
  for (const double size : {1.0, 1e-100, 1e-200, 5e-324}) {
    SCOPED_TRACE(size);
    auto torque = wrenchIn("world");
    torque.wrench = {};
    torque.wrench.torque.y = size;
    EXPECT_EQ(refused([&] { f.rules.held(kDust, torque); }).refusal, Refusal::kPointMass);
    auto angular = impulseIn("dust/com");
    angular.linear = {};
    angular.angular = {};
    angular.angular.x = size;
    EXPECT_EQ(refused([&] { f.rules.impulse(kDust, angular); }).refusal, Refusal::kPointMass);
    for (const double force : {1.0, 1e-200, 0.0}) {
      BodyWrench at_point = scheduledIn("world");
      at_point.body = "dust";
      at_point.wrench = {};
      at_point.wrench.force.x = force;
      set(at_point.point, {0, 0, size});
      EXPECT_EQ(refused([&] { f.rules.scheduled(at_point); }).refusal, Refusal::kPointMass)
          << force;
    }
  }
}

// ---- Time
// ----------------------------------------------------------------------------------------

TEST(InputStamp, OfZeroMeansTheNextTick) {
  const Fixture f;
  EXPECT_EQ(f.rules.held(kAsset, wrenchIn("pod")).start, kNow);
  EXPECT_EQ(f.rules.impulse(kAsset, impulseIn("pod")).start, kNow);
  EXPECT_EQ(f.rules.scheduled(scheduledIn("pod")).start, kNow);
  EXPECT_EQ(f.rules.impulse(impulseAtPoint("pod")).start, kNow);
}

/// Start of an impulse with this stamp; the same for all kinds of input.
Tick startOf(const Fixture& f, const ros::Time& stamp) {
  auto message = impulseIn("pod");
  message.header.stamp = stamp;
  const Tick start = f.rules.impulse(kAsset, message).start;
  auto wrench = wrenchIn("pod");
  wrench.header.stamp = stamp;
  EXPECT_EQ(f.rules.held(kAsset, wrench).start, start);
  auto scheduled = scheduledIn("pod");
  scheduled.start = stamp;
  EXPECT_EQ(f.rules.scheduled(scheduled).start, start);
  auto at_point = impulseAtPoint("pod");
  at_point.start = stamp;
  EXPECT_EQ(f.rules.impulse(at_point).start, start);
  return start;
}

TEST(InputStamp, OfThePastMeansTheNextTickUntilItIsStale) {
  const Fixture f;
  EXPECT_EQ(startOf(f, f.now()), kNow);
  EXPECT_EQ(startOf(f, f.now() - ros::Duration(0.5)), kNow);
  EXPECT_EQ(startOf(f, f.now() - ros::Duration(1)), kNow);
}

TEST(InputStamp, ThatIsStaleIsRefusedWithItsAge) {
  const Fixture f("stale_after_s: 1.5");
  for (const ros::Duration age : {ros::Duration(1, 500'000'001), ros::Duration(3)}) {
    const Refused r = refused([&] { startOf(f, f.now() - age); });
    EXPECT_EQ(r.refusal, Refusal::kStale);
    EXPECT_TRUE(contains(r.what, {"s old", "stale_after_s is 1.5"}));
  }
  EXPECT_EQ(refused([&] { startOf(f, ros::Time(0, 1)); }).refusal, Refusal::kStale);
}

TEST(InputStamp, IsNeverStaleIfThatIsSwitchedOff) {
  const Fixture f("stale_after_s: 0");
  EXPECT_EQ(startOf(f, ros::Time(0, 1)), kNow);
}

TEST(InputStamp, OfTheFutureWaitsForTheFirstTickThatBeginsThen) {
  const Fixture f;
  EXPECT_EQ(startOf(f, f.time.at(kNow + 7)), kNow + 7);
  EXPECT_EQ(startOf(f, f.time.at(kNow + 7) + ros::Duration(0.001)), kNow + 8);
  EXPECT_EQ(startOf(f, ros::Time(f.time.at(kNow + 7).toSec())), kNow + 7);
  EXPECT_EQ(startOf(f, f.now() + ros::Duration(10)), kNow + 500);
}

TEST(InputStamp, MoreThanTenSecondsAheadIsRefused) {
  const Fixture f;
  const Refused r = refused([&] { startOf(f, f.now() + ros::Duration(10, 1)); });
  EXPECT_EQ(r.refusal, Refusal::kTooFarAhead);
  EXPECT_TRUE(contains(r.what, {"ahead of 4.0", "at most 10 s", "clock"}));
}

TEST(InputStamp, OfAnyClockIsRefusedAndNothingWorse) {
  // A wall clock's, the last that ROS can hold, and one with too many nanoseconds.
  ros::Time odd(1, 0);
  odd.sec = 4'294'967'295u;
  odd.nsec = 4'294'967'295u;
  const Fixture from_one_second;
  for (const ros::Time& stamp : {ros::Time(1'700'000'000, 0), ros::Time(4'294'967'295u, 0), odd})
    EXPECT_EQ(refused([&] { startOf(from_one_second, stamp); }).refusal, Refusal::kTooFarAhead);
  const Fixture late("start_time_s: 4.0e+9");
  EXPECT_EQ(refused([&] { startOf(late, ros::Time(1, 0)); }).refusal, Refusal::kStale);
}

TEST(InputStamp, OfTheFutureIsRefusedWhenTenThousandWaitAlready) {
  Fixture f;
  auto message = impulseIn("pod");
  message.header.stamp = f.now() + ros::Duration(5);
  for (int i = 0; i < 10'000; ++i) f.simulator.apply(f.rules.impulse(kAsset, message));
  const Refused r = refused([&] { f.rules.impulse(kAsset, message); });
  EXPECT_EQ(r.refusal, Refusal::kTooManyWaiting);
  EXPECT_TRUE(contains(r.what, {"10000"}));
  message.header.stamp = ros::Time();
  EXPECT_NO_THROW(f.rules.impulse(kAsset, message));
}

// ---- Durations
// -----------------------------------------------------------------------------------

TEST(InputDuration, OfAHeldWrenchIsTheTimeout) {
  const std::vector<std::pair<std::string, Tick>> ticks = {
      {"1", 50}, {"0.02", 1}, {"0.3", 15}, {"0.31", 16}, {"0.019", 1}, {"1.0e-12", 1}, {"0", 0}};
  for (const auto& [timeout, expected] : ticks) {
    const Fixture f("wrench_timeout_s: " + timeout);
    const WrenchInput held = f.rules.held(kAsset, wrenchIn("pod"));
    EXPECT_EQ(held.ticks, expected) << timeout;  // 0: until it is replaced
    EXPECT_TRUE(held.replaces);
  }
}

TEST(InputDuration, OfZeroInAScheduleIsTheTimeoutToo) {
  const Fixture f("wrench_timeout_s: 0.5");
  const WrenchInput input = f.rules.scheduled(scheduledIn("pod"));
  EXPECT_EQ(input.ticks, 25);
  EXPECT_TRUE(input.replaces);
}

TEST(InputDuration, OfWholeStepsActsThatManyTicksAndAdds) {
  const Fixture f;
  BodyWrench message = scheduledIn("pod");
  for (const Tick ticks : {1, 3, 50, 1000}) {
    message.duration = ros::Duration(0.02 * static_cast<double>(ticks));
    const WrenchInput input = f.rules.scheduled(message);
    EXPECT_EQ(input.ticks, ticks);
    EXPECT_FALSE(input.replaces);
  }
}

TEST(InputDuration, IsRefusedUnlessItIsAPositiveNumberOfSteps) {
  const Fixture f;
  BodyWrench message = scheduledIn("pod");
  for (const ros::Duration duration :
       {ros::Duration(0, 1), ros::Duration(0.01), ros::Duration(0.03), ros::Duration(0.0201),
        ros::Duration(-0.02), ros::Duration(-1), ros::Duration(0, -1), ros::Duration(-0.04)}) {
    message.duration = duration;
    const Refused r = refused([&] { f.rules.scheduled(message); });
    EXPECT_EQ(r.refusal, Refusal::kDuration) << duration;
    EXPECT_TRUE(contains(r.what, {"duration", "0.02 s"}));
  }
}

TEST(InputDuration, AtTheEndsOfWhatRosCanHoldIsTakenOrRefused) {
  const Fixture f;
  BodyWrench message = scheduledIn("pod");
  message.duration.sec = std::numeric_limits<std::int32_t>::max();
  EXPECT_EQ(f.rules.scheduled(message).ticks, Tick{2147483647} * 50);
  message.duration.sec = std::numeric_limits<std::int32_t>::min();
  message.duration.nsec = std::numeric_limits<std::int32_t>::min();
  EXPECT_EQ(refused([&] { f.rules.scheduled(message); }).refusal, Refusal::kDuration);
}

TEST(Refusals, AllHaveAText) {
  for (int i = 0; i < kRefusalCount; ++i) EXPECT_STRNE(toText(static_cast<Refusal>(i)), "");
}

}  // namespace
}  // namespace rigid_body_sim

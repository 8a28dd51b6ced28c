// How large an input may be, and what numbers are none.

#include "input_rules_fixture.hpp"

namespace rigid_body_sim {
namespace {

// ---- Numbers

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

}  // namespace
}  // namespace rigid_body_sim

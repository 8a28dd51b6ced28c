#pragma once

// Bodies, rules and messages for the tests of what inputs mean.

#include <functional>

#include "generic.hpp"
#include "node/input_rules.hpp"

namespace rigid_body_sim {

const Vector3d kForce(1.3, -0.7, 2.1);
const Vector3d kTorque(0.4, 0.9, -1.6);
const Vector3d kPoint(0.5, -0.2, 0.9);
constexpr Eigen::Index kAsset = 0, kOther = 1, kDust = 2;
constexpr Tick kNow = 150;  // 4 s: it began at 1 s

// Sums of products of a few numbers below 10.
constexpr double kTolerance = 100 * kEps;

inline Isometry3d podInLink() {
  Isometry3d X_LF = Isometry3d::Identity();
  X_LF.linear() = Quaterniond(-0.2, 0.5, 0.7, 0.3).normalized().toRotationMatrix();
  X_LF.translation() << 0.6, 0.3, -0.8;
  return X_LF;
}

/// A turning body with a full tensor, an offset centre of mass and a lumped link `pod`; another
/// one; and a point mass.
inline Scene sceneOfThree() {
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

inline NodeOptions optionsFrom(const std::string& yaml) {
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

inline void set(geometry_msgs::Vector3& message, const Vector3d& vector) {
  message.x = vector.x();
  message.y = vector.y();
  message.z = vector.z();
}

inline void set(geometry_msgs::Point& message, const Vector3d& vector) {
  message.x = vector.x();
  message.y = vector.y();
  message.z = vector.z();
}

inline geometry_msgs::WrenchStamped wrenchIn(const std::string& frame) {
  geometry_msgs::WrenchStamped message;
  message.header.frame_id = frame;
  set(message.wrench.force, kForce);
  set(message.wrench.torque, kTorque);
  return message;
}

inline ImpulseStamped impulseIn(const std::string& frame) {
  ImpulseStamped message;
  message.header.frame_id = frame;
  set(message.linear, kForce);
  set(message.angular, kTorque);
  return message;
}

inline BodyWrench scheduledIn(const std::string& frame, const std::string& point_frame = "") {
  BodyWrench message;
  message.body = "asset";
  message.frame = frame;
  message.point_frame = point_frame;
  set(message.point, kPoint);
  set(message.wrench.force, kForce);
  set(message.wrench.torque, kTorque);
  return message;
}

inline BodyImpulse impulseAtPoint(const std::string& frame, const std::string& point_frame = "") {
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

inline Refused refused(const std::function<void()>& f) {
  try {
    f();
  } catch (const RefusedInput& refused) {
    return {refused.refusal, refused.what()};
  }
  ADD_FAILURE() << "not refused";
  return {};
}

}  // namespace rigid_body_sim

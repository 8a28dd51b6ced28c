#pragma once

// Pushes on the bodies of scenes/probe.yaml, and what they should give.

#include <geometry_msgs/WrenchStamped.h>
#include <rigid_body_sim/BodyImpulses.h>
#include <rigid_body_sim/BodyWrenches.h>
#include <rigid_body_sim/ImpulseStamped.h>

#include <memory>

#include "probe.hpp"
#include "ros_fixture.hpp"

namespace rigid_body_sim {

using geometry_msgs::WrenchStamped;

inline geometry_msgs::Vector3 toVector3(const Vector3d& v) {
  geometry_msgs::Vector3 message;
  message.x = v.x();
  message.y = v.y();
  message.z = v.z();
  return message;
}

inline geometry_msgs::Point toPoint(const Vector3d& v) {
  geometry_msgs::Point message;
  message.x = v.x();
  message.y = v.y();
  message.z = v.z();
  return message;
}

inline WrenchStamped wrenchIn(const std::string& frame, const Vector3d& force,
                              const Vector3d& torque = Vector3d::Zero(),
                              const ros::Time& stamp = {}) {
  WrenchStamped message;
  message.header.frame_id = frame;
  message.header.stamp = stamp;
  message.wrench.force = toVector3(force);
  message.wrench.torque = toVector3(torque);
  return message;
}

inline ImpulseStamped impulseIn(const std::string& frame, const Vector3d& linear,
                                const Vector3d& angular = Vector3d::Zero(),
                                const ros::Time& stamp = {}) {
  ImpulseStamped message;
  message.header.frame_id = frame;
  message.header.stamp = stamp;
  message.linear = toVector3(linear);
  message.angular = toVector3(angular);
  return message;
}

inline BodyWrench bodyWrench(const std::string& body, const std::string& frame,
                             const Vector3d& force, const Vector3d& torque, double duration_s) {
  BodyWrench entry;
  entry.body = body;
  entry.frame = frame;
  entry.wrench.force = toVector3(force);
  entry.wrench.torque = toVector3(torque);
  entry.duration = ros::Duration(duration_s);
  return entry;
}

inline BodyImpulse bodyImpulse(const std::string& body, const std::string& frame,
                               const Vector3d& linear, const Vector3d& angular) {
  BodyImpulse entry;
  entry.body = body;
  entry.frame = frame;
  entry.linear = toVector3(linear);
  entry.angular = toVector3(angular);
  return entry;
}

template <class Array, class Entry>
Array arrayOf(const std::vector<Entry>& entries);

template <>
inline BodyWrenches arrayOf(const std::vector<BodyWrench>& entries) {
  BodyWrenches array;
  array.wrenches = entries;
  return array;
}

template <>
inline BodyImpulses arrayOf(const std::vector<BodyImpulse>& entries) {
  BodyImpulses array;
  array.impulses = entries;
  return array;
}

/// How a push is meant: axes that are the world's or fixed to the body, and a point of the body.
struct Meaning {
  bool is_world;
  Matrix3d R_LA;  ///< axes, if fixed to the body
  Vector3d p_LQ;  ///< point of application [m], in the root link frame
};

/// What a push gives to a body at the attitude R_WL: force and torque about the centre of mass in
/// world axes, or the impulses. Newton and Euler, nothing else.
inline Momentum given(const Solid& body, const Meaning& meaning, const Matrix3d& R_WL,
                      const Vector3d& force, const Vector3d& torque) {
  const Matrix3d R_WA = meaning.is_world ? Matrix3d(Matrix3d::Identity()) : R_WL * meaning.R_LA;
  const Vector3d f_W = R_WA * force;
  return {f_W, R_WA * torque + (R_WL * (meaning.p_LQ - body.p_LBcm)).cross(f_W)};
}

inline Momentum operator+(const Momentum& a, const Momentum& b) {
  return {a.P_WB + b.P_WB, a.L_WBcm_W + b.L_WBcm_W};
}
inline Momentum operator*(double factor, const Momentum& a) {
  return {factor * a.P_WB, factor * a.L_WBcm_W};
}

/// Momentum goes through the published quaternion and velocities and back, each with a handful of
/// roundings, of the size of the momentum: some 1e-15 of it. The issue promises 1e-12.
constexpr double kRelative = 1e-12;

inline void expectMomentum(const Momentum& found, const Momentum& wanted) {
  EXPECT_LE((found.P_WB - wanted.P_WB).norm(), kRelative * wanted.P_WB.norm())
      << found.P_WB.transpose() << " instead of " << wanted.P_WB.transpose();
  EXPECT_LE((found.L_WBcm_W - wanted.L_WBcm_W).norm(), kRelative * wanted.L_WBcm_W.norm())
      << found.L_WBcm_W.transpose() << " instead of " << wanted.L_WBcm_W.transpose();
}

/// Pushes through all four kinds of topic, which stay connected from test to test.
class PushTest : public testing::Test {
 protected:
  struct Topics {
    Sim sim;
    Input<WrenchStamped> wrench{sim, "/probe/wrench"};
    Input<WrenchStamped> puck_wrench{sim, "/puck/wrench"};
    Input<ImpulseStamped> impulse{sim, "/probe/impulse"};
    Input<BodyWrenches> wrenches{sim, "/wrenches"};
    Input<BodyImpulses> impulses{sim, "/impulses"};
  };

  static void SetUpTestSuite() { topics_ = std::make_unique<Topics>(); }
  static void TearDownTestSuite() { topics_.reset(); }

  void SetUp() override {
    sim.pause();
    sim.reset();
  }

  template <class... Entries>
  void sendWrenches(const Entries&... entries) {
    topics_->wrenches.send(arrayOf<BodyWrenches>(std::vector<BodyWrench>{entries...}));
  }
  template <class... Entries>
  void sendImpulses(const Entries&... entries) {
    topics_->impulses.send(arrayOf<BodyImpulses>(std::vector<BodyImpulse>{entries...}));
  }

  inline static std::unique_ptr<Topics> topics_;

  Sim& sim = topics_->sim;
  Input<WrenchStamped>& wrench = topics_->wrench;
  Input<WrenchStamped>& puck_wrench = topics_->puck_wrench;
  Input<ImpulseStamped>& impulse = topics_->impulse;
  const Solid body = probe();
};

}  // namespace rigid_body_sim

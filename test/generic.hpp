#pragma once

// Things of no special shape for the tests: a transposed matrix, a swapped axis or a lost sign
// shows in every component.

#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <random>
#include <stdexcept>
#include <string>

#include "reference/cases.hpp"
#include "rigid_body_sim/rotation.hpp"
#include "rigid_body_sim/scene.hpp"
#include "rigid_body_sim/simulator.hpp"

namespace rigid_body_sim {

constexpr double kEps = std::numeric_limits<double>::epsilon();
constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kPi = 3.14159265358979323846;

inline Quaterniond genericAttitude() { return Quaterniond(0.43, -0.51, 0.62, 0.41).normalized(); }

inline Isometry3d genericPose() {
  Isometry3d X = Isometry3d::Identity();
  X.linear() = genericAttitude().toRotationMatrix();
  X.translation() << 1.7, -0.9, 2.3;
  return X;
}

/// A full tensor and a centre of mass off the origin. Its principal moments, about 1.22, 1.88 and
/// 2.40 kg m^2, obey the triangle inequality.
inline MassProperties genericBody() {
  MassProperties body;
  body.mass = 2.7;
  body.p_FBcm << 0.11, -0.23, 0.37;
  body.I_BBcm_F << 1.6, -0.3, 0.2, -0.3, 2.1, 0.4, 0.2, 0.4, 1.8;
  return body;
}

inline SceneBody genericSceneBody(const std::string& name) {
  SceneBody body;
  body.name = name;
  body.mass_properties = genericBody();
  body.X_WL = genericPose();
  body.v_WBcm << 0.4, -1.1, 0.6;
  body.w_WB_L << 1.3, 0.7, -0.9;
  return body;
}

/// The case turned to `q_WB`.
inline SceneBody sceneBodyOf(const reference::Case& one,
                             const Quaterniond& q_WB = Quaterniond::Identity()) {
  SceneBody body;
  body.name = one.name;
  body.mass_properties.mass = one.mass;
  body.mass_properties.I_BBcm_F = one.I_BBcm_B.asDiagonal();
  body.X_WL.linear() = q_WB.toRotationMatrix();
  body.w_WB_L = one.w_WB_B;
  return body;
}

inline Scene sceneOf(const SceneBody& body, const std::string& integrator = Scene().integrator) {
  Scene scene;
  scene.integrator = integrator;
  scene.bodies = {body};
  return scene;
}

/// Numbers that are the same on every platform, in [-1, 1).
class Sampler {
 public:
  explicit Sampler(std::uint32_t seed) : engine_(seed) {}
  double number() { return engine_() * 0x1p-31 - 1; }
  double between(double low, double high) { return low + (high - low) * 0.5 * (number() + 1); }
  Vector3d vector() {
    const double x = number(), y = number(), z = number();
    return {x, y, z};
  }
  Quaterniond attitude() {
    Eigen::Vector4d q;
    do {
      for (int i = 0; i < 4; ++i) q(i) = number();
    } while (q.norm() > 1 || q.norm() < 0.1);
    return Quaterniond(q.normalized());
  }

 private:
  std::mt19937 engine_;
};

/// Angle [rad] between two attitudes.
inline double angleBetween(const Quaterniond& a, const Quaterniond& b) {
  return rotationLog(a.conjugate() * b).norm();
}

/// True if both have the same bits (so that -0 differs from 0, and NaN equals itself).
template <class Matrix>
bool sameBits(const Matrix& a, const Matrix& b) {
  return a.size() == b.size() &&
         std::memcmp(a.data(), b.data(), sizeof(double) * static_cast<std::size_t>(a.size())) == 0;
}

inline bool sameBits(const BodyState& a, const BodyState& b) {
  return sameBits(a.p_WBcm, b.p_WBcm) && sameBits(a.q_WB.coeffs(), b.q_WB.coeffs()) &&
         sameBits(a.P_WB, b.P_WB) && sameBits(a.L_WBcm_W, b.L_WBcm_W) && sameBits(a.p_low, b.p_low);
}

inline bool sameBits(const Bodies& a, const Bodies& b) {
  for (Eigen::Index i = 0; i < a.count(); ++i)
    if (!sameBits(a.state(i), b.state(i))) return false;
  return a.count() == b.count();
}

/// Largest difference of the components.
template <class A, class B>
double difference(const A& a, const B& b) {
  return (a - b).cwiseAbs().maxCoeff();
}

/// What `f` says when it refuses; fails if it does not refuse.
template <class F>
std::string refusal(const F& f) {
  try {
    f();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  ADD_FAILURE() << "not refused";
  return {};
}

/// True if every one of `parts` is in `text`.
inline testing::AssertionResult contains(const std::string& text,
                                         const std::vector<std::string>& parts) {
  for (const std::string& part : parts)
    if (text.find(part) == std::string::npos)
      return testing::AssertionFailure() << "no '" << part << "' in: " << text;
  return testing::AssertionSuccess();
}

/// A scene from the text of its file; an unknown key is refused.
inline Scene sceneFrom(const std::string& yaml) {
  const Parameters parameters(readYaml(yaml, "test.yaml"), "");
  Scene scene = readScene(parameters, {});
  parameters.refuseUnknown();
  return scene;
}

}  // namespace rigid_body_sim

#include "scene.hpp"

#include <cmath>
#include <stdexcept>

#include "reference/cases.hpp"
#include "reference/free_rotation.hpp"
#include "rigid_body_sim/rotation.hpp"

namespace rigid_body_sim::bench {
namespace {

const std::vector<Load>& loads() {
  static const std::vector<Load> all = {
      {"free", false, Gyroscopic::kOn, false},
      {"gravity", true, Gyroscopic::kOff, false},
      {"gyroscopic", true, Gyroscopic::kOn, false},
      {"wrench", true, Gyroscopic::kOn, true},
  };
  return all;
}

/// The body with this index; far enough apart never to touch.
BodyState startOf(Eigen::Index i, const reference::Case& one) {
  constexpr Eigen::Index kRow = 100;
  constexpr double kApart = 10;  // [m]
  const auto k = static_cast<double>(i);
  BodyState state;
  state.p_WBcm =
      kApart * Vector3d(static_cast<double>(i % kRow), static_cast<double>(i / kRow % kRow),
                        static_cast<double>(i / (kRow * kRow)));
  state.q_WB = rotationExp(Vector3d(0.7 + std::sin(k), -1.1 + std::cos(k), 0.4));
  state.P_WB = one.mass * Vector3d(0.1, -0.2, 0.3);
  const Vector3d w_WB_B = (1 + 0.1 * std::sin(k)) * one.w_WB_B;
  state.L_WBcm_W = state.q_WB * one.I_BBcm_B.cwiseProduct(w_WB_B);
  return state;
}

}  // namespace

Load loadNamed(const std::string& name) {
  for (const Load& load : loads())
    if (load.name == name) return load;
  throw std::invalid_argument("there is no load '" + name + "'");
}

Scene makeScene(const Load& load, Eigen::Index count, double step_s) {
  const reference::Case& one = reference::caseNamed("dzhanibekov");
  Scene scene;
  scene.load = load;
  scene.step_s = step_s;
  if (load.has_gravity) scene.g_W = {0, 0, -9.81};
  scene.bodies = Bodies(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    scene.bodies.mass(i) = one.mass;
    scene.bodies.I_BBcm_B.row(i) = one.I_BBcm_B;
    scene.bodies.setState(i, startOf(i, one));
  }
  if (load.has_wrenches) {
    // Small enough to leave the motion what it is: a thousand steps add a tenth of the momentum.
    scene.wrenches->f_W = Column3::Random(count, 3) * 0.1;
    scene.wrenches->t_Bcm_W = Column3::Random(count, 3) * 0.05;
  }
  return scene;
}

double attitudeError(const Scene& scene, const Quaterniond& q_WB, double time_s) {
  const BodyState start = scene.bodies.state(0);
  const reference::Quaternionr truth =
      reference::freeAttitudes(scene.bodies.moments(0), start.q_WB, start.L_WBcm_W, time_s, 1)
          .back();
  const reference::Quaternionr off = truth.conjugate() * q_WB.cast<reference::Real>().normalized();
  return static_cast<double>(2 * std::atan2(off.vec().norm(), std::abs(off.w())));
}

}  // namespace rigid_body_sim::bench

#pragma once

#include <memory>

#include "rigid_body_sim/effect.hpp"
#include "rigid_body_sim/integrator.hpp"

namespace rigid_body_sim::bench {

/// What acts on the bodies.
struct Load {
  std::string name;
  bool has_gravity = false;
  Gyroscopic gyroscopic = Gyroscopic::kOn;
  bool has_wrenches = false;  ///< one on every body, given anew every step
};

/// `free`, `gravity` (without the gyroscopic term, as many engines are run), `gyroscopic` (with
/// it), `wrench` (the same with a wrench on every body). @throws std::invalid_argument for others.
Load loadNamed(const std::string& name);

/// What every engine simulates: bodies that never touch.
struct Scene {
  Load load;
  double step_s = 0.02;  ///< [s]
  Vector3d g_W = Vector3d::Zero();
  Bodies bodies;
  /// For a load that has them; all copies of a scene share them, so that who flies it may change
  /// them from step to step.
  std::shared_ptr<Wrenches> wrenches = std::make_shared<Wrenches>();
  /// From the point whose motion an engine keeps, where it keeps another than that of the centre of
  /// mass, in B; no row: none.
  Column3 p_OBcm_B;

  Vector3d offset(Eigen::Index i) const {
    return p_OBcm_B.rows() > 0 ? Vector3d(p_OBcm_B.row(i)) : Vector3d::Zero();
  }
  Vector3d v_WBcm(Eigen::Index i) const { return velocity(bodies.state(i), bodies.mass(i)); }
  Vector3d w_WB(Eigen::Index i) const {
    return angularVelocity(bodies.state(i), bodies.moments(i));
  }
  Vector3d w_WB_B(Eigen::Index i) const {
    return angularVelocityInBody(bodies.state(i), bodies.moments(i));
  }
};

/// `count` bodies on a grid, the first of them the case `dzhanibekov` of src/reference at a generic
/// attitude; the others are the same body at other attitudes and rates, so that no branch is taken
/// by all of them alike.
Scene makeScene(const Load& load, Eigen::Index count, double step_s);

/// Angle [rad] between `q_WB` and the true attitude of the first body after `time_s` [s] of a load
/// that turns nothing.
double attitudeError(const Scene& scene, const Quaterniond& q_WB, double time_s);

}  // namespace rigid_body_sim::bench

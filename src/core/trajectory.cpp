#include "rigid_body_sim/trajectory.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "core/part.hpp"
#include "rigid_body_sim/rotation.hpp"
#include "rigid_body_sim/simulator.hpp"

namespace rigid_body_sim {
namespace {

/// In epsilons of the angle turned. Measured over 200 bodies, a minute each: up to 4.0, and 8.4 for
/// those that turn within a hundredth of their middle axis, where small differences grow.
constexpr double kRoundingOfStart = 16;

double larger(double a, double b) {
  if (std::isnan(a) || std::isnan(b)) return std::numeric_limits<double>::infinity();
  return std::max(a, b);
}

TrueTrajectory comparedWith(Trajectory best, const Trajectory& other, std::string how) {
  const Deviation doubt = deviation(best, other);
  return {std::move(best), doubt, std::move(how)};
}

/// What two flights of free bodies do not tell by their difference [rad]: the momentum in body axes
/// that both start from is rounded, and with it the rates that they turn at for `time_s`.
double commonRounding(const Trajectory& trajectory, double time_s) {
  double rate = 0;
  for (const Bodies& sample : trajectory.samples) rate = std::max(rate, fastestOf(sample).rate);
  return kRoundingOfStart * std::numeric_limits<double>::epsilon() * (1 + rate * time_s);
}

/// Doubt in one number: a radian counts as much as a metre.
double size(const Deviation& doubt) { return larger(doubt.attitude_rad, doubt.position_m); }

}  // namespace

Scene withMethod(Scene scene, const Method& method) {
  scene.integrator = method.integrator;
  scene.substeps = method.substeps;
  scene.tolerance = method.tolerance;
  scene.methods.clear();
  scene.accuracy.reset();
  return scene;
}

Trajectory fly(Scene scene, const Method& method, Tick ticks, Tick every) {
  if (every <= 0 || ticks < 0 || ticks % every != 0)
    throw std::invalid_argument("the ticks of a trajectory must be a multiple of its samples'");
  Simulator simulator(withMethod(std::move(scene), method));
  Trajectory trajectory = {every, {simulator.bodies()}};
  for (Tick tick = 1; tick <= ticks; ++tick) {
    simulator.step();
    if (tick % every == 0) trajectory.samples.push_back(simulator.bodies());
  }
  return trajectory;
}

Deviation worse(const Deviation& a, const Deviation& b) {
  return {larger(a.attitude_rad, b.attitude_rad), larger(a.position_m, b.position_m)};
}

Deviation deviation(const Bodies& a, const Bodies& b, Eigen::Index body) {
  const BodyState one = a.state(body), other = b.state(body);
  return {rotationLog(one.q_WB.conjugate() * other.q_WB).norm(),
          (one.p_WBcm - other.p_WBcm).norm()};
}

Deviation deviation(const Trajectory& a, const Trajectory& b) {
  if (a.every != b.every || a.samples.size() != b.samples.size())
    throw std::invalid_argument("the trajectories have different samples");
  Deviation worst;
  for (std::size_t k = 0; k < a.samples.size(); ++k)
    for (Eigen::Index i = 0; i < a.samples[k].count(); ++i)
      worst = worse(worst, deviation(a.samples[k], b.samples[k], i));
  return worst;
}

TrueTrajectory truest(const std::function<Trajectory(const Method&)>& fly, bool is_free,
                      double time_s) {
  TrueTrajectory best =
      comparedWith(fly({"exact"}), fly({"exact", 2}), "exact, against itself in half steps");
  if (is_free) {
    best.doubt.attitude_rad += commonRounding(best.trajectory, time_s);
    return best;
  }
  // Half ticks, not another tolerance: one step a tick may do for both.
  try {
    TrueTrajectory adaptive =
        comparedWith(fly({"adaptive", 1, 1e-14}), fly({"adaptive", 2, 1e-14}),
                     "adaptive with a tolerance of 1e-14, against itself in half ticks");
    return size(adaptive.doubt) < size(best.doubt) ? adaptive : best;
  } catch (const std::invalid_argument&) {
    return best;  // a spin that it is refused for; anything else `exact` is refused for, too
  }
}

TrueTrajectory flyTruly(const Scene& scene, Tick ticks, Tick every) {
  return truest([&](const Method& method) { return fly(scene, method, ticks, every); },
                scene.effects.empty(), static_cast<double>(ticks) * scene.step_s());
}

}  // namespace rigid_body_sim

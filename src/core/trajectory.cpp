#include "rigid_body_sim/trajectory.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "core/friction.hpp"
#include "core/part.hpp"
#include "rigid_body_sim/rotation.hpp"
#include "rigid_body_sim/simulator.hpp"

namespace rigid_body_sim {
namespace {

/// In epsilons of the angle turned. Measured over 200 bodies, a minute each: up to 4.0, and 8.4 for
/// those that turn within a hundredth of their middle axis, where small differences grow.
constexpr double kRoundingOfStart = 16;

constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

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

/// Of the samples that are numbers; their times to within what they are apart.
Decay fastestDecay(const Trajectory& trajectory, const Course& course) {
  Decay fastest;
  for (std::size_t k = 0; k < trajectory.samples.size(); ++k) {
    const double time_s =
        course.start_s + static_cast<double>(k) * static_cast<double>(course.every) * course.tick_s;
    Decay decay = fastestDecay(course.effects, Instant(trajectory.samples[k], time_s));
    if (std::isfinite(decay.rate) && decay.rate > fastest.rate) fastest = std::move(decay);
  }
  return fastest;
}

Unplannable noReference(const Decay& decay, double tick_s) {
  std::ostringstream why;
  why << (decay.names.empty() ? "what acts on it" : decay.names) << " is too stiff: ";
  if (decay.rate > 0)
    why << "it slows it down at " << decay.rate << " 1/s, " << decay.rate * tick_s
        << " times in a tick; ";
  why << "there is no reference to hold methods against, as even `adaptive` cannot follow it";
  return {why.str(), decay.body};
}

/// Where kick - drift - kick is no reference: by `adaptive`, in pieces of a tick that are short
/// enough for it. A flight may meet more than there is at its start, and may then end in no
/// numbers.
TrueTrajectory trueUnderFlows(const std::function<Trajectory(const Method&)>& fly,
                              const Course& course) {
  Decay decay = fastestDecay(course.effects, Instant(course.start, course.start_s));
  const double turn = fastestOf(course.start).rate * course.tick_s;
  const double wanted_by_spin = std::ceil(turn / integratorNamed("adaptive").max_turn);
  int pieces = std::max(piecesFor(decay.rate * course.tick_s),
                        static_cast<int>(std::min(wanted_by_spin, kMostPieces + 1.0)));
  while (pieces <= kMostPieces) {
    std::string how = "adaptive with a tolerance of 1e-14, against itself in half ticks";
    if (pieces > 1)
      how = "adaptive x " + std::to_string(pieces) +
            " with a tolerance of 1e-14, against itself in half steps";
    TrueTrajectory truth = comparedWith(fly({"adaptive", pieces, 1e-14}),
                                        fly({"adaptive", 2 * pieces, 1e-14}), std::move(how));
    if (Decay met = fastestDecay(truth.trajectory, course); met.rate > decay.rate)
      decay = std::move(met);
    const int wanted = piecesFor(decay.rate * course.tick_s);
    if (wanted <= pieces && std::isfinite(size(truth.doubt))) return truth;
    pieces = std::max(wanted, 2 * pieces);
  }
  throw noReference(decay, course.tick_s);
}

Trajectory flyOn(Simulator& simulator, Tick ticks, Tick every) {
  Trajectory trajectory = {every, {simulator.bodies()}};
  for (Tick tick = 1; tick <= ticks; ++tick) {
    simulator.step();
    if (tick % every == 0) trajectory.samples.push_back(simulator.bodies());
  }
  return trajectory;
}

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
  return flyOn(simulator, ticks, every);
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

TrueTrajectory truest(const std::function<Trajectory(const Method&)>& fly, const Course& course) {
  if (haveFlows(course.effects)) return trueUnderFlows(fly, course);
  TrueTrajectory best =
      comparedWith(fly({"exact"}), fly({"exact", 2}), "exact, against itself in half steps");
  if (course.effects.empty()) {
    const double time_s = static_cast<double>(course.ticks) * course.tick_s;
    best.doubt.attitude_rad += commonRounding(best.trajectory, time_s);
    return best;
  }
  const double turn = fastestOf(course.start).rate * course.tick_s;
  if (turn > integratorNamed("adaptive").max_turn) return best;  // it would be refused
  // Half ticks, not another tolerance: one step a tick may do for both.
  TrueTrajectory adaptive =
      comparedWith(fly({"adaptive", 1, 1e-14}), fly({"adaptive", 2, 1e-14}),
                   "adaptive with a tolerance of 1e-14, against itself in half ticks");
  return size(adaptive.doubt) < size(best.doubt) ? adaptive : best;
}

TrueTrajectory flyTruly(const Scene& scene, Tick ticks, Tick every) {
  const Method adaptive = {"adaptive", kMostSubsteps, 1e-14};  // to begin with: never refused
  const Simulator start(withMethod(scene, adaptive));
  const auto flown = [&](const Method& method) {
    Simulator simulator(withMethod(scene, method));
    Trajectory trajectory = flyOn(simulator, ticks, every);
    // It stays where it was; flights that stop there would agree.
    for (const FrozenBody& frozen : simulator.frozenBodies())
      trajectory.samples.back().p_WBcm.row(frozen.body).setConstant(kNaN);
    return trajectory;
  };
  try {
    return truest(flown, {scene.effects, start.bodies(), 0, scene.step_s(), ticks, every});
  } catch (const Unplannable& none) {
    return {fly(scene, {"exact"}, ticks, every), {kInf, kInf}, none.what()};
  }
}

}  // namespace rigid_body_sim

#include "tools/accuracy_report/errors.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "rigid_body_sim/conserved.hpp"
#include "rigid_body_sim/simulator.hpp"

namespace rigid_body_sim::report {
namespace {

double energyOf(const Bodies& bodies, Eigen::Index i) {
  return kineticEnergy(bodies.state(i), bodies.mass(i), bodies.moments(i));
}

double momentumOf(const Bodies& bodies, Eigen::Index i) { return bodies.state(i).L_WBcm_W.norm(); }

/// Per body, the largest of the true flight: what energies and momenta are relative to.
struct Scales {
  Eigen::VectorXd energy;
  Eigen::VectorXd momentum;

  explicit Scales(const Trajectory& truth)
      : energy(Eigen::VectorXd::Zero(truth.samples.front().count())), momentum(energy) {
    for (const Bodies& bodies : truth.samples) {
      for (Eigen::Index i = 0; i < bodies.count(); ++i) {
        energy(i) = std::max(energy(i), energyOf(bodies, i));
        momentum(i) = std::max(momentum(i), momentumOf(bodies, i));
      }
    }
  }
};

/// What never was there has no relative error.
double relative(double difference, double scale) {
  return scale > 0 ? std::abs(difference) / scale : 0;
}

/// The worst of all bodies; each one's goes into `worst_of`.
Errors errorsBetween(const Bodies& flown, const Bodies& truth, const Scales& scales,
                     std::vector<Deviation>& worst_of) {
  Errors worst;
  for (Eigen::Index i = 0; i < truth.count(); ++i) {
    const Errors one = {deviation(flown, truth, i),
                        relative(energyOf(flown, i) - energyOf(truth, i), scales.energy(i)),
                        relative(momentumOf(flown, i) - momentumOf(truth, i), scales.momentum(i))};
    worst = worse(worst, one);
    worst_of[i] = rigid_body_sim::worse(worst_of[i], one.pose);
  }
  return worst;
}

double larger(double a, double b) {
  if (std::isnan(a) || std::isnan(b)) return std::numeric_limits<double>::infinity();
  return std::max(a, b);
}

Errors infiniteErrors() {
  const double inf = std::numeric_limits<double>::infinity();
  return {{inf, inf}, inf, inf};
}

}  // namespace

Errors worse(const Errors& a, const Errors& b) {
  return {rigid_body_sim::worse(a.pose, b.pose), larger(a.energy, b.energy),
          larger(a.momentum, b.momentum)};
}

Eigen::Index firstToRotate(const Scene& scene) {
  const auto rotates = [](const SceneBody& body) { return !body.is_point_mass; };
  const auto found = std::find_if(scene.bodies.begin(), scene.bodies.end(), rotates);
  return found == scene.bodies.end() ? 0 : found - scene.bodies.begin();
}

FlightErrors errorsOf(const Scene& scene, const Method& method, const Trajectory& truth,
                      Eigen::Index shown) {
  using Clock = std::chrono::steady_clock;
  const auto start = Clock::now();
  const Scales scales(truth);
  Simulator simulator(withMethod(scene, method));
  FlightErrors flight;
  flight.worst_of.resize(scene.bodies.size());
  for (std::size_t k = 0; k < truth.samples.size(); ++k) {
    if (k > 0)
      for (Tick i = 0; i < truth.every && simulator.frozenBodies().empty(); ++i) simulator.step();
    if (!simulator.frozenBodies().empty()) {
      flight.infinite_after_s =
          static_cast<double>(simulator.frozenBodies().front().tick) * scene.step_s();
      flight.worst = flight.end = infiniteErrors();
      for (const auto& frozen : simulator.frozenBodies())
        flight.worst_of[frozen.body] = flight.worst.pose;
      break;
    }
    flight.end = errorsBetween(simulator.bodies(), truth.samples[k], scales, flight.worst_of);
    flight.worst = worse(flight.worst, flight.end);
    flight.samples.push_back({static_cast<double>(simulator.tick()) * scene.step_s(), flight.end,
                              deviation(simulator.bodies(), truth.samples[k], shown),
                              simulator.state(shown).q_WB});
  }
  flight.wall_s = std::chrono::duration<double>(Clock::now() - start).count();
  return flight;
}

double largestAngularSpeed(const Trajectory& trajectory) {
  double largest = 0;
  for (const Bodies& bodies : trajectory.samples)
    for (Eigen::Index i = 0; i < bodies.count(); ++i)
      largest = std::max(largest, angularVelocityInBody(bodies.state(i), bodies.moments(i)).norm());
  return largest;
}

}  // namespace rigid_body_sim::report

#include "tools/accuracy_report/truth.hpp"

#include <algorithm>
#include <sstream>
#include <stdexcept>
#include <utility>
#include <vector>

#include "reference/flight.hpp"
#include "tools/accuracy_report/errors.hpp"

namespace rigid_body_sim::report {
namespace {

/// [rad] of rotation in one piece of the third way: about as long as one takes few steps.
constexpr double kPieceTurn = 5;
constexpr double kMostTurns = 1e4;  // [rad] of all bodies together: some seconds

/// The samples between two at which the true flight is compared; at least one.
std::size_t samplesAPiece(const Trajectory& truth, const Scene& scene, double angular_speed) {
  const double sample_s = static_cast<double>(truth.every) * scene.step_s();
  const double samples = kPieceTurn / std::max(angular_speed, 1e-9) / sample_s;
  return static_cast<std::size_t>(
      std::max(1.0, std::min(samples, static_cast<double>(truth.samples.size() - 1))));
}

using Effects = std::vector<std::shared_ptr<const Effect>>;

/// The effects on one body alone. None if one of several bodies cannot be had without the others.
std::optional<Effects> effectsOn(const Scene& scene, Eigen::Index body) {
  if (scene.bodies.size() == 1) return scene.effects;
  Effects effects;
  for (const auto& effect : scene.effects) {
    effects.push_back(effect->restrictedTo({body}));
    if (!effects.back()) return std::nullopt;
  }
  return effects;
}

/// What the effects do to the body, `start_s` after the flight's start and later. The effects see
/// the state rounded to doubles.
reference::PushLaw pushLaw(const Effects& effects, const Bodies& bodies, Eigen::Index body,
                           double start_s) {
  Bodies alone(1);
  alone.mass(0) = bodies.mass(body);
  alone.I_BBcm_B.row(0) = bodies.I_BBcm_B.row(body);
  return [=](reference::Real time_s, const reference::State& state) mutable {
    alone.setState(0, reference::rounded(state));
    Wrenches wrenches = {Column3::Zero(1, 3), Column3::Zero(1, 3)};
    for (const auto& effect : effects)
      effect->addWrenches(Instant(alone, start_s + static_cast<double>(time_s)), wrenches);
    reference::Push push;
    push.f_W = wrenches.f_W.row(0).transpose().cast<reference::Real>();
    push.t_Bcm_W = wrenches.t_Bcm_W.row(0).transpose().cast<reference::Real>();
    return push;
  };
}

/// The largest difference of a body to its flight from the start in pieces of so many samples.
Deviation differenceOf(const Trajectory& truth, const Scene& scene, const Effects& effects,
                       Eigen::Index body, std::size_t piece) {
  const Bodies& start = truth.samples.front();
  const double sample_s = static_cast<double>(truth.every) * scene.step_s();
  const double piece_s = static_cast<double>(piece) * sample_s;
  reference::State state = reference::extended(start.state(body));
  Bodies flown = start;
  Deviation worst;
  for (std::size_t k = piece; k < truth.samples.size(); k += piece) {
    const double start_s = static_cast<double>(k - piece) * sample_s;
    const reference::Flight flight =
        reference::fly(state, start.mass(body), start.moments(body),
                       pushLaw(effects, start, body, start_s), piece_s);
    state = flight.extended_end;
    flown.setState(body, flight.end);
    worst = worse(worst, deviation(flown, truth.samples[k], body));
  }
  return worst;
}

}  // namespace

TrueTrajectory bestKnown(const Scene& scene, Tick ticks, Tick every) {
  TrueTrajectory truth = flyTruly(scene, ticks, every);
  const double angular_speed = largestAngularSpeed(truth.trajectory);
  const double time_s = static_cast<double>(ticks) * scene.step_s();
  if (!ungyroscopicBodies(scene).empty() || truth.trajectory.samples.front().hasAddedMass() ||
      angular_speed * time_s * static_cast<double>(scene.bodies.size()) > kMostTurns)
    return truth;
  const std::size_t piece = samplesAPiece(truth.trajectory, scene, angular_speed);
  Deviation difference;
  try {
    for (Eigen::Index i = 0; i < truth.trajectory.samples.front().count(); ++i) {
      const auto effects = effectsOn(scene, i);
      if (!effects) return truth;
      difference = worse(difference, differenceOf(truth.trajectory, scene, *effects, i, piece));
    }
  } catch (const std::runtime_error&) {
    return truth;  // the third way does not converge here: it says nothing
  }
  truth.doubt = worse(truth.doubt, difference);
  std::ostringstream words;
  words.precision(2);
  words << truth.how << "; and against order 16 in extended precision, " << difference.attitude_rad
        << " rad away";
  truth.how = words.str();
  return truth;
}

}  // namespace rigid_body_sim::report

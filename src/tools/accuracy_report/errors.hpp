#pragma once

#include <limits>
#include <vector>

#include "rigid_body_sim/trajectory.hpp"

namespace rigid_body_sim::report {

/// How far a flight is from the true one at one moment; the worst of all bodies.
struct Errors {
  Deviation pose;
  double energy = 0;    ///< |E - E_true| / E, kinetic; E the largest of the true flight
  double momentum = 0;  ///< ||L| - |L_true|| / |L| of the spin; L the largest of the true flight
};

/// Componentwise the larger; a NaN counts as infinite.
Errors worse(const Errors& a, const Errors& b);

struct ErrorSample {
  double time_s;
  Errors errors;
  Deviation shown;   ///< of the body that is shown alone
  Quaterniond q_WB;  ///< of that body
};

/// A flight held against the true one.
struct FlightErrors {
  Errors worst;
  Errors end;
  std::vector<Deviation> worst_of;  ///< each body's
  std::vector<ErrorSample> samples;
  double infinite_after_s = std::numeric_limits<double>::infinity();  ///< a body was frozen then;
                                                                      ///< no samples after it
  double wall_s = 0;  ///< that the flight took, comparisons included
};

/// The first body that rotates, or the first one.
Eigen::Index firstToRotate(const Scene& scene);

/// Flies `scene` by `method` as long as the true flight, and compares at its samples.
/// @param shown the body whose attitudes the samples hold
/// @throws std::invalid_argument as Simulator, when the method refuses the scene.
FlightErrors errorsOf(const Scene& scene, const Method& method, const Trajectory& truth,
                      Eigen::Index shown);

/// The fastest rotation of any body at any sample [rad/s].
double largestAngularSpeed(const Trajectory& trajectory);

}  // namespace rigid_body_sim::report

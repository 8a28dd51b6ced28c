#pragma once

#include <string>
#include <vector>

#include "rigid_body_sim/method.hpp"
#include "rigid_body_sim/scene.hpp"

namespace rigid_body_sim {

/// The states of a scene's bodies at the ticks 0, every, 2 every ...
struct Trajectory {
  Tick every = 1;
  std::vector<Bodies> samples;
};

/// The scene with one method for all bodies, instead of what it says of methods or accuracy.
Scene withMethod(Scene scene, const Method& method);

/// Flies a scene from its start, without inputs, by one method for all bodies. With `adaptive` the
/// steps are common to them: a body then moves as it would alone only to the tolerance.
/// @param ticks a multiple of `every`
/// @throws std::invalid_argument as Simulator.
Trajectory fly(Scene scene, const Method& method, Tick ticks, Tick every);

/// How far one pose is from another.
struct Deviation {
  double attitude_rad = 0;
  double position_m = 0;
};

/// Componentwise the larger; a NaN counts as infinite.
Deviation worse(const Deviation& a, const Deviation& b);

/// Of one body between two samples.
Deviation deviation(const Bodies& a, const Bodies& b, Eigen::Index body);

/// The largest of any body at any sample; both trajectories have the same samples.
Deviation deviation(const Trajectory& a, const Trajectory& b);

/// A trajectory to hold others against.
struct TrueTrajectory {
  Trajectory trajectory;
  Deviation doubt;  ///< how far a second way to the same answer is from it, at worst; for free
                    ///< bodies with the rounding that both have in common
  std::string how;  ///< both ways in words
};

/// The best that is known of a flight: `exact` if nothing acts on the bodies, else that or the
/// adaptive method, whichever is in less doubt. Under effects that have a flow and depend on
/// velocities, as friction, only the adaptive one: methods that go kick - drift - kick may agree
/// with themselves there and be wrong. If such effects are too stiff even for it, there is no
/// truth: the flight is that of `exact`, in infinite doubt, and `how` says why.
/// @throws std::invalid_argument as Simulator.
TrueTrajectory flyTruly(const Scene& scene, Tick ticks, Tick every);

}  // namespace rigid_body_sim

#pragma once

#include <functional>
#include <vector>

#include "rigid_body_sim/bodies.hpp"

namespace rigid_body_sim::reference {

/// What is true at the end of a flight.
struct Answer {
  std::vector<BodyState> end;
  /// How far the last bit of the angular momentum at the start (a relative change of 2^-52, in a
  /// direction along no axis) turns the end [rad]; of the body where it does most.
  double turn_of_an_ulp = 0;
};

/// From the start of a scene's bodies, after `time_s` [s] in steps of `step_s` [s].
using AnswerOf = std::function<Answer(const Bodies& start, double time_s, double step_s)>;

/// Bodies on which nothing acts: straight on, and freeAttitudes().
Answer freeFlight(const Bodies& start, double time_s, double step_s);

/// The same of bodies two of whose moments are equal, by symmetricTop(): for any number of turns.
Answer freeTops(const Bodies& start, double time_s, double step_s);

/// Bodies that turn about a constant axis at a constant rate: spheres, and those that start exactly
/// about a principal axis; or, without the gyroscopic term, any.
Answer steadyTurn(const Bodies& start, double time_s, double step_s);

/// Bodies that stay exactly where they are.
Answer rest(const Bodies& start, double time_s, double step_s);

/// Free flight, and the parabola under g_W [m/s^2].
AnswerOf freeFall(const Vector3d& g_W);

/// Velocities that fall by exp(-c t), c [1/s] linear and angular alike: the free flight at the time
/// (1 - exp(-c t)) / c, as L' = L x w - c L is Euler's equation in that time.
AnswerOf damped(double c);

/// A sphere in quadratic drag, m v' = -k |v| v and I w' = -k_w |w| w: v = v0 / (1 + k/m v0 t), and
/// the logarithm of the same for path and angle (NASA/TM-2015-218675 uses the same law).
/// @param k [kg/m]; k_w [kg m^2]
AnswerOf dragged(double k, double k_w);

/// A mass on a spring of no rest length to the origin, started at rest: the cosine.
/// @param rate [rad/s] of the swing
AnswerOf swing(double rate);

/// A torque in world axes that changes its sign every tick, on one body: fly() from tick to tick.
AnswerOf switchedTorque(const Vector3d& t_W);

/// Where only the angular momentum is known: L = L0 + gained, everything else as at the start.
AnswerOf gaining(const Vector3d& L_W);

}  // namespace rigid_body_sim::reference

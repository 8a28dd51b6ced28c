#pragma once

#include "rigid_body_sim/trajectory.hpp"

namespace rigid_body_sim::report {

/// flyTruly(); and where bodies do not act on each other, a third way is flown that shares no
/// formula with the integrators (reference/flight.hpp), and its difference counts to the doubt:
/// what both of the others do wrong in the same way shows there. Not with effects that are not
/// smooth, without the gyroscopic term, or when it would take long.
TrueTrajectory bestKnown(const Scene& scene, Tick ticks, Tick every);

}  // namespace rigid_body_sim::report

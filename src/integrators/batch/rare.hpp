#pragma once

// What the packs leave to the portable code, a lane at a time, as it is needed once in a long
// while.
namespace rigid_body_sim::batch {

/// Of an angle [rad] beyond what the packs' own functions can reduce, or none: by the C library.
void sinCosOfHuge(double x, double* sin, double* cos);

/// m = R^T L of a quaternion (x, y, z, w) and a vector, rounded once: a thin rod's own spin is a
/// small difference in it.
void momentumInBody(const double* q_WB, const double* L_W, double* m_B);

}  // namespace rigid_body_sim::batch

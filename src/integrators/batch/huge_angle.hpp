#pragma once

namespace rigid_body_sim::batch {

/// Of an angle [rad] beyond what the packs' own functions can reduce, or none: by the C library.
void sinCosOfHuge(double x, double* sin, double* cos);

}  // namespace rigid_body_sim::batch

#include "integrators/batch/huge_angle.hpp"

#include <cmath>

namespace rigid_body_sim::batch {

void sinCosOfHuge(double x, double* sin, double* cos) {
  *sin = std::sin(x);
  *cos = std::cos(x);
}

}  // namespace rigid_body_sim::batch

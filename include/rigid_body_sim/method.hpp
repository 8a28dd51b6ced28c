#pragma once

#include <string>
#include <vector>

#include "rigid_body_sim/conventions.hpp"

namespace rigid_body_sim {

/// A way to step bodies.
struct Method {
  std::string integrator = "exact";
  int substeps = 1;          ///< steps of the integrator a tick
  double tolerance = 1e-12;  ///< see IntegratorOptions
};

inline bool operator==(const Method& a, const Method& b) {
  return a.integrator == b.integrator && a.substeps == b.substeps && a.tolerance == b.tolerance;
}

/// `exact`, or `rk4 x 3` with substeps.
std::string toText(const Method& method);

/// Bodies of a scene that one method steps.
struct MethodOfBodies {
  std::vector<Eigen::Index> bodies;
  Method method;
};

/// The largest number of substeps that is taken for meant.
constexpr int kMostSubsteps = 10'000;

}  // namespace rigid_body_sim

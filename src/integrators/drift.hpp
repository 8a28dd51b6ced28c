#pragma once

#include "integrators/columns.hpp"
#include "integrators/ungyroscopic.hpp"

namespace rigid_body_sim {

/// Drift: free motion, in which P and L do not change; with a kick before it, if wanted, in the
/// same pass over memory.
class Drift {
 public:
  using Kernel = decltype(batch::Kernels::driftAtConstantRate);

  Drift(Kernel kernel, const IntegratorOptions& options)
      : kernel_(kernel), ungyroscopic_(options.ungyroscopic) {}

  /// For h [s]. @param kick wrenches that act for h before it; null for none
  void operator()(Bodies& bodies, const Wrenches* kick, double h) const {
    const batch::BodyColumns columns = columnsOf(bodies);
    const batch::WrenchColumns wrenches = kick ? columnsOf(*kick) : batch::WrenchColumns{};
    ungyroscopic_.forRuns(bodies.count(), [&](batch::Range range, Gyroscopic gyroscopic) {
      if (gyroscopic == Gyroscopic::kOn)
        return kernel_(columns, kick ? &wrenches : nullptr, h, range);
      if (kick) batch::kernels().kick(columns, wrenches, h, range);
      batch::kernels().driftWithoutGyroscopicTerm(columns, h, range);
    });
  }

 private:
  Kernel kernel_;
  Ungyroscopic ungyroscopic_;
};

}  // namespace rigid_body_sim

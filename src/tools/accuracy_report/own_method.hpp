#pragma once

#include <string>

#include "tools/accuracy_report/report.hpp"

namespace rigid_body_sim::report {

/// Which rows the simulator would fly this scene by, in a sentence: by its `integrator` and
/// `substeps`, or by those that its `accuracy` chooses now, which takes as long as at a start.
std::string ownMethod(const Report& report);

}  // namespace rigid_body_sim::report

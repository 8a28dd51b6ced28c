#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tools/accuracy_report/report.hpp"

namespace rigid_body_sim::report {

/// The cheapest row whose error is at most `tolerance` [rad or m]; null if there is none.
const Row* cheapestWithin(const Report& report, double tolerance);

/// What a rung would need for a tolerance that none of its rows keeps.
struct Extrapolation {
  double substeps;      ///< a tick
  double cost_ns;       ///< of a body's tick
  double slope;         ///< by which the error fell between its two finest rows
  double rounding;      ///< error [rad] that rounding alone would make at so many steps, growing as
                        ///< little as it can: as their root; NaN: not measured
  double rounding_sum;  ///< the same if no step's rounding makes up for another's
};

/// From the rung's two finest rows. None if it has no two, or their errors do not fall as its order
/// says: then nothing is known of smaller steps.
/// @param rounding of the finest row's flight, see roundingOf
std::optional<Extrapolation> extrapolate(const Report& report, const std::string& rung,
                                         double tolerance, double rounding);

/// Error that rounding makes in a flight by `method` [rad]: the largest difference to the same
/// flight from another attitude, which changes nothing else, over sqrt 2, as both are rounded. NaN
/// where the attitude does change something: with effects.
double roundingOf(const Report& report, const Method& method);

/// Whether positions of rotating bodies differ by more than rounding, or have a budget: then they
/// are reported besides the attitudes.
bool positionsMatter(const Report& report);

/// A few sentences that say what the rows say.
std::vector<std::string> digest(const Report& report);

}  // namespace rigid_body_sim::report

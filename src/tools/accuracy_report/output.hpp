#pragma once

#include <iosfwd>
#include <string>

#include "tools/accuracy_report/report.hpp"

namespace rigid_body_sim::report {

/// The report for a reader: what was flown, every row, and the digest.
void print(const Report& report, std::ostream& out);

/// Writes what scripts/plot_accuracy reads; makes the folder if it is not there.
///   case.csv     key, value: the scene, the reference, the body that is drawn
///   methods.csv  a line a row
///   effects.csv  a line an effect, if there are any
///   flights.csv  a line a sample, of each rung with its largest steps, and of the reference
/// Times are in s, errors in rad and m, energy and angular momentum relative, costs in ns of a body
/// and tick.
/// @throws std::invalid_argument if a file cannot be written
void writeCsv(const Report& report, const std::string& folder);

}  // namespace rigid_body_sim::report

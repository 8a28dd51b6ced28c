#include "tools/accuracy_report/output.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <ostream>
#include <sstream>
#include <stdexcept>
#include <vector>

#include "rigid_body_sim/simulator.hpp"
#include "tools/accuracy_report/digest.hpp"
#include "tools/accuracy_report/own_method.hpp"
#include "tools/csv.hpp"

namespace rigid_body_sim::report {
namespace {

using Cells = std::vector<std::string>;

std::string text(double number, int digits) {
  std::ostringstream text;
  text.precision(digits);
  text << number;
  return text.str();
}

/// For the console: two digits say how large an error is; a dash stands for what there is not.
std::string cell(double number, int digits = 2) {
  return std::isnan(number) ? "-" : text(number, digits);
}

std::string wholeCell(double number) {
  return std::isnan(number) ? "-" : std::to_string(std::llround(number));
}

/// An error below the doubt is known to be no larger than that, and no more.
std::string errorCell(double error, double doubt) {
  return error < doubt ? "<" + text(doubt, 2) : text(error, 2);
}

/// Two lines of titles, then a line a row.
std::vector<Cells> titles() {
  return {{"", "substeps", "attitude [rad]", "", "position [m]", "", "energy", "|L|", "evaluations",
           "instructions", "time [ns]", "simulated s", "best at"},
          {"rung", "a tick", "max", "end", "max", "end", "max", "max", "a tick", "a body-tick",
           "a body-tick", "a second", "its price"}};
}

Cells cellsOf(const Report& report, const Row& row) {
  const Errors &worst = row.flight.worst, &end = row.flight.end;
  const std::string substeps =
      row.adapts ? "tol " + text(row.method.tolerance, 1) : std::to_string(row.method.substeps);
  Cells cells = {row.method.integrator, substeps};
  if (row.outcome != Outcome::kFlown) {
    cells.push_back(row.why);
    return cells;
  }
  const Deviation& doubt = report.truth.doubt;
  for (const double error : {worst.pose.attitude_rad, end.pose.attitude_rad})
    cells.push_back(errorCell(error, doubt.attitude_rad));
  for (const double error : {worst.pose.position_m, end.pose.position_m})
    cells.push_back(errorCell(error, doubt.position_m));
  for (const double error : {worst.energy, worst.momentum}) cells.push_back(text(error, 2));
  cells.push_back(row.evaluations < 100 ? cell(row.evaluations, 3) : wholeCell(row.evaluations));
  cells.push_back(wholeCell(row.instructions));
  cells.push_back(wholeCell(row.cost.median_ns));
  cells.push_back(cell(realTimeFactor(report, row)));
  cells.push_back(row.is_on_front ? "*" : "");
  return cells;
}

/// Columns as wide as they need; the last cell of a short row may be longer than its column.
void printTable(const std::vector<Cells>& rows, std::ostream& out) {
  std::vector<std::size_t> widths(rows[0].size());
  for (const Cells& cells : rows)
    for (std::size_t i = 0; i < cells.size(); ++i)
      if (i + 1 < cells.size() || cells.size() == widths.size())
        widths[i] = std::max(widths[i], cells[i].size());
  for (const Cells& cells : rows) {
    std::ostringstream line;
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const auto width = static_cast<int>(widths[i]);
      line << (i == 0 ? std::left : std::right);
      line << std::setw(i + 1 == cells.size() ? 0 : width) << cells[i] << "  ";
    }
    const std::string whole = line.str();
    out << whole.substr(0, whole.find_last_not_of(' ') + 1) << '\n';
  }
}

std::string shortSummary(const Report& report) {
  const std::size_t count = report.scene.bodies.size();
  std::ostringstream text;
  text << report.name << ": " << (count == 1 ? "one body" : std::to_string(count) + " bodies")
       << ", a tick of " << report.scene.step_s() << " s, over " << report.over_s << " s ("
       << report.ticks << " ticks).";
  return text.str();
}

/// Lines of at most 100 characters.
std::string wrapped(const std::string& sentence) {
  std::istringstream words(sentence);
  std::string lines, line;
  for (std::string word; words >> word;) {
    if (!line.empty() && line.size() + 1 + word.size() > 98) {
      lines += line + "\n";
      line = " ";
    }
    line += (line.empty() ? "" : " ") + word;
  }
  return lines + line + "\n";
}

// ---- CSV

/// One number of CSV, with all its digits; empty for none.
std::string csv(double number) { return std::isnan(number) ? "" : text(number, 17); }

const char* nameOf(Outcome outcome) {
  switch (outcome) {
    case Outcome::kFlown:
      return "flown";
    case Outcome::kRefused:
      return "refused";
    case Outcome::kInfinite:
      return "infinite";
    case Outcome::kSkipped:
      return "skipped";
  }
  return "";
}

double startSpeed(const Bodies& start, Eigen::Index body) {
  return angularVelocityInBody(start.state(body), start.moments(body)).norm();
}

Eigen::Index fastestBody(const Bodies& start) {
  Eigen::Index fastest = 0;
  for (Eigen::Index i = 1; i < start.count(); ++i)
    if (startSpeed(start, i) > startSpeed(start, fastest)) fastest = i;
  return fastest;
}

void writeCase(const Report& report, const std::string& folder) {
  std::ofstream file = openCsv(folder, "case.csv");
  const Eigen::Index shown = report.shown;
  const Bodies& start = report.truth.trajectory.samples.front();
  const Eigen::Index fastest = fastestBody(start);
  const Eigen::Vector3d I = start.moments(shown);
  file << "key,value\n"
       << "name," << quoted(report.name) << "\nbodies," << report.scene.bodies.size() << "\nstep_s,"
       << csv(report.scene.step_s()) << "\nover_s," << csv(report.over_s) << "\nunit,"
       << (report.rotates ? "rad" : "m") << "\ndoubt," << csv(doubtOf(report)) << "\nhow,"
       << quoted(report.truth.how) << "\nbody," << quoted(report.scene.bodies[shown].name)
       << "\nangular_speed_rad_s," << csv(startSpeed(start, shown)) << "\nfastest,"
       << quoted(report.scene.bodies[fastest].name) << "\nfastest_rad_s,"
       << csv(startSpeed(start, fastest)) << "\neffects," << report.scene.effects.size()
       << "\npositions_matter," << positionsMatter(report) << "\nposition_doubt,"
       << csv(report.truth.doubt.position_m) << "\nmass_kg," << csv(start.mass(shown))
       << "\nI1_kg_m2," << csv(I(0)) << "\nI2_kg_m2," << csv(I(1)) << "\nI3_kg_m2," << csv(I(2))
       << "\n";
  for (const std::string& sentence : digest(report)) file << "digest," << quoted(sentence) << "\n";
  closeCsv(file, folder);
}

void writeMethods(const Report& report, const std::string& folder) {
  std::ofstream file = openCsv(folder, "methods.csv");
  file << "rung,substeps,tolerance,outcome,why,attitude_max,attitude_end,position_max,position_end,"
          "energy_max,energy_end,momentum_max,momentum_end,evaluations,instructions,cost_median,"
          "cost_least,real_time_factor,is_on_front\n";
  for (const Row& row : report.rows) {
    file << row.method.integrator << ',' << row.method.substeps << ','
         << (row.adapts ? csv(row.method.tolerance) : "") << ',' << nameOf(row.outcome) << ','
         << quoted(row.why);
    const bool has_errors = !row.flight.samples.empty();
    for (const auto& error : {&Errors::pose})
      for (const auto& part : {&Deviation::attitude_rad, &Deviation::position_m})
        file << ',' << (has_errors ? csv(row.flight.worst.*error.*part) : "") << ','
             << (has_errors ? csv(row.flight.end.*error.*part) : "");
    for (const auto& error : {&Errors::energy, &Errors::momentum})
      file << ',' << (has_errors ? csv(row.flight.worst.*error) : "") << ','
           << (has_errors ? csv(row.flight.end.*error) : "");
    file << ',' << csv(row.evaluations) << ',' << csv(row.instructions) << ','
         << (has_errors ? csv(row.cost.median_ns) : "") << ','
         << (has_errors ? csv(row.cost.least_ns) : "") << ','
         << (has_errors ? csv(realTimeFactor(report, row)) : "") << ',' << row.is_on_front << '\n';
  }
  closeCsv(file, folder);
}

void writeSample(std::ostream& file, const Method& method, const ErrorSample& sample) {
  const Quaterniond& q = sample.q_WB;
  file << method.integrator << ',' << method.substeps << ',' << csv(sample.time_s) << ','
       << csv(sample.errors.pose.attitude_rad) << ',' << csv(sample.errors.pose.position_m) << ','
       << csv(sample.errors.energy) << ',' << csv(sample.errors.momentum) << ','
       << csv(sample.shown.attitude_rad) << ',' << csv(q.x()) << ',' << csv(q.y()) << ','
       << csv(q.z()) << ',' << csv(q.w()) << '\n';
}

void writeFlights(const Report& report, const std::string& folder) {
  std::ofstream file = openCsv(folder, "flights.csv");
  file << "rung,substeps,time_s,attitude,position,energy,momentum,body_attitude,qx,qy,qz,qw\n";
  const Trajectory& truth = report.truth.trajectory;
  for (std::size_t k = 0; k < truth.samples.size(); ++k) {
    const double time_s =
        static_cast<double>(k) * static_cast<double>(truth.every) * report.scene.step_s();
    writeSample(file, {"reference"}, {time_s, {}, {}, truth.samples[k].state(report.shown).q_WB});
  }
  std::string last;
  for (const Row& row : report.rows) {
    if (row.method.integrator == last || row.flight.samples.empty()) continue;
    last = row.method.integrator;
    for (const ErrorSample& sample : row.flight.samples) writeSample(file, row.method, sample);
  }
  closeCsv(file, folder);
}

}  // namespace

void print(const Report& report, std::ostream& out) {
  out << shortSummary(report) << '\n'
      << wrapped("Reference: " + report.truth.how + ". In doubt by at most " +
                 cell(report.truth.doubt.attitude_rad) + " rad and " +
                 cell(report.truth.doubt.position_m) +
                 " m: below that nothing can be told apart. Energy (kinetic) and |L| (of the spin) "
                 "are relative to the reference's. The time is the processor's for all of a tick, "
                 "the median of "
                 "runs in turn.")
      << '\n';
  std::vector<Cells> rows = titles();
  for (const Row& row : report.rows) rows.push_back(cellsOf(report, row));
  printTable(rows, out);
  out << '\n';
  if (report.effects) {
    print(*report.effects, out);
    out << '\n';
  }
  if (report.says_own_method) out << wrapped(ownMethod(report));
  for (const std::string& sentence : digest(report)) out << wrapped(sentence);
}

void writeCsv(const Report& report, const std::string& folder) {
  prepareFolder(folder);
  writeCase(report, folder);
  writeMethods(report, folder);
  writeFlights(report, folder);
  if (!report.effects) return;
  std::ofstream file = openCsv(folder, "effects.csv");
  writeCsv(*report.effects, file);
  closeCsv(file, folder);
}

}  // namespace rigid_body_sim::report

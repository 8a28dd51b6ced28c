#include "tools/accuracy_report/digest.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "rigid_body_sim/rotation.hpp"

namespace rigid_body_sim::report {
namespace {

/// What engines commonly do, in momenta and in velocities.
constexpr const char* kYardsticks[] = {"semi_implicit", "semi_implicit_velocity"};

std::string number(double value, int digits = 3) {
  std::ostringstream text;
  text.precision(digits);
  text << value;
  return text.str();
}

/// 12 ns, 3.4 us, 1.2 ms, 5 s.
std::string duration(double ns) {
  if (ns < 1e3) return number(ns) + " ns";
  if (ns < 1e6) return number(ns * 1e-3) + " us";
  if (ns < 1e9) return number(ns * 1e-6) + " ms";
  return number(ns * 1e-9) + " s";
}

std::string unit(const Report& report) { return report.rotates ? " rad" : " m"; }

std::string substeps(int count) {
  return count == 1 ? "1 substep" : std::to_string(count) + " substeps";
}

/// The rung's rows that were flown, from the crudest.
std::vector<const Row*> flownRows(const Report& report, const std::string& rung) {
  std::vector<const Row*> rows;
  for (const Row& row : report.rows)
    if (row.method.integrator == rung && row.outcome == Outcome::kFlown) rows.push_back(&row);
  return rows;
}

template <class Error>  // of a row
const Row* cheapestOf(const std::vector<const Row*>& rows, const Error& error, double tolerance) {
  const Row* cheapest = nullptr;
  for (const Row* row : rows)
    if (error(*row) <= tolerance &&
        (!cheapest || row->cost.median_ns * kSameCost < cheapest->cost.median_ns))
      cheapest = row;
  return cheapest;
}

const Row* cheapestWithin(const std::vector<const Row*>& rows, const Report& report,
                          double tolerance) {
  return cheapestOf(
      rows, [&](const Row& row) { return errorOf(report, row); }, tolerance);
}

std::vector<const Row*> flownRows(const Report& report) {
  std::vector<const Row*> rows;
  for (const Row& row : report.rows)
    if (row.outcome == Outcome::kFlown) rows.push_back(&row);
  return rows;
}

double positionError(const Row& row) { return row.flight.worst.pose.position_m; }

/// What keeps the positions, if they matter besides the attitudes.
std::string onPositions(const Report& report) {
  std::string text = "Positions", goals;
  const Row* before = nullptr;
  const auto end = [&] {  // of the goals that one row is best for
    if (goals.empty()) return;
    text += (text.back() == 's' ? ": " : "; ") + goals + " m: " +
            (before ? nameOf(*before) + ", " + duration(before->cost.median_ns) + " a body and tick"
                    : "nothing that was tried gets there");
    goals.clear();
  };
  for (const double tolerance : {1e-2, 1e-4, 1e-6, 1e-8}) {
    if (tolerance <= report.truth.doubt.position_m) continue;
    const Row* row = cheapestOf(flownRows(report), positionError, tolerance);
    if (row != before) end();
    goals += (goals.empty() ? "" : ", ") + number(tolerance);
    before = row;
  }
  end();
  return text + ".";
}

struct Yardstick {
  std::string rung;
  double rounding;  ///< of its finest flight
};

std::vector<Yardstick> yardsticksOf(const Report& report) {
  std::vector<Yardstick> found;
  for (const char* name : kYardsticks) {
    const std::vector<const Row*> rows = flownRows(report, name);
    if (!rows.empty()) found.push_back({name, roundingOf(report, rows.back()->method)});
  }
  return found;
}

std::string onRounding(const Extrapolation& needed, double tolerance) {
  constexpr double kHalfTurn = 3.1;  // [rad] no error is larger
  if (!(needed.rounding_sum > tolerance)) return {};
  const std::string from_to = number(std::min(needed.rounding, kHalfTurn), 1) + " to " +
                              number(std::min(needed.rounding_sum, kHalfTurn), 1) + " rad";
  if (needed.rounding > tolerance)
    return " (rounding alone would make " + from_to + " in so many steps: none gets there)";
  return " (rounding alone would make " + from_to + " in so many steps: perhaps none gets there)";
}

/// What the yardstick would take instead of `chosen`.
std::string comparison(const Report& report, const Row& chosen, const Yardstick& yardstick,
                       double tolerance) {
  const std::string& rung = yardstick.rung;
  if (rung == chosen.method.integrator) return {};
  const auto times = [&](double ns) {
    return ", " + number(ns / chosen.cost.median_ns, 2) + " times the time";
  };
  const std::vector<const Row*> rows = flownRows(report, rung);
  if (const Row* row = cheapestWithin(rows, report, tolerance))
    return "; " + rung + " takes " + substeps(row->method.substeps) + times(row->cost.median_ns);
  const auto needed = extrapolate(report, rung, tolerance, yardstick.rounding);
  if (!needed)
    return "; " + rung + " does not get there with " + substeps(rows.back()->method.substeps) +
           times(rows.back()->cost.median_ns);
  return "; " + rung + " would take " + number(needed->substeps, 2) + " substeps" +
         times(needed->cost_ns) + onRounding(*needed, tolerance);
}

std::string sentence(const Report& report, const std::vector<Yardstick>& yardsticks,
                     double tolerance) {
  const std::string goal = number(tolerance) + unit(report) + ": ";
  const Row* chosen = cheapestWithin(report, tolerance);
  if (!chosen) return goal + "nothing that was tried gets there.";
  std::string text = goal + nameOf(*chosen) + ", " + duration(chosen->cost.median_ns) +
                     " a body and tick, " + number(realTimeFactor(report, *chosen), 2) +
                     " times real time";
  for (const Yardstick& yardstick : yardsticks)
    text += comparison(report, *chosen, yardstick, tolerance);
  return text + ".";
}

/// What the above says of a yardstick rests on.
std::string basis(const Report& report, const Yardstick& yardstick) {
  const Row& finest = *flownRows(report, yardstick.rung).back();
  const std::string finest_is =
      number(errorOf(report, finest), 2) + unit(report) + " at " + substeps(finest.method.substeps);
  const auto needed = extrapolate(report, yardstick.rung, 1, yardstick.rounding);
  if (!needed)
    return "Of " + yardstick.rung + " nothing is extrapolated: its error, " + finest_is +
           ", does not yet fall as its order says.";
  std::string text = "What " + yardstick.rung + " would take is extrapolated from " + finest_is +
                     ", where its error falls as n^-" + number(needed->slope, 2);
  if (std::isnan(yardstick.rounding)) return text + "; rounding is not counted.";
  return text + " and rounding makes " + number(yardstick.rounding, 1) +
         " rad of it (the difference to the same flight from another attitude); that grows as the "
         "root of the number of steps, if not in proportion to it.";
}

}  // namespace

const Row* cheapestWithin(const Report& report, double tolerance) {
  return cheapestWithin(flownRows(report), report, tolerance);
}

double roundingOf(const Report& report, const Method& method) {
  if (!report.scene.effects.empty() || !report.rotates)
    return std::numeric_limits<double>::quiet_NaN();
  Scene turned = report.scene;
  const Quaterniond q_VW = Quaterniond(0.43, -0.51, 0.62, 0.41).normalized();  // no special axis
  for (SceneBody& body : turned.bodies) {
    body.X_WL = Eigen::Isometry3d(q_VW) * body.X_WL;
    body.v_WBcm = q_VW * body.v_WBcm;
  }
  const Tick every = report.truth.trajectory.every;
  const Trajectory one = fly(report.scene, method, report.ticks, every);
  const Trajectory other = fly(turned, method, report.ticks, every);
  double largest = 0;
  for (std::size_t k = 0; k < one.samples.size(); ++k) {
    for (Eigen::Index i = 0; i < one.samples[k].count(); ++i) {
      const Quaterniond q_WB = one.samples[k].state(i).q_WB;
      const Quaterniond q_VB = other.samples[k].state(i).q_WB;
      largest = std::max(largest, rotationLog((q_VW * q_WB).conjugate() * q_VB).norm());
    }
  }
  return largest / std::sqrt(2);
}

std::optional<Extrapolation> extrapolate(const Report& report, const std::string& rung,
                                         double tolerance, double rounding) {
  const std::vector<const Row*> rows = flownRows(report, rung);
  if (rows.size() < 2 || rows.back()->adapts) return std::nullopt;
  const Row& fine = *rows.back();
  const Row& coarse = *rows[rows.size() - 2];
  const double order = integratorNamed(rung).order;
  const double error = errorOf(report, fine);
  const double slope = std::log(errorOf(report, coarse) / error) /
                       std::log(static_cast<double>(fine.method.substeps) / coarse.method.substeps);
  if (!(std::abs(slope - order) < 0.3)) return std::nullopt;
  Extrapolation needed;
  needed.slope = slope;
  needed.substeps = fine.method.substeps * std::pow(error / tolerance, 1 / order);
  const double more = needed.substeps / fine.method.substeps;
  needed.cost_ns = fine.cost.median_ns * more;
  needed.rounding = rounding * std::sqrt(more);
  needed.rounding_sum = rounding * more;
  return needed;
}

bool positionsMatter(const Report& report) {
  if (!report.rotates) return false;
  if (report.scene.accuracy && std::isfinite(report.scene.accuracy->position_m)) return true;
  double largest = 0;  // [m]
  for (const Bodies& bodies : report.truth.trajectory.samples)
    largest = std::max(largest, bodies.p_WBcm.cwiseAbs().maxCoeff());
  for (const Row* row : flownRows(report)) {
    // Each substep rounds three components by half an ulp; the true flight has its own doubt.
    const double roundings = std::sqrt(3) * static_cast<double>(report.ticks) *
                             row->method.substeps * std::numeric_limits<double>::epsilon();
    if (positionError(*row) > 2 * report.truth.doubt.position_m + roundings * largest) return true;
  }
  return false;
}

std::vector<std::string> digest(const Report& report) {
  const std::vector<Yardstick> yardsticks = yardsticksOf(report);
  std::vector<std::string> sentences;
  for (const double tolerance : {1e-2, 1e-4, 1e-6, 1e-8, 1e-10})
    if (tolerance > doubtOf(report)) sentences.push_back(sentence(report, yardsticks, tolerance));
  if (positionsMatter(report)) sentences.push_back(onPositions(report));
  for (const Yardstick& yardstick : yardsticks)
    if (errorOf(report, *flownRows(report, yardstick.rung).back()) > doubtOf(report))
      sentences.push_back(basis(report, yardstick));
  return sentences;
}

}  // namespace rigid_body_sim::report

#include "tools/accuracy_report/report.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <sstream>
#include <stdexcept>

#include "core/suitability.hpp"
#include "reference/cases.hpp"
#include "tools/accuracy_report/truth.hpp"

namespace rigid_body_sim::report {
namespace {

constexpr double kLost = 1;        // [rad] from here on an error says nothing of the attitude
constexpr double kSettled = 1e-3;  // [rad or m] below it an error that no longer falls is rounding
constexpr Tick kSamples = 600;     // about, of a flight: a point every pixel of a plot

std::vector<const IntegratorRow*> rungsOf(const Plan& plan) {
  std::vector<const IntegratorRow*> rungs;
  for (const std::string& name : plan.rungs) rungs.push_back(&integratorNamed(name));
  if (rungs.empty())
    for (const IntegratorRow& row : integrators()) rungs.push_back(&row);
  return rungs;
}

/// What a rung is flown with, from the crudest: substeps, or tolerances if it adapts.
std::vector<Row> rowsOf(const IntegratorRow& rung, const Plan& plan) {
  std::vector<Row> rows;
  const auto add = [&](const Method& method) {
    rows.emplace_back();
    rows.back().method = method;
    rows.back().adapts = rung.order == 0;
  };
  if (rung.order == 0)
    for (const double tolerance : plan.tolerances) add({rung.name, 1, tolerance});
  else
    for (const int substeps : plan.substeps) add({rung.name, substeps});
  return rows;
}

/// With any step.
bool feedsDrag(const IntegratorRow& rung, const Scene& scene) {
  return rung.order != 0 &&
         std::any_of(scene.effects.begin(), scene.effects.end(),
                     [&](const auto& effect) { return orderUnder(rung, *effect) == 0; });
}

/// Why the row's method would be misused on this scene; empty if it would not.
std::string refusal(const Row& row, const Scene& scene, double angular_speed) {
  const IntegratorRow& rung = integratorNamed(row.method.integrator);
  const double turn = angular_speed * scene.step_s() / row.method.substeps;
  std::ostringstream why;
  if (turn > rung.max_turn) {
    why.precision(2);
    why << "|w| h is " << turn << " rad, at most " << rung.max_turn;
  }
  if (feedsDrag(rung, scene)) why << "its steps back in time would turn drag into growth";
  return why.str();
}

void setOutcome(Row& row, Outcome outcome, const std::string& why) {
  row.outcome = outcome;
  row.why = why;
}

std::string rounded(double number) {
  std::ostringstream text;
  text.precision(3);
  text << number;
  return text.str();
}

void flyRow(Row& row, const Report& report, double angular_speed) {
  const std::string why = refusal(row, report.scene, angular_speed);
  if (!why.empty()) return setOutcome(row, Outcome::kRefused, "refused: " + why);
  try {
    row.flight = errorsOf(report.scene, row.method, report.truth.trajectory, report.shown);
    row.evaluations = evaluationsATick(report.scene, row.method);
  } catch (const std::invalid_argument& error) {
    return setOutcome(row, Outcome::kRefused, std::string("refused: ") + error.what());
  }
  if (std::isfinite(row.flight.infinite_after_s))
    setOutcome(row, Outcome::kInfinite,
               "infinite after " + rounded(row.flight.infinite_after_s) + " s");
}

/// Of the rows of a rung that were flown.
void countInstructions(std::vector<Row>& rows, const Plan& plan, const Report& report) {
  std::vector<Row*> flown;
  std::vector<Method> methods;
  for (Row& row : rows) {
    if (row.flight.samples.empty()) continue;
    flown.push_back(&row);
    methods.push_back(row.method);
  }
  if (flown.empty()) return;
  const std::vector<double> counts =
      instructionsATick(report.scene.bodies.size(), methods, plan.count_instructions_with);
  for (std::size_t k = 0; k < flown.size(); ++k) flown[k]->instructions = counts[k];
}

/// How much longer this row takes than the one before it.
double moreWork(const Row& row, const Row& before) {
  if (row.adapts) return 3;  // for two more digits; measured with order 8: 1.8
  return static_cast<double>(row.method.substeps) / before.method.substeps;
}

/// Whether smaller steps make it no better any more: the last two are worse than one before.
bool isRounding(const std::vector<Row>& rows, const Report& report) {
  std::vector<double> errors;
  for (const Row& row : rows)
    if (row.outcome == Outcome::kFlown) errors.push_back(errorOf(report, row));
  if (errors.size() < 3) return false;
  const double best = *std::min_element(errors.begin(), errors.end() - 2);
  return best < kSettled && *std::min_element(errors.end() - 2, errors.end()) >= best;
}

/// Flies a rung with ever smaller steps, as long as that makes it better, the true flight can tell
/// the results apart, and a flight does not take too long.
std::vector<Row> flyRung(const IntegratorRow& rung, const Plan& plan, const Report& report,
                         double angular_speed, const std::function<void(const Row&)>& tell) {
  std::vector<Row> flown;
  for (Row& row : rowsOf(rung, plan)) {
    tell(row);
    const Row* before = flown.empty() || flown.back().flight.wall_s == 0 ? nullptr : &flown.back();
    const double expected_s = before ? before->flight.wall_s * moreWork(row, *before) : 0;
    if (expected_s > plan.longest_s) {
      setOutcome(row, Outcome::kSkipped, "skipped: would take " + rounded(expected_s) + " s");
      flown.push_back(row);
      break;
    }
    flyRow(row, report, angular_speed);
    flown.push_back(row);
    if (feedsDrag(rung, report.scene)) break;  // in smaller steps too
    if (row.outcome != Outcome::kFlown) continue;
    if (errorOf(report, row) <= doubtOf(report) || isRounding(flown, report)) break;
  }
  return flown;
}

/// Ticks over which a row is timed: those it can fly, and not more than some milliseconds.
Tick timedTicks(const Row& row, const Report& report) {
  const double tick_s = row.flight.wall_s / static_cast<double>(report.ticks);
  const auto enough = static_cast<Tick>(std::ceil(4e-3 / std::max(tick_s, 1e-9)));
  const double flown_s = std::min(row.flight.infinite_after_s, report.over_s);
  const auto flown = static_cast<Tick>(flown_s / report.scene.step_s());
  return std::max<Tick>(1, std::min(enough, flown));
}

void timeRows(Report& report, const Plan& plan, const Progress& progress) {
  std::vector<Row*> rows;
  std::vector<Timed> timed;
  for (Row& row : report.rows) {
    if (row.flight.samples.empty()) continue;
    rows.push_back(&row);
    timed.push_back({row.method, timedTicks(row, report)});
  }
  const double runs = static_cast<double>(timed.size()) * plan.repeats;
  const std::vector<Cost> costs = costsOf(report.scene, timed, plan.repeats, [&](std::size_t done) {
    progress("timing", 0.8 + 0.2 * static_cast<double>(done) / runs);
  });
  for (std::size_t k = 0; k < rows.size(); ++k) rows[k]->cost = costs[k];
}

/// Flies the rows that are drawn again if the body that is to be shown is another.
void showWorst(Report& report, const Progress& progress) {
  const Eigen::Index worst = worstBody(report);
  if (worst == report.shown) return;
  report.shown = worst;
  std::string last;
  for (Row& row : report.rows) {
    if (row.flight.samples.empty() || row.method.integrator == last) continue;
    last = row.method.integrator;
    progress(nameOf(row), 0.8);
    row.flight = errorsOf(report.scene, row.method, report.truth.trajectory, worst);
  }
}

Report begin(const Plan& plan) {
  Report report;
  report.name = plan.name;
  report.scene = plan.scene;
  report.says_own_method = plan.says_own_method;
  const double step_s = plan.scene.step_s();
  const auto wanted = static_cast<Tick>(std::llround(plan.over_s / step_s));
  if (wanted < 1)
    throw std::invalid_argument("over " + rounded(plan.over_s) + " s: at least a tick, which is " +
                                rounded(step_s) + " s (step_s) in this scene");
  const Tick every = std::max<Tick>(1, wanted / kSamples);
  report.ticks = (wanted + every - 1) / every * every;
  report.over_s = static_cast<double>(report.ticks) * step_s;
  report.truth = bestKnown(plan.scene, report.ticks, every);
  if (!std::isfinite(doubtOf(report)))
    throw std::invalid_argument("nothing is known of this flight: the reference is infinite");
  report.shown = firstToRotate(plan.scene);
  report.rotates = std::any_of(plan.scene.bodies.begin(), plan.scene.bodies.end(),
                               [](const SceneBody& body) { return !body.is_point_mass; });
  return report;
}

}  // namespace

Report make(const Plan& plan, const Progress& progress) {
  const std::vector<const IntegratorRow*> rungs = rungsOf(plan);
  progress("the true flight", 0);
  Report report = begin(plan);
  const double angular_speed = largestAngularSpeed(report.truth.trajectory);
  for (std::size_t k = 0; k < rungs.size(); ++k) {
    const double part = 0.8 * static_cast<double>(k) / static_cast<double>(rungs.size());
    const auto tell = [&](const Row& row) { progress(nameOf(row), part); };
    std::vector<Row> rows = flyRung(*rungs[k], plan, report, angular_speed, tell);
    if (plan.count_instructions_with) {
      progress("counting instructions of " + rungs[k]->name, part);
      countInstructions(rows, plan, report);
    }
    std::move(rows.begin(), rows.end(), std::back_inserter(report.rows));
  }
  showWorst(report, progress);
  timeRows(report, plan, progress);
  markFront(report);
  if (!report.scene.effects.empty()) {
    progress("timing the effects", 0.99);
    report.effects = effectCosts(
        report.scene, report.scene.accuracy ? Method() : methodOf(report.scene), plan.repeats,
        plan.count_effects_with,
        [&](const std::string& name) { progress("counting instructions of " + name, 0.99); });
  }
  return report;
}

double errorOf(const Report& report, const Row& row) {
  const Deviation& pose = row.flight.worst.pose;
  return report.rotates ? pose.attitude_rad : pose.position_m;
}

double doubtOf(const Report& report) {
  return report.rotates ? report.truth.doubt.attitude_rad : report.truth.doubt.position_m;
}

bool isBeaten(const Report& report, const Row& row, const Row& by) {
  const double doubt = doubtOf(report);
  const double error = std::max(errorOf(report, row), doubt);
  const double other = std::max(errorOf(report, by), doubt);
  if (other > error + doubt || by.cost.median_ns > kSameCost * row.cost.median_ns) return false;
  return other < error - doubt || by.cost.median_ns * kSameCost < row.cost.median_ns || &by < &row;
}

Eigen::Index worstBody(const Report& report) {
  std::vector<const Row*> rows;  // of each rung the crudest that was flown
  for (const Row& row : report.rows)
    if (row.outcome == Outcome::kFlown &&
        (rows.empty() || rows.back()->method.integrator != row.method.integrator))
      rows.push_back(&row);
  const auto isTelling = [&](const Row* row) {
    const double error = errorOf(report, *row);
    return error > doubtOf(report) && !(report.rotates && error > kLost);
  };
  if (std::any_of(rows.begin(), rows.end(), isTelling))
    rows.erase(std::stable_partition(rows.begin(), rows.end(), isTelling), rows.end());
  Eigen::Index worst = firstToRotate(report.scene);
  if (rows.empty()) return worst;
  const auto middle = rows.begin() + static_cast<std::ptrdiff_t>(rows.size() / 2);
  std::nth_element(rows.begin(), middle, rows.end(), [&](const Row* a, const Row* b) {
    return errorOf(report, *a) < errorOf(report, *b);
  });
  const std::vector<Deviation>& errors = (*middle)->flight.worst_of;
  const auto part = report.rotates ? &Deviation::attitude_rad : &Deviation::position_m;
  for (std::size_t i = 0; i < errors.size(); ++i)
    if (errors[i].*part > errors[worst].*part) worst = static_cast<Eigen::Index>(i);
  return worst;
}

void markFront(Report& report) {
  const auto counts = [&](const Row& row) {
    return row.outcome == Outcome::kFlown && !(report.rotates && errorOf(report, row) > kLost);
  };
  std::vector<Row*> front;  // grown, as with errors that may be equal three can beat each other
  std::vector<Row*> rows;
  for (Row& row : report.rows)
    if (row.is_on_front = false; counts(row)) rows.push_back(&row);
  std::stable_sort(rows.begin(), rows.end(), [](const Row* a, const Row* b) {
    return a->cost.median_ns < b->cost.median_ns;
  });
  for (Row* row : rows) {
    const auto beats = [&](const Row* by) { return isBeaten(report, *row, *by); };
    if (std::any_of(front.begin(), front.end(), beats)) continue;
    const auto isOut = [&](const Row* old) { return isBeaten(report, *old, *row); };
    front.erase(std::remove_if(front.begin(), front.end(), isOut), front.end());
    front.push_back(row);
  }
  for (Row* row : front) row->is_on_front = true;
}

std::string nameOf(const Row& row) {
  if (!row.adapts) return toText(row.method);
  return row.method.integrator + " " + rounded(row.method.tolerance);
}

double realTimeFactor(const Report& report, const Row& row) {
  return report.scene.step_s() * 1e9 /
         (row.cost.median_ns * static_cast<double>(report.scene.bodies.size()));
}

Scene sceneOfCase(const std::string& name) {
  std::string known;
  for (const reference::Case& one : reference::cases()) {
    known += (known.empty() ? "" : ", ") + one.name;
    if (one.name != name) continue;
    SceneBody body;
    body.name = one.name;
    body.mass_properties.mass = one.mass;
    body.mass_properties.I_BBcm_F = one.I_BBcm_B.asDiagonal();
    body.w_WB_L = one.w_WB_B;
    Scene scene;
    scene.bodies = {body};
    return scene;
  }
  throw std::invalid_argument("'" + name + "' is not a case; there are " + known);
}

}  // namespace rigid_body_sim::report

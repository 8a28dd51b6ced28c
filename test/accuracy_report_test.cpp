// The parts of accuracy_report: errors against an independent computation, refusals, costs, and
// what is written.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include "generic.hpp"
#include "reference/flight.hpp"
#include "rigid_body_sim/conserved.hpp"
#include "tools/accuracy_report/digest.hpp"
#include "tools/accuracy_report/output.hpp"
#include "tools/accuracy_report/report.hpp"
#include "tools/accuracy_report/truth.hpp"

namespace rigid_body_sim::report {
namespace {

void silently(const std::string&, double) {}

Plan planOf(const std::string& name, double over_s) {
  Plan plan;
  plan.name = name;
  plan.scene = sceneOfCase(name);
  plan.over_s = over_s;
  plan.substeps = {1, 4};
  plan.tolerances = {1e-6};
  plan.repeats = 1;
  return plan;
}

const Row& rowOf(const Report& report, const std::string& rung, int substeps = 1) {
  for (const Row& row : report.rows)
    if (row.method.integrator == rung && row.method.substeps == substeps) return row;
  throw std::runtime_error("no row of " + rung);
}

// ---- Errors

TEST(ReportedErrors, AgreeWithAnIndependentComputation) {
  const Report report = make(planOf("tumbling_stone", 5), silently);
  const reference::Case& one = reference::caseNamed("tumbling_stone");
  Simulator simulator(withMethod(report.scene, {"split2"}));
  const BodyState truth =
      reference::fly(simulator.state(0), one.mass, one.I_BBcm_B, reference::nothing, report.over_s)
          .end;
  while (simulator.tick() < report.ticks) simulator.step();
  const BodyState end = simulator.state(0);

  const Errors& reported = rowOf(report, "split2").flight.end;
  const double angle = angleBetween(end.q_WB, truth.q_WB);
  EXPECT_GT(angle, 1e-6);
  EXPECT_NEAR(reported.pose.attitude_rad, angle, 1e-12);
  const double energy = kineticEnergy(truth, one.mass, one.I_BBcm_B);
  EXPECT_NEAR(reported.energy, std::abs(kineticEnergy(end, one.mass, one.I_BBcm_B) / energy - 1),
              1e-14);
  EXPECT_NEAR(reported.momentum, end.L_WBcm_W.norm() / truth.L_WBcm_W.norm() - 1, 1e-14);
}

TEST(ReportedErrors, OfPositionAreThoseOfTheParabola) {
  // Semi-implicit Euler falls g t h / 2 too far.
  Plan plan;
  plan.name = "fall";
  plan.scene.bodies = {genericSceneBody("ball")};
  plan.scene.bodies[0].is_point_mass = true;
  plan.scene.bodies[0].mass_properties.p_FBcm.setZero();
  plan.scene.effects = {uniformGravity({0, 0, -10}, {0})};
  plan.over_s = 2;
  plan.substeps = {1};
  plan.rungs = {"semi_implicit_velocity", "exact"};
  plan.repeats = 1;
  const Report report = make(plan, silently);
  EXPECT_FALSE(report.rotates);
  EXPECT_NEAR(errorOf(report, rowOf(report, "semi_implicit_velocity")), 10 * 2 * 0.02 / 2, 1e-12);
  EXPECT_LE(errorOf(report, rowOf(report, "exact")), 1e-13);
}

TEST(ReportedErrors, TheBodyThatIsShownIsTheOneFarthestOff) {
  Plan plan = planOf("tumbling_stone", 5);
  SceneBody fast = plan.scene.bodies[0];
  fast.name = "fast";
  fast.w_WB_L *= 3;
  plan.scene.bodies.push_back(fast);
  const Report report = make(plan, silently);
  EXPECT_EQ(report.shown, 1);
  const FlightErrors& flight = rowOf(report, "split2").flight;
  ASSERT_EQ(flight.worst_of.size(), 2u);
  EXPECT_LT(flight.worst_of[0].attitude_rad, flight.worst_of[1].attitude_rad);
  EXPECT_EQ(flight.worst_of[1].attitude_rad, flight.worst.pose.attitude_rad);
  for (std::size_t k = 0; k < flight.samples.size(); ++k)
    EXPECT_EQ(
        flight.samples[k].shown.attitude_rad,
        angleBetween(flight.samples[k].q_WB, report.truth.trajectory.samples[k].state(1).q_WB));
}

TEST(ReportedErrors, WorstIsAtLeastTheEndAndAllSamples) {
  const Report report = make(planOf("dzhanibekov", 10), silently);
  for (const Row& row : report.rows) {
    if (row.outcome != Outcome::kFlown) continue;
    EXPECT_EQ(row.flight.samples.size(), report.truth.trajectory.samples.size());
    EXPECT_EQ(row.flight.samples.front().errors.pose.attitude_rad, 0);
    double largest = 0;
    for (const ErrorSample& sample : row.flight.samples)
      largest = std::max(largest, sample.errors.pose.attitude_rad);
    EXPECT_EQ(largest, row.flight.worst.pose.attitude_rad) << nameOf(row);
    EXPECT_EQ(row.flight.samples.back().errors.pose.attitude_rad, row.flight.end.pose.attitude_rad);
  }
}

TEST(ReportedErrors, AFlightThatGoesToInfinityIsSaidToAndWhen) {
  Plan plan = planOf("dzhanibekov", 60);
  plan.rungs = {"semi_implicit_velocity"};
  plan.substeps = {1};
  const Row row = make(plan, silently).rows.at(0);
  EXPECT_EQ(row.outcome, Outcome::kInfinite);
  EXPECT_NEAR(row.flight.infinite_after_s, 53.8, 0.7);  // as in accuracy_figures_test
  EXPECT_TRUE(contains(row.why, {"infinite after 5", " s"}));
  EXPECT_GT(row.cost.median_ns, 0);
}

TEST(BestKnown, ADoubtCoversWhatTheThirdWayFinds) {
  // A thin rod's own spin drowns in R^T L, for exact in half steps, too.
  for (const char* name : {"thin_rod", "dzhanibekov", "sphere"}) {
    const Scene scene = sceneOfCase(name);
    const TrueTrajectory plain = flyTruly(scene, 500, 10);
    const TrueTrajectory known = bestKnown(scene, 500, 10);
    EXPECT_GE(known.doubt.attitude_rad, plain.doubt.attitude_rad) << name;
    EXPECT_LT(known.doubt.attitude_rad, 1e-5) << name;
    EXPECT_TRUE(contains(known.how, {plain.how, "extended precision"}));
  }
}

TEST(BestKnown, ChecksFlightsUnderEffectsToo) {
  // Gravity: the position is known, and the third way agrees.
  Scene scene = sceneOfCase("tumbling_stone");
  scene.effects = {uniformGravity({0, 3, -10}, {0})};
  const TrueTrajectory known = bestKnown(scene, 100, 10);
  EXPECT_TRUE(contains(known.how, {"extended precision"}));
  EXPECT_LT(known.doubt.attitude_rad, 1e-12);
  EXPECT_LT(known.doubt.position_m, 1e-12);
}

TEST(BestKnown, KeepsToItselfWhatItCannotCheck) {
  class Pair : public Effect {  // cannot be divided
   public:
    std::string name() const override { return "pair"; }
    std::size_t bodyCount() const override { return 1; }
    void addWrenches(const Instant&, Wrenches&) const override {}
  };
  Scene scene = sceneOfCase("sphere");
  scene.bodies.push_back(genericSceneBody("other"));
  scene.effects = {std::make_shared<Pair>()};
  EXPECT_EQ(bestKnown(scene, 50, 10).how, flyTruly(scene, 50, 10).how);
}

// ---- Refusals

TEST(Refusals, ATurnThatIsTooLargeForARungIsRefusedWithBothNumbers) {
  int refused = 0;
  for (const IntegratorRow& rung : integrators()) {
    if (!std::isfinite(rung.max_turn)) continue;
    if (rung.order == 0) continue;  // its rows are tolerances, all of one substep
    ++refused;
    Plan plan = planOf("sphere", 1);
    plan.scene.bodies[0].w_WB_L = Vector3d(0, 0, 1.5 * rung.max_turn / plan.scene.step_s());
    plan.rungs = {rung.name};
    plan.substeps = {1, 2};
    const Report report = make(plan, silently);
    EXPECT_EQ(rowOf(report, rung.name).outcome, Outcome::kRefused) << rung.name;
    EXPECT_TRUE(contains(rowOf(report, rung.name).why, {"refused: |w| h is ", "at most"}));
    EXPECT_EQ(rowOf(report, rung.name, 2).outcome, Outcome::kFlown) << rung.name;
  }
  EXPECT_GE(refused, 1);
}

TEST(Refusals, ASpinThatAdaptiveDoesNotFollowIsRefusedAtEveryToleranceAndNoPartOfTheTruth) {
  Plan plan = planOf("sphere", 1);
  plan.scene.bodies[0].w_WB_L = Vector3d(0, 0, 250 / plan.scene.step_s());
  plan.scene.effects = {uniformGravity({0, 3, -10}, {0})};
  plan.rungs = {"adaptive"};
  const Report report = make(plan, silently);
  EXPECT_FALSE(report.rows.empty());
  for (const Row& row : report.rows) EXPECT_EQ(row.outcome, Outcome::kRefused);
  EXPECT_TRUE(contains(report.truth.how, {"exact, against itself"}));
}

TEST(Refusals, StepsBackInTimeAreRefusedUnderDrag) {
  class Drag : public Effect {
   public:
    std::string name() const override { return "drag"; }
    std::size_t bodyCount() const override { return 1; }
    bool dependsOnVelocity() const override { return true; }
    void addWrenches(const Instant& now, Wrenches& wrenches) const override {
      wrenches.t_Bcm_W -= 0.01 * now.bodies().L_WBcm_W;
    }
  };
  Plan plan = planOf("tumbling_stone", 1);
  plan.scene.effects = {std::make_shared<Drag>()};
  const Report report = make(plan, silently);
  for (const IntegratorRow& rung : integrators()) {
    // Once: smaller steps would go back too.
    const auto is_rung = [&](const Row& row) { return row.method.integrator == rung.name; };
    const bool has_steps_back = rung.order != 0 && rung.order_under_drag == 0;
    EXPECT_EQ(rowOf(report, rung.name).outcome,
              has_steps_back ? Outcome::kRefused : Outcome::kFlown)
        << rung.name;
    if (has_steps_back) {
      EXPECT_EQ(std::count_if(report.rows.begin(), report.rows.end(), is_rung), 1) << rung.name;
    }
  }
}

TEST(Refusals, StepsBackInTimeAreFlownUnderATurningWorld) {
  Plan plan = planOf("tumbling_stone", 1);
  plan.scene.effects = sceneFrom(
                           "{effects: {rotating_frame: {angular_velocity: [0, 0, 0.1]}}, bodies: "
                           "{a: {mass: 1, inertia: [1, 2, 2.5]}}}")
                           .effects;
  plan.rungs = {"exact4"};
  EXPECT_EQ(rowOf(make(plan, silently), "exact4").outcome, Outcome::kFlown);
}

TEST(Refusals, WhatWouldTakeTooLongIsSkippedAndSaysSo) {
  Plan plan = planOf("dzhanibekov", 20);
  plan.rungs = {"semi_implicit_velocity"};
  plan.substeps = {4, 4096};
  plan.longest_s = 1e-3;
  const Report report = make(plan, silently);
  EXPECT_EQ(report.rows.at(1).outcome, Outcome::kSkipped);
  EXPECT_TRUE(contains(report.rows.at(1).why, {"skipped: would take "}));
}

TEST(Refusals, AfterARefusalTheSmallerStepsAreFlown) {
  Plan plan = planOf("dzhanibekov", 2);
  plan.scene.bodies[0].w_WB_L = Vector3d(5, 60, 1);  // 1.2 rad a tick
  plan.rungs = {"rk4"};
  plan.substeps = {1, 2, 4, 8, 16};
  const Report report = make(plan, silently);
  ASSERT_EQ(report.rows.size(), 5u);
  EXPECT_EQ(report.rows[0].outcome, Outcome::kRefused);
  for (int k = 1; k < 5; ++k) EXPECT_EQ(report.rows[k].outcome, Outcome::kFlown) << k;
}

TEST(Refusals, AnUnknownCaseNamesThoseThereAre) {
  EXPECT_TRUE(contains(refusal([] { sceneOfCase("boxes"); }), {"boxes", "dzhanibekov", "sphere"}));
}

// ---- Costs

TEST(ReportedCosts, EvaluationsAreThoseThatTheRungStates) {
  const Scene scene = sceneOfCase("tumbling_stone");
  for (const IntegratorRow& rung : integrators()) {
    const double counted = evaluationsATick(scene, {rung.name, 3});
    if (rung.evaluations != 0) {
      EXPECT_LE(counted, 3 * rung.evaluations + 1e-9) << rung.name;
    }
    EXPECT_GE(counted, 3) << rung.name;
  }
}

// ---- The README's table

TEST(ReadmeTable, HoldsForTheTumblingBody) {
  struct Figure {
    std::string rung;
    int substeps;
    double error;
  };
  Plan plan = planOf("dzhanibekov", 60);
  plan.longest_s = 600;  // nothing is skipped, however slow the build is
  plan.substeps = {1, 2, 16, 64, 4096};
  plan.rungs = {"semi_implicit", "semi_implicit_velocity", "split2", "rk4", "rk8", "exact"};
  const Report report = make(plan, silently);
  EXPECT_LT(doubtOf(report), 1e-11);
  for (const Figure& figure :
       {Figure{"split2", 1, 3.7e-3}, Figure{"split2", 64, 9.0e-7}, Figure{"rk4", 1, 9.2e-6},
        Figure{"rk4", 2, 6.9e-7}, Figure{"semi_implicit_velocity", 4096, 0.037}})
    EXPECT_NEAR(errorOf(report, rowOf(report, figure.rung, figure.substeps)), figure.error,
                0.03 * figure.error)
        << figure.rung;
  EXPECT_LT(errorOf(report, rowOf(report, "rk4", 16)), 1e-8);
  EXPECT_LT(errorOf(report, rowOf(report, "rk8")), 1e-9);
  EXPECT_LT(errorOf(report, rowOf(report, "exact")), 1e-11);

  // Semi-implicit Euler does not get to 1e-6 rad in 1700 times the time of what does.
  const Row& euler = rowOf(report, "semi_implicit", 4096);
  EXPECT_GT(errorOf(report, euler), 3);
  EXPECT_GT(euler.cost.median_ns, 100 * cheapestWithin(report, 1e-6)->cost.median_ns);
}

// ---- Files

std::vector<std::map<std::string, std::string>> csvOf(const std::string& path) {
  std::ifstream file(path);
  const auto cellsOf = [](const std::string& line) {
    std::vector<std::string> cells(1);
    bool is_quoted = false;
    for (const char c : line) {
      if (c == '"') {
        is_quoted = !is_quoted;
      } else if (c == ',' && !is_quoted) {
        cells.emplace_back();
      } else {
        cells.back() += c;
      }
    }
    return cells;
  };
  std::string line;
  std::getline(file, line);
  const std::vector<std::string> keys = cellsOf(line);
  std::vector<std::map<std::string, std::string>> rows;
  while (std::getline(file, line)) {
    const std::vector<std::string> cells = cellsOf(line);
    EXPECT_EQ(cells.size(), keys.size()) << path << ": " << line;
    rows.emplace_back();
    for (std::size_t i = 0; i < std::min(cells.size(), keys.size()); ++i)
      rows.back()[keys[i]] = cells[i];
  }
  return rows;
}

TEST(ReportFiles, HoldEveryRowToTheLastDigit) {
  const Report report = make(planOf("dzhanibekov", 10), silently);
  const std::string folder = testing::TempDir() + "accuracy_report_files";
  writeCsv(report, folder);
  auto rows = csvOf(folder + "/methods.csv");
  ASSERT_EQ(rows.size(), report.rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Row& row = report.rows[i];
    EXPECT_EQ(rows[i]["rung"], row.method.integrator);
    EXPECT_EQ(rows[i]["is_on_front"], row.is_on_front ? "1" : "0");
    if (row.outcome != Outcome::kFlown) continue;
    EXPECT_EQ(std::stod(rows[i]["attitude_max"]), row.flight.worst.pose.attitude_rad);
    EXPECT_EQ(std::stod(rows[i]["position_end"]), row.flight.end.pose.position_m);
    EXPECT_EQ(std::stod(rows[i]["energy_max"]), row.flight.worst.energy);
    EXPECT_EQ(std::stod(rows[i]["momentum_end"]), row.flight.end.momentum);
    EXPECT_EQ(std::stod(rows[i]["cost_median"]), row.cost.median_ns);
    EXPECT_EQ(rows[i]["instructions"], "");
  }
  const auto samples = csvOf(folder + "/flights.csv");
  const std::size_t each = report.truth.trajectory.samples.size();
  EXPECT_EQ(samples.size() % each, 0u);
  EXPECT_EQ(samples.front().at("rung"), "reference");
  std::filesystem::remove_all(folder);
}

TEST(ReportFiles, AFolderThatCannotBeIsRefused) {
  Plan plan = planOf("sphere", 1);
  plan.rungs = {"exact"};
  const Report report = make(plan, silently);
  EXPECT_TRUE(contains(refusal([&] { writeCsv(report, "/dev/null/here"); }),
                       {"/dev/null/here", "cannot be written"}));
}

TEST(ReportTable, SaysWhatEachRowIsAndHowGoodTheReferenceIs) {
  std::ostringstream out;
  print(make(planOf("dzhanibekov", 60), silently), out);
  EXPECT_TRUE(contains(
      out.str(), {"dzhanibekov: one body, a tick of 0.02 s, over 60 s (3000 ticks)", "Reference: ",
                  "In doubt by at most", "attitude [rad]", "infinite after 5",
                  "rad: exact"}));  // or exact4, which coasts at the same price: times are noisy
  for (const IntegratorRow& rung : integrators())
    EXPECT_TRUE(contains(out.str(), {"\n" + rung.name + " "}));
}

}  // namespace
}  // namespace rigid_body_sim::report

// What a step costs: the registry's figures, which accuracy budgets are chosen by, and the promise
// that exact free flight costs little more than Euler's method.
#include <algorithm>
#include <chrono>
#include <map>

#include "core/suitability.hpp"
#include "integrator_laws.hpp"

namespace rigid_body_sim {
namespace {

class Torque : public Effect {
 public:
  std::string name() const override { return "torque"; }
  std::size_t bodyCount() const override { return 1; }
  void addWrenches(const Instant&, Wrenches& wrenches) const override {
    wrenches.t_Bcm_W.rowwise() += Vector3d(1e-3, 2e-3, -1e-3).transpose();
  }
};

/// Gravity's wrenches.
class Force : public Effect {
 public:
  std::string name() const override { return "force"; }
  std::size_t bodyCount() const override { return 1; }
  void addWrenches(const Instant&, Wrenches& wrenches) const override {
    wrenches.f_W.row(0) += Vector3d(1e-3, 2e-3, -1e-3).transpose();
  }
};

constexpr int kSteps = 2000;
constexpr double kFactor = 2.5;

/// Time of a step [ns] of `count` bodies, by method: the least of many rounds in turn, so that
/// neither a slow machine nor other programs count.
std::map<std::string, double> stepTimes(const Effect* effect, bool turns = true,
                                        std::size_t count = 1) {
  std::map<std::string, double> least;
  std::map<std::string, std::unique_ptr<Integrator>> methods;
  std::map<std::string, Bodies> bodies;
  for (const IntegratorRow& row : integrators()) {
    methods[row.name] = row.make({});
    const Bodies one = bodiesOf(reference::caseNamed("tumbling_stone"));
    bodies[row.name] = rowsOf(one, std::vector<Eigen::Index>(count, 0));
    if (!turns) bodies[row.name].L_WBcm_W.setZero();
    least[row.name] = kInf;
  }
  ActiveEffects effects;
  if (effect) effects.add(effect);
  for (int round = 0; round < 60; ++round) {
    for (auto& [name, method] : methods) {
      const auto start = std::chrono::steady_clock::now();
      const int steps = kSteps / static_cast<int>(count);
      for (int i = 0; i < steps; ++i) method->step(bodies[name], effects, i * 0.02, 0.02);
      const std::chrono::duration<double, std::nano> time =
          std::chrono::steady_clock::now() - start;
      least[name] = std::min(least[name], time.count() / steps);
    }
  }
  return least;
}

/// Time of one evaluation [ns] of the torque alone.
double evaluationTime(const Torque& torque) {
  const Bodies bodies = bodiesOf(reference::caseNamed("tumbling_stone"));
  ActiveEffects effects;
  effects.add(&torque);
  double least = kInf;
  for (int round = 0; round < 60; ++round) {
    const auto start = std::chrono::steady_clock::now();
    for (int i = 0; i < kSteps; ++i) effects.evaluate(bodies, i * 0.02);
    const std::chrono::duration<double, std::nano> time = std::chrono::steady_clock::now() - start;
    least = std::min(least, time.count() / kSteps);
  }
  return least;
}

TEST(Cost, IsTheOneStated) {
  const Torque torque;
  const std::map<std::string, double> free = stepTimes(nullptr), forced = stepTimes(&torque);
  const double unit = free.at("semi_implicit");
  const double evaluation = evaluationTime(torque);
  RecordProperty("evaluation", std::to_string(evaluation / unit));
  for (const IntegratorRow& row : integrators()) {
    if (row.evaluations == 0) continue;  // depends on the tolerance
    const double cost = free.at(row.name) / unit;
    const double forced_cost = (forced.at(row.name) - row.evaluations * evaluation) / unit;
    RecordProperty(row.name, std::to_string(cost) + " " + std::to_string(forced_cost));
    // Within a factor: processors differ in what a division or a root costs, and the memory's
    // layout makes a fifth.
    EXPECT_GE(cost, row.cost / kFactor) << row.name;
    EXPECT_LE(cost, row.cost * kFactor) << row.name;
    EXPECT_GE(forced_cost, row.forced_cost / kFactor) << row.name;
    EXPECT_LE(forced_cost, row.forced_cost * kFactor) << row.name;
  }
}

TEST(Cost, OfATorqueFreeBodyUnderAForceIsWhatAPlanReckonsWith) {
  const Force force;
  const double unit = stepTimes(nullptr).at("semi_implicit");
  const auto turning = stepTimes(&force), resting = stepTimes(&force, false);
  for (const IntegratorRow& row : integrators()) {
    if (row.evaluations == 0) continue;
    const double effects = row.evaluations * force.cost();
    const double cost = turning.at(row.name) / unit, at_rest = resting.at(row.name) / unit;
    RecordProperty(row.name, std::to_string(cost) + " " + std::to_string(at_rest));
    const double stated = (row.is_cheap_without_torque ? row.cost : row.forced_cost) + effects;
    EXPECT_GE(cost, stated / kFactor) << row.name;
    EXPECT_LE(cost, stated * kFactor) << row.name;
    if (!row.free_flight_is_exact) continue;
    EXPECT_LE(at_rest, (row.cost + effects) * kFactor) << row.name;
  }
}

TEST(Cost, OfExactFlightOfManyBodiesIsLittleMoreThanOfEulersMethod) {
  const Torque torque;
  constexpr std::size_t kMany = 136;  // a block
  const std::map<std::string, double> free = stepTimes(nullptr, true, kMany),
                                      forced = stepTimes(&torque, true, kMany);
  const double coasting = free.at("exact") / free.at("semi_implicit");
  const double kicked = forced.at("exact") / forced.at("rk4");
  RecordProperty("coasting", std::to_string(coasting));
  RecordProperty("kicked", std::to_string(kicked));
  // Measured: 1.2 to 1.5 with AVX-512 on an EPYC, most while its neighbours are busy.
  EXPECT_LE(coasting, 2);
  EXPECT_LE(kicked, 3);  // measured: 0.80
}

}  // namespace
}  // namespace rigid_body_sim

#include "reference/gallery.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <stdexcept>

#include "reference/gallery_rows.hpp"
#include "rigid_body_sim/conserved.hpp"
#include "rigid_body_sim/rotation.hpp"

namespace rigid_body_sim::reference {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr int kLooks = 32;           // at energy and angular momentum, in free flight
constexpr double kHundredth = 0.01;  // what kDrifts may be off

using Errors = std::map<Measure, double>;

void takeLarger(Errors& errors, Measure measure, double error) {
  double& largest = errors[measure];
  largest = std::isnan(error) ? kInf : std::max(largest, error);
}

/// What was never there has no relative error.
double relative(double difference, double scale) {
  return scale > 0 ? difference / scale : difference > 0 ? kInf : 0;
}

/// What a free body keeps.
void lookAtConstants(const Bodies& now, const std::vector<BodyState>& truth, const Bodies& start,
                     Errors& errors) {
  for (Eigen::Index i = 0; i < now.count(); ++i) {
    const BodyState& expected = truth[static_cast<std::size_t>(i)];
    const double energy = kineticEnergy(expected, now.mass(i), now.moments(i));
    const double at_start = kineticEnergy(start, i);
    takeLarger(errors, Measure::kEnergy,
               relative(std::abs(kineticEnergy(now, i) - energy), std::max(energy, at_start)));
    const Vector3d L = expected.L_WBcm_W;
    const double L_scale = std::max(L.stableNorm(), start.state(i).L_WBcm_W.stableNorm());
    takeLarger(errors, Measure::kAngularMomentum,
               relative((now.state(i).L_WBcm_W - L).stableNorm(), L_scale));
    takeLarger(errors, Measure::kLength, std::abs(now.state(i).q_WB.norm() - 1));
  }
}

void lookAtEnd(const Bodies& now, const std::vector<BodyState>& truth, const Bodies& start,
               Errors& errors) {
  lookAtConstants(now, truth, start, errors);
  for (Eigen::Index i = 0; i < now.count(); ++i) {
    const BodyState &flown = now.state(i), &expected = truth[static_cast<std::size_t>(i)];
    takeLarger(errors, Measure::kAttitude,
               rotationLog(flown.q_WB.conjugate() * expected.q_WB).norm());
    takeLarger(errors, Measure::kPosition, (flown.p_WBcm - expected.p_WBcm).norm());
    takeLarger(errors, Measure::kMomentum,
               relative((flown.P_WB - expected.P_WB).norm(),
                        std::max(expected.P_WB.norm(), start.state(i).P_WB.norm())));
  }
}

/// The answer is the same for every rung: computed once.
const Answer& answerOf(const HardCase& one, const Bodies& start, Tick ticks, double step_s) {
  static std::map<std::pair<std::string, Tick>, Answer> known;
  const auto [found, is_new] = known.try_emplace({one.name, ticks});
  if (is_new) found->second = one.answer(start, static_cast<double>(ticks) * step_s, step_s);
  return found->second;
}

Outcome outcomeOf(const Verdict& verdict, Errors& errors) {
  for (std::size_t k = 0; k < verdict.errors.size(); ++k) {
    if (verdict.errors[k] <= verdict.bounds[k]) continue;
    return errors[Measure::kEnergy] <= kHundredth && errors[Measure::kAngularMomentum] <= kHundredth
               ? Outcome::kDrifts
               : Outcome::kWrong;
  }
  return Outcome::kHolds;
}

}  // namespace

const char* nameOf(Outcome outcome) {
  switch (outcome) {
    case Outcome::kHolds:
      return "holds";
    case Outcome::kDrifts:
      return "drifts";
    case Outcome::kWrong:
      return "wrong";
    case Outcome::kInfinite:
      return "infinite";
    case Outcome::kRefused:
      return "refused";
  }
  return "";
}

const std::vector<HardCase>& gallery() {
  static const std::vector<HardCase> all = [] {
    std::vector<HardCase> rows;
    for (const auto& some : {tumblingCases(), extremeBodies(), extremeNumbers(), pushedCases()})
      rows.insert(rows.end(), some.begin(), some.end());
    return rows;
  }();
  return all;
}

const HardCase& hardCaseNamed(const std::string& name) {
  std::string known;
  for (const HardCase& one : gallery()) {
    if (one.name == name) return one;
    known += (known.empty() ? "" : ", ") + one.name;
  }
  throw std::invalid_argument("there is no hard case '" + name + "'; there are " + known);
}

Scene sceneOf(const HardCase& one, const std::string& rung) {
  const Parameters parameters(readYaml(one.scene, one.name), "");
  const SceneSources sources = {"", [&](const std::string&) { return one.urdf; }};
  Scene scene = readScene(parameters, sources);
  parameters.refuseUnknown();
  scene.integrator = rung;
  return scene;
}

Claim claimOf(const HardCase& one, const std::string& rung) {
  for (const Excuse& excuse : one.excuses)
    if (std::find(excuse.rungs.begin(), excuse.rungs.end(), rung) != excuse.rungs.end())
      return {excuse.outcome, excuse.why};
  return {};
}

bool keeps(const Claim& claim, const Verdict& verdict) {
  if (claim.outcome != Outcome::kDrifts || verdict.outcome != Outcome::kHolds)
    return claim.outcome == verdict.outcome;
  for (std::size_t k = 0; k < verdict.errors.size(); ++k)
    if (verdict.errors[k] > verdict.bounds[k] / 4) return true;
  return false;
}

Tick ticksOf(const HardCase& one, bool takes_its_time) {
  return takes_its_time && one.long_ticks > 0 ? one.long_ticks : one.ticks;
}

void flyCase(const HardCase& one, Simulator& simulator, Tick ticks, Tick every,
             const std::function<void(const Simulator&)>& each) {
  while (simulator.tick() < ticks && simulator.frozenBodies().empty()) {
    if (each && simulator.tick() % every == 0) each(simulator);
    if (one.input) one.input(simulator);
    simulator.step();
  }
}

Verdict judge(const HardCase& one, const std::string& rung, bool takes_its_time) {
  Verdict verdict;
  std::optional<Simulator> simulator;
  try {
    simulator.emplace(sceneOf(one, rung));
  } catch (const std::invalid_argument& error) {
    verdict.outcome = Outcome::kRefused;
    verdict.why = error.what();
    return verdict;
  }
  const Tick ticks = ticksOf(one, takes_its_time);
  const Bodies start = simulator->bodies();
  const Answer& answer = answerOf(one, start, ticks, simulator->scene().step_s());
  const bool is_free = !one.input && simulator->scene().effects.empty();
  Errors errors;
  flyCase(one, *simulator, ticks, std::max<Tick>(1, ticks / kLooks), [&](const Simulator& now) {
    if (is_free) lookAtConstants(now.bodies(), answer.end, start, errors);
  });
  verdict.end_s = simulator->time_s();
  if (!simulator->frozenBodies().empty()) {
    verdict.outcome = Outcome::kInfinite;
    return verdict;
  }
  lookAtEnd(simulator->bodies(), answer.end, start, errors);
  for (const Bound& bound : one.must) {
    verdict.errors.push_back(errors[bound.measure]);
    verdict.bounds.push_back(bound.most + static_cast<double>(ticks) * bound.a_tick +
                             bound.ulps * answer.turn_of_an_ulp);
  }
  verdict.outcome = outcomeOf(verdict, errors);
  return verdict;
}

}  // namespace rigid_body_sim::reference

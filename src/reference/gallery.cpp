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

struct Errors {
  std::map<Measure, double> largest;
  double energy_change = 0;  // with its sign
};

void takeLarger(Errors& errors, Measure measure, double error) {
  double& largest = errors.largest[measure];
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
    const double difference = kineticEnergy(now, i) - energy;
    const double change = relative(std::abs(difference), std::max(energy, at_start));
    if (!(change <= errors.largest[Measure::kEnergy]))
      errors.energy_change = std::copysign(change, difference);
    takeLarger(errors, Measure::kEnergy, change);
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
    return errors.largest[Measure::kEnergy] <= kHundredth &&
                   errors.largest[Measure::kAngularMomentum] <= kHundredth
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

void stepCase(const HardCase& one, Simulator& simulator) {
  const TorqueInput given = one.input ? one.input(simulator.tick()) : TorqueInput();
  if (!given.t_W.isZero(0)) {
    WrenchInput input;
    input.applied.wrench.t_Q_F = given.t_W;
    input.ticks = 1;
    simulator.apply(input);
  }
  if (!given.J_W.isZero(0)) {
    ImpulseInput input;
    input.applied.wrench.t_Q_F = given.J_W;
    input.start = simulator.tick();
    simulator.apply(input);
  }
  simulator.step();
}

Verdict judge(const HardCase& one, const Flyer& flyer, Tick ticks) {
  Verdict verdict;
  const Answer& answer = answerOf(one, flyer.start, ticks, flyer.step_s);
  const Tick every = std::max<Tick>(1, ticks / kLooks);
  Errors errors;
  Tick tick = 0;
  for (; tick < ticks && !flyer.is_lost(); ++tick) {
    if (flyer.is_free && tick % every == 0)
      lookAtConstants(flyer.bodies(), answer.end, flyer.start, errors);
    flyer.step(tick);
  }
  verdict.end_s = static_cast<double>(tick) * flyer.step_s;
  if (flyer.is_lost()) {
    verdict.outcome = Outcome::kInfinite;
    return verdict;
  }
  lookAtEnd(flyer.bodies(), answer.end, flyer.start, errors);
  for (const Bound& bound : one.must) {
    verdict.errors.push_back(errors.largest[bound.measure]);
    verdict.bounds.push_back(bound.most + static_cast<double>(ticks) * bound.a_tick +
                             bound.ulps * answer.turn_of_an_ulp);
  }
  verdict.energy_change = errors.energy_change;
  verdict.momentum_error = errors.largest[Measure::kAngularMomentum];
  verdict.outcome = outcomeOf(verdict, errors);
  return verdict;
}

Verdict judge(const HardCase& one, const std::string& rung, bool takes_its_time) {
  std::optional<Simulator> simulator;
  try {
    simulator.emplace(sceneOf(one, rung));
  } catch (const std::invalid_argument& error) {
    Verdict verdict;
    verdict.outcome = Outcome::kRefused;
    verdict.why = error.what();
    return verdict;
  }
  return judge(
      one,
      {simulator->bodies(), simulator->scene().step_s(),
       !one.input && simulator->scene().effects.empty(), [&](Tick) { stepCase(one, *simulator); },
       [&]() -> const Bodies& { return simulator->bodies(); },
       [&] { return !simulator->frozenBodies().empty(); }},
      ticksOf(one, takes_its_time));
}

}  // namespace rigid_body_sim::reference

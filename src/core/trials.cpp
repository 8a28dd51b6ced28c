#include "core/trials.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/friction.hpp"
#include "core/local_error.hpp"

namespace rigid_body_sim {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();

/// Errors of attitude beyond this no longer follow the order of the method [rad].
constexpr double kLostAttitude = 0.3;

/// What the adaptive flights of the reference are reckoned as, in steps a tick.
constexpr double kStepsOfReference = 30;

constexpr int kSamplesOfLocalError = 200;

/// What leaves less may cost this much more: a tenth of a microsecond a tick is worth little, and
/// who asks for a milliradian of a body that nothing turns may push it later.
constexpr double kLittleMore = 1.25;

/// 1 to 8, then four an octave: finer would not make a cheaper choice by more than a quarter.
const std::vector<int>& substepCounts() {
  static const std::vector<int> counts = [] {
    std::vector<int> counts = {1, 2, 3};
    for (int octave = 4; octave <= kMostSubsteps; octave *= 2)
      for (int quarter = 0; quarter < 4; ++quarter)
        counts.push_back(std::min(kMostSubsteps, octave + quarter * octave / 4));
    counts.erase(std::unique(counts.begin(), counts.end()), counts.end());
    return counts;
  }();
  return counts;
}

/// The first of the counts that is not less than `count`.
int indexOf(double count) {
  return static_cast<int>(std::lower_bound(substepCounts().begin(), substepCounts().end(), count) -
                          substepCounts().begin());
}

/// What an error will be at the end of a span that is longer than the flight. It grows with the
/// square of the time, as errors of phase do, or as it did in the second half of the flight if that
/// is more; beyond the third power it is chaos, and no power.
double extrapolated(double half, double whole, double span) {
  if (span <= 1 || whole == 0) return whole;
  const double power = half > 0 ? std::clamp(std::log2(whole / half), 2.0, 3.0) : 2.0;
  return whole * std::pow(span, power);
}

}  // namespace

/// The search along the substeps of one integrator: between a number that does not do and one that
/// does.
struct Trials::Rung {
  const IntegratorRow* row;
  int order;
  int failed;  // the largest index that does not keep the budget; one below the least if none
  int next;    // to fly
  int kept;    // the smallest index that keeps it; one above the largest if none
  double failed_share = kInf;  // finite once the error is small enough for laws
  double slope = 0;            // measured; 0: not yet

  bool isDone() const { return next <= failed || next >= kept; }
  Method method() const { return {row->name, substepCounts()[next]}; }
  void giveUp() { next = kept; }

  /// It keeps the budget with a share of it, at most one: perhaps fewer substeps do, too.
  void keeps(double share) {
    kept = next;
    next = std::min(std::max(wanted(share), failed + 1), kept - 1);
  }

  /// It does not. More steps help by a power law, until what is left is rounding.
  void fails(double share, bool is_lost) {
    const int before = failed;
    failed = next;
    if (is_lost || !std::isfinite(share)) {
      next = std::max(failed + 1, indexOf(4.0 * substepCounts()[failed]));
    } else {
      if (share > 0.75 * failed_share) return giveUp();
      if (std::isfinite(failed_share))
        slope = std::log(failed_share / share) /
                std::log(double(substepCounts()[failed]) / substepCounts()[before]);
      failed_share = share;
      next = std::max(failed + 1, wanted(share));
    }
    if (kept < static_cast<int>(substepCounts().size())) next = std::min(next, kept - 1);
  }

 private:
  /// By the measured slope, and a little more. Before there is one by twice the order: a first
  /// error may be far above the law of small steps, and to try too few costs less than too many.
  int wanted(double share) const {
    const double power = slope > 0 ? std::clamp(slope, 0.5 * order, 2.0 * order) : 2.0 * order;
    return indexOf(substepCounts()[next] * std::pow(1.02 * share, 1 / power));
  }
};

Trials::Trials(const Part& part, const Allowance& allowance)
    : part_(part),
      allowance_(allowance),
      compared_(ticksToCompare(allowance.ticks, allowance.every)) {
  StepCount steps = {allowance.stiff_steps, 0};
  truth_ = flyTruly(part, allowance.ticks, allowance.every, steps);
  reference_steps_ = std::max(steps.taken, reckonedSteps());
  for (const auto& effect : part.effects)
    effects_cost_ += effect->cost() * static_cast<double>(effect->bodyCount()) /
                     static_cast<double>(part.bodies.count());
  followTruth();
  findLeast();
}

double Trials::timeOf(std::size_t sample) const {
  return static_cast<double>(part_.tick + compared_[sample]) * part_.tick_s;
}

/// What the bodies meet on the way.
void Trials::followTruth() {
  ActiveEffects active;
  for (const auto& effect : part_.effects) active.add(effect.get());
  double fastest = 0;
  for (std::size_t k = 0; k < compared_.size(); ++k) {
    const Bodies& sample = truth_.trajectory.samples[k];
    rate_ = std::max(rate_, fastestOf(sample).rate);
    if (active.empty()) continue;
    if (is_torque_free_) is_torque_free_ = active.evaluate(sample, timeOf(k)).t_Bcm_W.isZero(0);
    const double decay = fastestDecay(part_.effects, Instant(sample, timeOf(k))).rate;
    if (!(decay > fastest)) continue;
    fastest = decay;
    stiffest_ = k;
  }
}

/// What a simulator asks at its start, and of friction also later.
bool Trials::isBorne(const Method& method) const {
  if (!objection(method, part_.effects).empty()) return false;
  if (!objection(method, rate_, part_.tick_s).empty()) return false;
  if (part_.effects.empty()) return true;
  const std::vector<Bodies>& samples = truth_.trajectory.samples;
  const auto isTooStiff = [&](std::size_t k) {
    const Instant now(samples[k], timeOf(k));
    return tooStiff(method, part_.effects, now, part_.tick_s).has_value();
  };
  return !isTooStiff(0) && (stiffest_ == 0 || !isTooStiff(stiffest_));
}

void Trials::findLeast() {
  for (const IntegratorRow& row : integrators()) {
    const auto isTooFew = [&](int substeps) { return !isBorne({row.name, substeps}); };
    const std::vector<int>& counts = substepCounts();
    // Most take a single one.
    const auto least = isTooFew(counts[0])
                           ? std::partition_point(counts.begin(), counts.end(), isTooFew)
                           : counts.begin();
    least_[row.name] = static_cast<int>(least - counts.begin());
  }
}

double Trials::costOf(const Method& method) const {
  const IntegratorRow& row = integratorNamed(method.integrator);
  const bool skips_turning = row.free_flight_is_exact && rate_ == 0;
  const bool is_cheap =
      part_.effects.empty() || (is_torque_free_ && (row.is_cheap_without_torque || skips_turning));
  return method.substeps *
         ((is_cheap ? row.cost : row.forced_cost) + row.evaluations * effects_cost_);
}

double Trials::reckonedSteps() const {
  return kStepsOfReference * static_cast<double>(allowance_.ticks * part_.bodies.count());
}

double Trials::stepsOf(const Method& method) const {
  return static_cast<double>(allowance_.ticks) * static_cast<double>(part_.bodies.count()) *
         method.substeps;
}

Deviation Trials::doubt() const {
  return {extrapolated(0, truth_.doubt.attitude_rad, allowance_.span),
          extrapolated(0, truth_.doubt.position_m, allowance_.span)};
}

Deviation Trials::errorOf(const Method& method) {
  const auto [found, is_new] =
      flown_.emplace(std::pair(method.integrator, method.substeps), Deviation());
  Deviation& error = found->second;
  if (!is_new) return error;
  (isWithin(method) ? body_steps_ : stiff_steps_) += stepsOf(method);
  Flight flight(part_, method);
  Deviation whole, half;
  const std::vector<Bodies>& truth = truth_.trajectory.samples;
  for (std::size_t k = 1; k < truth.size(); ++k) {
    while (flight.tick() < part_.tick + compared_[k]) flight.step();
    for (Eigen::Index i = 0; i < truth[k].count(); ++i)
      whole = worse(whole, deviation(flight.bodies(), truth[k], i));
    if (2 * k <= truth.size()) half = whole;
    if (whole.attitude_rad > 3 * kLostAttitude || !std::isfinite(whole.position_m)) break;
  }
  error = {extrapolated(half.attitude_rad, whole.attitude_rad, allowance_.span),
           extrapolated(half.position_m, whole.position_m, allowance_.span)};
  return error;
}

std::vector<Trials::Rung> Trials::rungs(const std::string& except) const {
  const int count = static_cast<int>(substepCounts().size());
  std::vector<Rung> rungs;
  for (const IntegratorRow& row : integrators()) {
    // An adaptive method's price is not known before, and its steps would couple the bodies.
    if (row.order == 0 || row.name == except) continue;
    int order = row.order;
    for (const auto& effect : part_.effects) order = std::min(order, orderUnder(row, *effect));
    if (order == 0) continue;
    // Where nothing acts, all the exact ones are one.
    if (part_.effects.empty() && row.free_flight_is_exact && row.name != "exact") continue;
    const int least = least_.at(row.name);
    rungs.push_back({&row, order, least - 1, least, count});
  }
  return rungs;
}

std::optional<Offer> Trials::cheapest(const Budget& budget, const std::string& except) {
  std::optional<Offer> best;
  std::vector<Rung> all = rungs(except);
  while (true) {
    Rung* next = nullptr;
    double least_cost = best ? best->cost : kInf;
    for (Rung& rung : all) {
      if (rung.isDone() || costOf(rung.method()) >= least_cost) continue;
      least_cost = costOf(rung.method());
      next = &rung;
    }
    if (!next) return best;
    const Method method = next->method();
    if (!isAffordable(method)) {
      next->giveUp();
      continue;
    }
    const Deviation error = errorOf(method);
    const double share = shareOf(budget, error, doubt());
    if (share > 1) {
      next->fails(share, error.attitude_rad > kLostAttitude);
      continue;
    }
    next->keeps(share);
    best = Offer{method, error, costOf(method)};
  }
}

bool Trials::isAffordable(const Method& method) const {
  return flown_.count({method.integrator, method.substeps}) > 0 || isWithin(method) ||
         isFirstOfStiff(method);
}

bool Trials::isWithin(const Method& method) const {
  return reckonedSteps() + body_steps_ + stepsOf(method) <= allowance_.steps;
}

/// The first flight of a method that is unstable with fewer steps has an allowance of its own: the
/// cheap ones, which are tried before, may have used up the other.
bool Trials::isFirstOfStiff(const Method& method) const {
  const int least = least_.at(method.integrator);
  return least > 0 && method.substeps == substepCounts()[static_cast<std::size_t>(least)] &&
         stiff_steps_ + stepsOf(method) <= allowance_.stiff_steps;
}

std::optional<Offer> Trials::choose(const Budget& budget, const std::string& except) {
  std::optional<Offer> chosen = cheapest(budget, except);
  if (!chosen) return chosen;
  const double most = kLittleMore * chosen->cost;
  double least = shareOf(budget, chosen->error, doubt());
  for (const Rung& rung : rungs(except)) {
    if (rung.isDone() || costOf(rung.method()) > most || !isAffordable(rung.method())) continue;
    const Offer offer = {rung.method(), errorOf(rung.method()), costOf(rung.method())};
    const double share = shareOf(budget, offer.error, doubt());
    if (share >= least) continue;
    least = share;
    chosen = offer;
  }
  return chosen;
}

std::optional<Offer> Trials::best(const Budget& budget) const {
  std::optional<Offer> best;
  double least = kInf;
  for (const auto& [key, error] : flown_) {
    const Method method = {key.first, key.second};
    const double share = shareOf(budget, error, doubt());
    if (best && (share > least || (share == least && costOf(method) >= best->cost))) continue;
    least = share;
    best = Offer{method, error, costOf(method)};
  }
  return best;
}

Forecast Trials::forecast(const Offer& offer) const {
  Flight flight(part_, offer.method);
  Part before = part_;
  Deviation local;
  const Tick apart = std::max<Tick>(1, allowance_.ticks / kSamplesOfLocalError);
  for (Tick k = 0; k < allowance_.ticks; ++k) {
    const bool is_sample = k % apart == 0;
    if (is_sample) before.bodies = flight.bodies();
    before.tick = flight.tick();
    flight.step();
    if (is_sample) local = worse(local, localError(before, flight.bodies(), offer.method));
  }
  const double ticks = static_cast<double>(allowance_.ticks) * allowance_.span;
  const auto ratio = [&](double error, double local_error, double rounding) {
    // Below rounding a ratio says nothing of what a coarser step would grow to: one, then.
    if (local_error <= rounding) return std::max(1.0, error / (ticks * rounding));
    return error / (ticks * local_error);
  };
  const Deviation rounding = roundingOfTick(part_.bodies, part_.tick_s);
  const Deviation error = {offer.error.attitude_rad + doubt().attitude_rad,
                           offer.error.position_m + doubt().position_m};
  return {error,
          {ratio(error.attitude_rad, local.attitude_rad, rounding.attitude_rad),
           ratio(error.position_m, local.position_m, rounding.position_m)}};
}

}  // namespace rigid_body_sim

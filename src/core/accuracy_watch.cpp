#include "core/accuracy_watch.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/local_error.hpp"

namespace rigid_body_sim {
namespace {

constexpr Tick kTicksBetweenSamples = 30;  // of one body

}  // namespace

AccuracyWatch::AccuracyWatch(Bill bill, const Scene& scene)
    : first_(bill),
      tick_s_(scene.step_s()),
      is_coupled_(areCoupled(scene.effects, static_cast<Eigen::Index>(scene.bodies.size()))) {
  const auto count = static_cast<Tick>(scene.bodies.size());
  apart_ =
      is_coupled_ ? kTicksBetweenSamples * count : std::max<Tick>(1, kTicksBetweenSamples / count);
  last_.resize(scene.bodies.size());
  next_plan_.resize(scene.bodies.size(), 0);
  take(std::move(bill));
}

void AccuracyWatch::take(Bill bill) {
  methods_.resize(last_.size());
  for (const ClassBill& one : bill.classes)
    for (const Eigen::Index body : one.bodies) methods_[body] = one.chosen.method;
  state_.bill = std::move(bill);
}

void AccuracyWatch::impulse(const ImpulseInput& input, const Bodies& before, Tick tick) {
  follow(input.body, before, tick);
  copies_.give(input);
  lookAt(input.body);
}

void AccuracyWatch::wrench(Eigen::Index body, const Bodies& before, Tick tick) {
  if (follow(body, before, tick)) lookAt(body);
}

/// @returns whether it is the body's first input
bool AccuracyWatch::follow(Eigen::Index body, const Bodies& before, Tick tick) {
  return !is_coupled_ && copies_.follow(body, before, tick);
}

void AccuracyWatch::lookAt(Eigen::Index body) {
  if (is_coupled_) body = 0;
  if (std::find(asked_.begin(), asked_.end(), body) == asked_.end()) asked_.push_back(body);
}

void AccuracyWatch::beginTick(const Situation& now) {
  copies_.step(now, methods_);
  looked_at_.reset();
  const bool is_asked = !asked_.empty();
  if (is_asked) {
    body_ = asked_.front();
    asked_.pop_front();
  } else if (ticks_ % apart_ == 0) {
    body_ = next_;
    next_ = is_coupled_ ? 0 : (next_ + 1) % now.bodies.count();
  } else {
    return;
  }
  looked_at_ = is_coupled_ ? wholeOf(now) : partOf(now, {body_});
  if (!is_asked || !state_.bill.budget.replan) return;
  // Tried before the tick is taken: the method may have become a very bad one.
  Flight flight(*looked_at_, methods_[body_]);
  flight.step();
  note(sampleOf(flight.bodies()));
}

void AccuracyWatch::endTick(const Bodies& bodies, const std::vector<FrozenBody>& frozen,
                            Tick tick) {
  ++ticks_;
  for (const FrozenBody& one : frozen) copies_.forget(one.body);
  compareCopies(bodies, tick + 1);
  if (!looked_at_) return;
  const bool is_frozen = std::any_of(frozen.begin(), frozen.end(), [&](const FrozenBody& one) {
    return is_coupled_ || one.body == body_;
  });
  if (is_frozen) return forget(body_);
  note(sampleOf(rowsOf(bodies, looked_at_->indices)));
}

void AccuracyWatch::compareCopies(const Bodies& bodies, Tick tick) {
  state_.spent.reset();
  const Budget& budget = state_.bill.budget;
  const double span = std::ceil(budget.over_s / tick_s_);
  Bodies copy(1);
  for (const TrueCopies::Copy& one : copies_.copies()) {
    copy.setState(0, one.state);
    SpentError spent = {one.body, one.since, tick, deviation(copy, rowsOf(bodies, {one.body}), 0)};
    // What was planned until the first input, in proportion to the time.
    const double until = std::min(1.0, static_cast<double>(one.since - start_) / span);
    const Deviation& planned = first_.forecasts[one.body].error;
    const Deviation sum = {spent.error.attitude_rad + until * planned.attitude_rad,
                           spent.error.position_m + until * planned.position_m};
    spent.share = kShareOfBudget * shareOf(budget, sum, {});
    if (!state_.spent || spent.share > state_.spent->share) state_.spent = spent;
  }
  if (!state_.broken && state_.spent && state_.spent->share > kAlarm &&
      static_cast<double>(ticks_) <= span)
    state_.broken = state_.spent;
}

LocalError AccuracyWatch::sampleOf(const Bodies& after) const {
  LocalError sample;
  sample.tick = looked_at_->tick;
  sample.body = body_;
  sample.error = localError(*looked_at_, after, methods_[body_]);
  sample.predicted = predictedFrom(sample.error, roundingOfTick(looked_at_->bodies, tick_s_),
                                   state_.bill.forecasts[body_]);
  sample.share = kShareOfBudget * shareOf(state_.bill.budget, sample.predicted, {});
  return sample;
}

Deviation AccuracyWatch::predictedFrom(const Deviation& error, const Deviation& rounding,
                                       const Forecast& forecast) const {
  const double ticks = std::ceil(state_.bill.budget.over_s / tick_s_);
  const auto predicted = [&](double local, double least, double amplification, double planned) {
    const double sum = ticks * amplification * local;
    return local <= least ? std::min(sum, planned) : sum;
  };
  return {predicted(error.attitude_rad, rounding.attitude_rad, forecast.amplification.attitude_rad,
                    forecast.error.attitude_rad),
          predicted(error.position_m, rounding.position_m, forecast.amplification.position_m,
                    forecast.error.position_m)};
}

void AccuracyWatch::note(const LocalError& sample) {
  ++state_.samples;
  state_.latest = sample;
  last_[sample.body] = sample;
  if (!state_.worst_ever || sample.share > state_.worst_ever->share) state_.worst_ever = sample;
  if (!state_.worst_now || sample.share >= state_.worst_now->share) {
    state_.worst_now = sample;
  } else if (state_.worst_now->body == sample.body) {
    findWorst();
  }
}

void AccuracyWatch::forget(Eigen::Index body) {
  last_[body].reset();
  findWorst();
}

void AccuracyWatch::findWorst() {
  state_.worst_now.reset();
  for (const auto& last : last_)
    if (last && (!state_.worst_now || last->share > state_.worst_now->share))
      state_.worst_now = last;
}

std::optional<Eigen::Index> AccuracyWatch::bodyToReplan() const {
  if (!state_.bill.budget.replan || state_.willKeep()) return std::nullopt;
  const LocalError* worst = nullptr;
  for (const auto& last : last_)
    if (last && last->share > kAlarm && ticks_ >= next_plan_[last->body] &&
        (!worst || last->share > worst->share))
      worst = &*last;
  if (!worst) return std::nullopt;
  return worst->body;
}

void AccuracyWatch::replan(Bill bill, Eigen::Index body) {
  const double pause = std::ceil(0.1 * bill.budget.over_s / tick_s_);
  next_plan_[body] = ticks_ + std::max<Tick>(1, static_cast<Tick>(pause));
  take(std::move(bill));
  ++state_.bills;
  state_.planned_for = last_[body];
  forget(body);  // it was of the method before
  lookAt(body);  // to know how the new choice does
}

bool AccuracyWatch::reset(Tick tick) {
  const bool is_another = state_.bills > 1;
  const int bills = state_.bills;
  state_ = AccuracyState();
  state_.bills = is_another ? bills + 1 : bills;
  take(first_);
  ticks_ = 0;
  start_ = tick;
  next_ = 0;
  asked_.clear();
  copies_.clear();
  looked_at_.reset();
  std::fill(last_.begin(), last_.end(), std::nullopt);
  std::fill(next_plan_.begin(), next_plan_.end(), 0);
  return is_another;
}

}  // namespace rigid_body_sim

#include "rigid_body_sim/active_effects.hpp"

#include <algorithm>

#include "rigid_body_sim/conserved.hpp"

namespace rigid_body_sim {

void Wrenches::setZero(Eigen::Index count) {
  f_W.setZero(count, 3);
  t_Bcm_W.setZero(count, 3);
}

void ActiveEffects::add(const Effect* effect) {
  depend_on_velocity_ = depend_on_velocity_ || effect->dependsOnVelocity();
  if (effect->flowOrder() == 0) {
    kicks_.push_back({effect});
    are_steady_ = are_steady_ && effect->isSteady();
    is_kept_ = false;
    return;
  }
  const auto is_innermost = [](const Entry& entry) { return entry.effect->hasInnermostFlow(); };
  const auto place = effect->hasInnermostFlow()
                         ? flows_.end()
                         : std::find_if(flows_.begin(), flows_.end(), is_innermost);
  flows_.insert(place, {effect});
}

void ActiveEffects::remove(const Effect* effect) {
  const auto is_it = [effect](const Entry& entry) { return entry.effect == effect; };
  for (auto* entries : {&kicks_, &flows_}) {
    for (const Entry& entry : *entries)
      if (is_it(entry))
        rigid_body_sim::addUp({{effect->name(), entry.evaluations, entry.work_J}}, past_);
    entries->erase(std::remove_if(entries->begin(), entries->end(), is_it), entries->end());
  }
  const auto is_steady = [](const Entry& entry) { return entry.effect->isSteady(); };
  are_steady_ = std::all_of(kicks_.begin(), kicks_.end(), is_steady);
  is_kept_ = false;
  const auto depends = [](const Entry& entry) { return entry.effect->dependsOnVelocity(); };
  depend_on_velocity_ = std::any_of(kicks_.begin(), kicks_.end(), depends) ||
                        std::any_of(flows_.begin(), flows_.end(), depends);
}

void addUp(const std::vector<EffectCount>& more, std::vector<EffectCount>& counts) {
  for (const EffectCount& one : more) {
    const auto same = [&](const EffectCount& count) { return count.name == one.name; };
    const auto found = std::find_if(counts.begin(), counts.end(), same);
    if (found == counts.end()) {
      counts.push_back(one);
      continue;
    }
    found->evaluations += one.evaluations;
    found->work_J += one.work_J;
  }
}

bool ActiveEffects::areSteady() const {
  const auto is_conservative = [](const Entry& entry) { return entry.effect->isConservative(); };
  return are_steady_ && flows_.empty() &&
         (!is_audited_ || std::all_of(kicks_.begin(), kicks_.end(), is_conservative));
}

/// The sum of the kicks; if it is steady, that of the last time.
void ActiveEffects::addUpKicks(unsigned times) {
  const Eigen::Index count = instant_.bodies().count();
  if (!is_kept_ || sum_.f_W.rows() != count) {
    sum_.setZero(count);
    for (const Entry& entry : kicks_) entry.effect->addWrenches(instant_, sum_);
    is_kept_ = are_steady_;
  }
  for (Entry& entry : kicks_) entry.evaluations += times * entry.effect->bodyCount();
}

void ActiveEffects::addUpFlows() {
  is_kept_ = is_kept_ && flows_.empty();
  for (Entry& entry : flows_) {
    entry.effect->addWrenches(instant_, sum_);
    entry.evaluations += entry.effect->bodyCount();
  }
}

const Wrenches& ActiveEffects::evaluateSteady(const Bodies& bodies, double time_s, unsigned times) {
  instant_.set(bodies, time_s);
  addUpKicks(times);
  return sum_;
}

const Wrenches& ActiveEffects::evaluate(const Bodies& bodies, double time_s, double weight_s) {
  instant_.set(bodies, time_s);
  addUpKicks(1);
  addUpFlows();
  if (is_audited_) {
    auditStage(kicks_, weight_s);
    auditStage(flows_, weight_s);
  }
  return sum_;
}

const Wrenches& ActiveEffects::evaluateKicks(const Bodies& bodies, double time_s, double weight_s) {
  instant_.set(bodies, time_s);
  addUpKicks(1);
  if (is_audited_) auditKicks(weight_s);
  return sum_;
}

/// Kicks were evaluated at the same attitudes just before.
void ActiveEffects::beforeDrift(Bodies& bodies, double time_s, double h) {
  if (hasKicks())
    instant_.forgetVelocities();
  else
    instant_.set(bodies, time_s);
  for (Entry& entry : flows_) {
    entry.evaluations += entry.effect->bodyCount();
    audited(entry, bodies, [&] { entry.effect->beforeDrift(bodies, instant_, h); });
    hasFlowed(*entry.effect);
  }
}

void ActiveEffects::afterDrift(Bodies& bodies, double time_s, double h) {
  instant_.set(bodies, time_s + h);
  for (auto entry = flows_.rbegin(); entry != flows_.rend(); ++entry) {
    audited(*entry, bodies, [&] { entry->effect->afterDrift(bodies, instant_, h); });
    hasFlowed(*entry->effect);
  }
}

void ActiveEffects::hasFlowed(const Effect& effect) {
  if (effect.hasTurningFlow())
    instant_.set(instant_.bodies(), instant_.time_s());
  else
    instant_.forgetVelocities();
}

/// The work of a flow is what it changes the kinetic energy by.
template <class Flow>
void ActiveEffects::audited(Entry& entry, Bodies& bodies, Flow flow) {
  if (!is_audited_ || entry.effect->isConservative()) return flow();
  const double before = kineticEnergy(bodies);
  flow();
  entry.work_J += kineticEnergy(bodies) - before;
}

const Wrenches& ActiveEffects::wrenchesOf(const Effect& effect) {
  one_.setZero(instant_.bodies().count());
  effect.addWrenches(instant_, one_);
  return one_;
}

/// A kick's work, exactly: the momenta it gives, times the mean of the velocities before and after.
void ActiveEffects::auditKicks(double weight_s) {
  const Bodies& bodies = instant_.bodies();
  for (Entry& entry : kicks_) {
    if (entry.effect->isConservative()) continue;
    const Wrenches& own = wrenchesOf(*entry.effect);
    for (Eigen::Index i = 0; i < bodies.count(); ++i) {
      const BodyState state = bodies.state(i);
      const Vector3d mean_P = state.P_WB + 0.5 * weight_s * sum_.f_W.row(i).transpose();
      const Vector3d mean_L = state.L_WBcm_W + 0.5 * weight_s * sum_.t_Bcm_W.row(i).transpose();
      const Vector3d w_WB =
          angularVelocity({state.p_WBcm, state.q_WB, mean_P, mean_L}, bodies.moments(i));
      entry.work_J += weight_s * (own.f_W.row(i).dot(bodies.velocityFor(i, mean_P)) +
                                  own.t_Bcm_W.row(i).dot(w_WB));
    }
  }
}

/// A stage of a Runge-Kutta method: its power, with the stage's weight.
void ActiveEffects::auditStage(std::vector<Entry>& entries, double weight_s) {
  if (weight_s == 0) return;
  for (Entry& entry : entries) {
    if (entry.effect->isConservative()) continue;
    const Wrenches& own = wrenchesOf(*entry.effect);
    entry.pending_J += weight_s * (own.f_W.cwiseProduct(instant_.v_WBcm()).sum() +
                                   own.t_Bcm_W.cwiseProduct(instant_.w_WB()).sum());
  }
}

void ActiveEffects::stepTaken() {
  if (!is_audited_) return;
  for (auto* entries : {&kicks_, &flows_}) {
    for (Entry& entry : *entries) {
      entry.work_J += entry.pending_J;
      entry.pending_J = 0;
    }
  }
}

void ActiveEffects::stepGivenUp() {
  if (!is_audited_) return;
  for (auto* entries : {&kicks_, &flows_})
    for (Entry& entry : *entries) entry.pending_J = 0;
}

std::vector<EffectCount> ActiveEffects::counts() const {
  std::vector<EffectCount> counts = past_;
  for (const auto* entries : {&kicks_, &flows_})
    for (const Entry& entry : *entries)
      rigid_body_sim::addUp({{entry.effect->name(), entry.evaluations, entry.work_J}}, counts);
  return counts;
}

}  // namespace rigid_body_sim

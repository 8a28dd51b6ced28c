#include "node/diagnostics.hpp"

#include <cmath>

namespace rigid_body_sim {

using diagnostic_msgs::DiagnosticStatus;

namespace {

/// Of the energy that there is: what a method makes or loses of it beyond this is worth a warning.
constexpr double kNoticeable = 0.01;

}  // namespace

Diagnostics::Diagnostics(ros::NodeHandle& nh, const Simulator& simulator, const Inputs& inputs,
                         Pace& pace, double real_time_factor)
    : simulator_(simulator),
      inputs_(inputs),
      pace_(pace),
      real_time_factor_(real_time_factor),
      elisions_(elisions(simulator.scene())),
      updater_(nh) {
  updater_.setHardwareID("none");
  updater_.add("simulation", this, &Diagnostics::report);
  // On the steady clock: the updater's own timer stands still while simulated time does.
  timer_ = nh.createSteadyTimer(ros::WallDuration(1),
                                [this](const ros::SteadyTimerEvent&) { updater_.force_update(); });
}

void Diagnostics::report(diagnostic_updater::DiagnosticStatusWrapper& status) {
  status.summary(DiagnosticStatus::OK, is_paused_ ? "paused" : "simulating");
  status.add("scene", summary(simulator_.scene()));
  status.add("tick", simulator_.tick());
  reportEffects(status);
  reportPace(status);
  reportInputs(status);
  reportAccuracy(status);
  reportStability(status);
  reportFrozen(status);
}

void Diagnostics::reportEffects(diagnostic_updater::DiagnosticStatusWrapper& status) {
  for (const EffectCount& count : simulator_.effectCounts())
    status.add("evaluations of " + count.name, count.evaluations);
  for (const std::string& elision : elisions_) status.add("not computed", elision);
  if (!simulator_.scene().energy_audit) return;
  const EnergyBalance energy = simulator_.energy();
  status.addf("energy", "%.9g J kinetic, %.9g J potential", energy.kinetic_J, energy.potential_J);
  status.addf("work since the start",
              "%.9g J of inputs, %.9g J of effects that are not conservative", energy.inputs_J,
              energy.effects_J);
  if (!simulator_.frozenBodies().empty())
    return status.add("energy unaccounted for", "not known: a body is frozen");
  status.addf("energy unaccounted for", "%.3g J", energy.unaccounted_J());
  const double all_J = energy.kinetic_J + std::abs(energy.potential_J) + std::abs(energy.start_J) +
                       std::abs(energy.inputs_J) + std::abs(energy.effects_J);
  if (!lost_ && !(std::abs(energy.unaccounted_J()) <= kNoticeable * all_J))
    lost_ = Lost{energy.unaccounted_J(), simulator_.tick()};
  if (lost_)
    status.mergeSummaryf(DiagnosticStatus::WARN,
                         "%.3g J were unaccounted for at tick %ld: steps too long", lost_->energy_J,
                         static_cast<long>(lost_->tick));
}

void Diagnostics::reportPace(diagnostic_updater::DiagnosticStatusWrapper& status) {
  const ros::SteadyTime now = ros::SteadyTime::now();
  const double wall_s = (now - last_time_).toSec();
  const double simulated_s =
      static_cast<double>(simulator_.tick() - last_tick_) * simulator_.scene().step_s();
  status.addf("real-time factor", "%.4g", wall_s > 0 ? simulated_s / wall_s : 0.0);
  status.add("real-time factor wanted", real_time_factor_);
  status.add("overruns", pace_.overruns());
  status.addf("latest tick [ms]", "%.3f", 1e-6 * static_cast<double>(pace_.takeLatest()));
  status.add("times that lost time was given up", pace_.rebases());
  if (pace_.rebases() > last_rebases_)
    status.mergeSummary(DiagnosticStatus::WARN, "slower than the real-time factor");
  last_time_ = now;
  last_tick_ = simulator_.tick();
  last_rebases_ = pace_.rebases();
}

void Diagnostics::reportInputs(diagnostic_updater::DiagnosticStatusWrapper& status) {
  const InputCounts& counts = inputs_.counts();
  status.add("inputs accepted", counts.accepted);
  for (int i = 0; i < kRefusalCount; ++i)
    status.add(std::string("inputs refused: ") + toText(static_cast<Refusal>(i)),
               counts.refused[i]);
  status.add("wrenches expired", counts.expired);
  status.add("wrenches held", simulator_.heldWrenches().size());
  status.add("inputs waiting", simulator_.pendingCount());
  if (counts.refusedInAll() > last_refused_)
    status.mergeSummary(DiagnosticStatus::WARN, "inputs refused");
  last_refused_ = counts.refusedInAll();
}

void Diagnostics::reportAccuracy(diagnostic_updater::DiagnosticStatusWrapper& status) {
  const AccuracyState* accuracy = simulator_.accuracy();
  if (!accuracy) return;
  const Scene& scene = simulator_.scene();
  const Bill& bill = accuracy->bill;
  status.add("accuracy budget", summary(bill.budget));
  status.add("accuracy plans made", accuracy->bills);
  for (std::size_t i = 0; i < bill.classes.size(); ++i)
    status.add("accuracy method " + std::to_string(i + 1), summary(bill.classes[i], scene));
  const auto add = [&](const std::string& key, const std::optional<LocalError>& sample) {
    if (sample) status.add(key, toText(*sample, scene));
  };
  status.add("local errors measured", accuracy->samples);
  add("local error latest", accuracy->latest);
  add("local error worst", accuracy->worst_ever);
  add("predicted error", accuracy->worst_now);
  if (accuracy->spent) status.add("error of inputs", toText(*accuracy->spent, scene));
  for (const ClassBill& one : bill.classes)
    if (!one.keeps_budget)
      status.mergeSummary(DiagnosticStatus::WARN, scene.bodies[one.hardest].name +
                                                      ": nothing keeps the accuracy budget; " +
                                                      toText(one.chosen.method) + " is the best");
  if (accuracy->broken)
    status.mergeSummary(DiagnosticStatus::WARN,
                        "the accuracy budget is broken: " + toText(*accuracy->broken, scene));
  if (!accuracy->willKeep())
    status.mergeSummary(DiagnosticStatus::WARN,
                        "the accuracy budget breaks: " + toText(*accuracy->worst_now, scene));
}

void Diagnostics::reportStability(diagnostic_updater::DiagnosticStatusWrapper& status) {
  if (const auto stiff = simulator_.stiffBody())
    status.mergeSummary(DiagnosticStatus::WARN,
                        simulator_.scene().bodies[stiff->body].name + ": " + stiff->why);
  const auto body = simulator_.overTurnedBody();
  if (!body) return;
  status.mergeSummaryf(DiagnosticStatus::WARN, "%s turns by %.3g rad a step, and %s bears %.3g",
                       simulator_.scene().bodies[body->body].name.c_str(), body->turn,
                       toText(body->method).c_str(), body->max_turn);
}

void Diagnostics::reportFrozen(diagnostic_updater::DiagnosticStatusWrapper& status) {
  for (const FrozenBody& frozen : simulator_.frozenBodies()) {
    const std::string& name = simulator_.scene().bodies[frozen.body].name;
    status.addf("frozen: " + name, "state not finite after tick %ld",
                static_cast<long>(frozen.tick));
    status.mergeSummary(DiagnosticStatus::ERROR, name + " is frozen");
  }
}

}  // namespace rigid_body_sim

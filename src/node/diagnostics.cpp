#include "node/diagnostics.hpp"

namespace rigid_body_sim {

using diagnostic_msgs::DiagnosticStatus;

Diagnostics::Diagnostics(ros::NodeHandle& nh, const Simulator& simulator, const Inputs& inputs,
                         const Pace& pace, double real_time_factor)
    : simulator_(simulator),
      inputs_(inputs),
      pace_(pace),
      real_time_factor_(real_time_factor),
      updater_(nh) {
  updater_.setHardwareID("none");
  updater_.add("simulation", this, &Diagnostics::report);
  // On the steady clock: the updater's own timer stands still while simulated time does.
  timer_ = nh.createSteadyTimer(ros::WallDuration(1),
                                [this](const ros::SteadyTimerEvent&) { updater_.force_update(); });
}

void Diagnostics::report(diagnostic_updater::DiagnosticStatusWrapper& status) {
  status.summary(DiagnosticStatus::OK, "simulating");
  status.add("scene", summary(simulator_.scene()));
  status.add("tick", simulator_.tick());
  reportPace(status);
  reportInputs(status);
  reportFrozen(status);
}

void Diagnostics::reportPace(diagnostic_updater::DiagnosticStatusWrapper& status) {
  const ros::SteadyTime now = ros::SteadyTime::now();
  const double wall_s = (now - last_time_).toSec();
  const double simulated_s =
      static_cast<double>(simulator_.tick() - last_tick_) * simulator_.scene().step_s();
  status.addf("real-time factor", "%.4g", wall_s > 0 ? simulated_s / wall_s : 0.0);
  status.add("real-time factor wanted", real_time_factor_);
  status.add("overruns", pace_.overruns());
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

void Diagnostics::reportFrozen(diagnostic_updater::DiagnosticStatusWrapper& status) {
  for (const FrozenBody& frozen : simulator_.frozenBodies()) {
    const std::string& name = simulator_.scene().bodies[frozen.body].name;
    status.addf("frozen: " + name, "state not finite after tick %ld",
                static_cast<long>(frozen.tick));
    status.mergeSummary(DiagnosticStatus::ERROR, name + " is frozen");
  }
}

}  // namespace rigid_body_sim

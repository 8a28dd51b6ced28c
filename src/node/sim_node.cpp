#include "node/sim_node.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "node/conversions.hpp"
#include "node/names.hpp"

namespace rigid_body_sim {
namespace {

constexpr std::uint32_t kMaxSteps = 1'000'000;
constexpr double kIdle_s = 0.1;  // how often a waiting loop looks whether it shall end

std::int64_t steadyNow() { return static_cast<std::int64_t>(ros::SteadyTime::now().toNSec()); }

std::int64_t wallPeriod(const Scene& scene, double real_time_factor) {
  if (real_time_factor == 0) return 0;
  return static_cast<std::int64_t>(
      std::llround(static_cast<double>(scene.step_ns) / real_time_factor));
}

}  // namespace

SimNode::SimNode(ros::NodeHandle& nh, ros::NodeHandle& private_nh, ros::CallbackQueue& queue,
                 Scene scene, const NodeOptions& options)
    : queue_(queue),
      simulator_(std::move(scene), [] { return ros::isShuttingDown() || !ros::ok(); }),
      time_{options.start_time_ns, simulator_.scene().step_ns},
      options_(options),
      pace_(wallPeriod(simulator_.scene(), options.real_time_factor)),
      inputs_(nh, simulator_, time_, options_),
      outputs_(nh, simulator_, time_, options_),
      diagnostics_(nh, simulator_, inputs_, pace_, options.real_time_factor),
      paused_(options.paused),
      start_warnings_(simulator_.scene().warnings.size()) {
  services_.push_back(private_nh.advertiseService(names::kPause, &SimNode::pause, this));
  services_.push_back(private_nh.advertiseService(names::kStep, &SimNode::step, this));
  services_.push_back(private_nh.advertiseService(names::kReset, &SimNode::reset, this));
  services_.push_back(
      private_nh.advertiseService(names::kSwitchEffect, &SimNode::switchEffect, this));
}

void SimNode::run() {
  tellAccuracy();
  setPaused(paused_);
  pace_.restart(steadyNow());
  while (ros::ok()) {
    if (paused_) {
      queue_.callAvailable(ros::WallDuration(kIdle_s));
      outputs_.serveNewSubscribers();
      if (!paused_) pace_.restart(steadyNow());
      continue;
    }
    runTick();
    waitUntilDue();
    publishTick();
    pace_.tickDone(steadyNow());
  }
}

void SimNode::runTick() {
  outputs_.serveNewSubscribers();
  simulator_.step();
  is_published_ = false;
  inputs_.reportExpired();
  tellFrozen();
  tellAccuracy();
}

void SimNode::tellFrozen() {
  const std::vector<FrozenBody>& frozen = simulator_.frozenBodies();
  for (; frozen_told_ < frozen.size(); ++frozen_told_) {
    ROS_ERROR(
        "%s is frozen at its last good state: its next one is not finite (tick %ld); ~reset "
        "clears it",
        simulator_.scene().bodies[frozen[frozen_told_].body].name.c_str(),
        static_cast<long>(frozen[frozen_told_].tick));
  }
}

/// Says what the accuracy costs, at the start and when it was planned anew, and when it is lost.
void SimNode::tellAccuracy() {
  const AccuracyState* accuracy = simulator_.accuracy();
  if (!accuracy) return;
  tellBill(*accuracy);
  const Scene& scene = simulator_.scene();
  if (!accuracy->willKeep() && !is_breach_told_) {
    ROS_WARN("the accuracy budget breaks: %s", toText(*accuracy->worst_now, scene).c_str());
    is_breach_told_ = true;
  }
  if (accuracy->broken && !is_loss_told_)
    ROS_WARN("the accuracy budget is broken: %s", toText(*accuracy->broken, scene).c_str());
  is_loss_told_ = accuracy->broken.has_value();
}

void SimNode::tellBill(const AccuracyState& state) {
  if (state.bills == bills_told_) return;
  is_breach_told_ = false;
  if (state.planned_for)
    ROS_WARN("inputs broke the accuracy budget, methods are chosen anew: %s",
             toText(*state.planned_for, simulator_.scene()).c_str());
  std::istringstream lines(toText(state.bill, simulator_.scene()));
  for (std::string line; std::getline(lines, line);) ROS_INFO("%s", line.c_str());
  if (bills_told_ > 0) outputs_.publishBill();
  bills_told_ = state.bills;
}

void SimNode::publishTick() {
  if (is_published_) return;
  outputs_.publish();
  is_published_ = true;
}

/// Runs callbacks until the tick is due, or until one of them has published it.
void SimNode::waitUntilDue() {
  do {
    const double wait_s = 1e-9 * static_cast<double>(pace_.untilDue(steadyNow()));
    queue_.callAvailable(ros::WallDuration(std::clamp(wait_s, 0.0, kIdle_s)));
  } while (ros::ok() && !is_published_ && pace_.untilDue(steadyNow()) > 0);
}

/// Publishes the tick that is on its way, so that nothing moves after a pause.
void SimNode::setPaused(bool is_paused) {
  outputs_.serveNewSubscribers();
  publishTick();
  if (is_paused) outputs_.publishRest();
  paused_ = is_paused;
  outputs_.setPaused(is_paused);
  diagnostics_.setPaused(is_paused);
  if (is_paused && !options_.publish_clock)
    ROS_WARN(
        "paused without /clock: the stamps of other nodes run ahead of this simulation's time; "
        "set /use_sim_time to pause, step or change the pace");
}

bool SimNode::pause(std_srvs::SetBool::Request& request, std_srvs::SetBool::Response& response) {
  setPaused(request.data);
  response.success = true;
  response.message = paused_ ? "paused" : "running";
  return true;
}

bool SimNode::step(Step::Request& request, Step::Response& response) {
  if (!paused_) {
    response.message = "the simulation is running; pause it first";
  } else if (request.ticks < 1 || request.ticks > kMaxSteps) {
    response.message = std::to_string(request.ticks) + " ticks; allowed are 1 to 1000000";
  } else {
    for (std::uint32_t i = 0; i < request.ticks && ros::ok(); ++i) {
      runTick();
      publishTick();
    }
    outputs_.publishRest();
    response.success = true;
    response.states = toStates(simulator_, options_.world_frame, time_.at(simulator_.tick()));
  }
  return true;
}

bool SimNode::reset(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
  publishTick();
  outputs_.serveNewSubscribers();
  simulator_.reset();
  diagnostics_.reset();
  frozen_told_ = 0;
  is_published_ = false;
  publishTick();
  outputs_.publishRest();
  response.success = true;
  response.message = "initial state; time goes on";
  return true;
}

bool SimNode::switchEffect(SwitchEffect::Request& request, SwitchEffect::Response& response) {
  const std::string effect = request.effect, state = request.active ? "on" : "off";
  bool is_new = false;
  try {
    is_new = simulator_.switchEffect(effect, request.active);
  } catch (const std::invalid_argument& error) {
    response.message = error.what();
    return true;
  }
  response.success = true;
  response.message = summary(simulator_.scene());
  if (!is_new) {
    response.message = effect + " is " + state + " already: " + response.message;
    return true;
  }
  ROS_INFO("%s is switched %s from tick %ld on: %s", effect.c_str(), state.c_str(),
           static_cast<long>(simulator_.tick()), response.message.c_str());
  const std::vector<std::string>& warnings = simulator_.scene().warnings;
  for (std::size_t i = start_warnings_; i < warnings.size(); ++i) {
    ROS_WARN("%s", warnings[i].c_str());
    response.message += "; " + warnings[i];
  }
  return true;
}

}  // namespace rigid_body_sim

#pragma once

#include <rigid_body_sim/Step.h>
#include <rigid_body_sim/SwitchEffect.h>
#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <std_srvs/SetBool.h>
#include <std_srvs/Trigger.h>

#include "node/diagnostics.hpp"
#include "node/inputs.hpp"
#include "node/outputs.hpp"
#include "node/pace.hpp"

namespace rigid_body_sim {

/// The loop, and the services that steer it.
///
/// One thread owns everything: it steps, then runs the callbacks of its queue until the tick is
/// due, then publishes. So an input that arrives during tick k acts from tick k + 1, however
/// threads and sockets are timed; one that arrives while the simulation is paused acts in the next
/// tick.
class SimNode {
 public:
  /// @param nh takes its callbacks from `queue`
  /// @throws std::invalid_argument as Simulator, also when ROS is shut down meanwhile
  SimNode(ros::NodeHandle& nh, ros::NodeHandle& private_nh, ros::CallbackQueue& queue, Scene scene,
          const NodeOptions& options);

  /// Until ROS is shut down.
  void run();

  /// With what the simulator has made of it: methods and warnings.
  const Scene& scene() const { return simulator_.scene(); }

 private:
  void runTick();
  void tellFrozen();
  void tellAccuracy();
  void tellBill(const AccuracyState& state);
  void publishTick();
  void waitUntilDue();
  void setPaused(bool is_paused);

  bool pause(std_srvs::SetBool::Request& request, std_srvs::SetBool::Response& response);
  bool step(Step::Request& request, Step::Response& response);
  bool reset(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);
  bool switchEffect(SwitchEffect::Request& request, SwitchEffect::Response& response);

  ros::CallbackQueue& queue_;
  Simulator simulator_;
  SimTime time_;
  NodeOptions options_;
  Pace pace_;
  Inputs inputs_;
  Outputs outputs_;
  Diagnostics diagnostics_;
  std::vector<ros::ServiceServer> services_;
  bool paused_;
  std::size_t start_warnings_;  // how many of the scene's are no switch's
  bool is_published_ = false;   // the state of the simulator's tick
  std::size_t frozen_told_ = 0;
  int bills_told_ = 0;
  bool is_breach_told_ = false;  // by the present methods
  bool is_loss_told_ = false;
};

}  // namespace rigid_body_sim

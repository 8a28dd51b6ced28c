#pragma once

#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <tf2_ros/static_transform_broadcaster.h>

#include <functional>
#include <string>
#include <vector>

#include "node/options.hpp"
#include "node/send_gate.hpp"
#include "node/sim_time.hpp"
#include "rigid_body_sim/simulator.hpp"

namespace rigid_body_sim {

/// The publishers. One message a topic and tick, all bodies in one TFMessage.
///
/// Nothing is sent while the simulation is paused, but whoever subscribes then gets the state at
/// once. That is not left to latching: roscpp sends a latched message twice to a subscriber that
/// comes while it is on its way (3.5 % of 200), and tf2 complains of the repeated stamp.
class Outputs {
 public:
  Outputs(ros::NodeHandle nh, const Simulator& simulator, const SimTime& time,
          const NodeOptions& options);

  /// The state of the simulator's tick: /clock first, then everything stamped with it.
  void publish();

  /// What the accuracy costs, if the scene asks for one.
  void publishBill();

  /// Whether the state stands still, so that new subscribers are to be told of it.
  void setPaused(bool is_paused) { is_paused_ = is_paused; }

  /// Tells those who subscribed since the last call, and have got nothing yet, if paused.
  void serveNewSubscribers();

 private:
  template <class Message>
  ros::Publisher advertise(const std::string& topic, std::function<Message()> make);
  ros::Time stamp() const { return time_.at(simulator_.tick()); }

  ros::CallbackQueue connections_;  // outlives the publishers, whose subscribers it tells of
  ros::NodeHandle nh_;
  const Simulator& simulator_;
  SimTime time_;
  NodeOptions options_;
  bool is_paused_ = false;
  tf2_ros::StaticTransformBroadcaster static_broadcaster_;
  ros::Publisher clock_;
  ros::Publisher tf_;
  ros::Publisher states_;
  ros::Publisher import_report_;
  ros::Publisher accuracy_bill_;
  std::vector<ros::Publisher> twists_;  // of each body
  std::vector<ros::Publisher> odoms_;
  std::vector<ros::Publisher> applied_wrenches_;
  ros::Publisher effect_wrenches_;
  SendGate gate_;
};

}  // namespace rigid_body_sim

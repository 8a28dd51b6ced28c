#pragma once

#include <ros/ros.h>
#include <tf2_ros/static_transform_broadcaster.h>

#include <vector>

#include "node/options.hpp"
#include "node/send_gate.hpp"
#include "node/sim_time.hpp"
#include "rigid_body_sim/simulator.hpp"

namespace rigid_body_sim {

/// The publishers. One message a topic and tick, all bodies in one TFMessage.
///
/// /clock, /tf and states are latched, so that a subscriber that comes while the simulation is
/// paused sees it at once; that spares sending any stamp twice.
class Outputs {
 public:
  Outputs(ros::NodeHandle& nh, const Simulator& simulator, const SimTime& time,
          const NodeOptions& options);

  /// The state of the simulator's tick: /clock first, then everything stamped with it.
  void publish();

 private:
  const Simulator& simulator_;
  SimTime time_;
  NodeOptions options_;
  tf2_ros::StaticTransformBroadcaster static_broadcaster_;
  ros::Publisher clock_;
  ros::Publisher tf_;
  ros::Publisher states_;
  ros::Publisher import_report_;
  std::vector<ros::Publisher> twists_;  // of each body
  std::vector<ros::Publisher> odoms_;
  SendGate gate_;
};

}  // namespace rigid_body_sim

#pragma once

#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <rosgraph_msgs/Clock.h>
#include <tf2_ros/static_transform_broadcaster.h>

#include <functional>
#include <string>
#include <vector>

#include "node/options.hpp"
#include "node/send_gate.hpp"
#include "node/sim_time.hpp"
#include "node/tick_messages.hpp"
#include "node/topic.hpp"

namespace rigid_body_sim {

/// The publishers. One message a topic and tick, all bodies in one TFMessage; for topics without
/// subscribers nothing is worked out.
///
/// Nothing is sent while the simulation is paused, but whoever subscribes then gets the state at
/// once. That is not left to latching: roscpp sends a latched message twice to a subscriber that
/// comes while it is on its way (3.5 % of 200), and tf2 complains of the repeated stamp.
class Outputs {
 public:
  Outputs(ros::NodeHandle nh, const Simulator& simulator, const SimTime& time,
          const NodeOptions& options);

  /// The state of the simulator's tick: /clock first, then everything stamped with it that is due.
  void publish() { publish(false); }

  /// What was not due at this tick, as the state will stand still or jump.
  void publishRest() { publish(true); }

  /// What the accuracy costs, if the scene asks for one.
  void publishBill();

  /// Whether the state stands still, so that new subscribers are to be told of it.
  void setPaused(bool is_paused) { is_paused_ = is_paused; }

  /// Tells those who subscribed since the last call, and have got nothing yet, if paused.
  void serveNewSubscribers();

 private:
  /// The topics of one kind of all bodies.
  template <class Message>
  struct BodyTopics {
    Rate rate;
    std::vector<Topic<Message>> topics;  // of each body; none if never due
    std::vector<Eigen::Index> wanted;    // those with subscribers
  };

  template <class Message>
  Topic<Message> advertise(const std::string& topic, std::function<Message()> make);
  template <class Message>
  void advertise(BodyTopics<Message>& kind, const std::string& name,
                 std::function<Message(Eigen::Index)> make);
  void advertiseLatched();
  template <class Message, class Make>
  bool publish(BodyTopics<Message>& kind, bool now, Make make);
  void publish(bool now);
  void lookForSubscribers();
  ros::Time stamp() const { return time_.at(simulator_.tick()); }

  ros::CallbackQueue connections_;  // outlives the publishers, whose subscribers it tells of
  ros::NodeHandle nh_;
  const Simulator& simulator_;
  SimTime time_;
  NodeOptions options_;
  TickMessages messages_;
  bool is_paused_ = false;
  bool subscribers_changed_ = true;
  tf2_ros::StaticTransformBroadcaster static_broadcaster_;
  Rate clock_rate_, tf_rate_, states_rate_, effect_wrenches_rate_;
  Topic<rosgraph_msgs::Clock> clock_;
  Topic<tf2_msgs::TFMessage> tf_;
  Topic<BodyStates> states_;
  Topic<EffectWrenches> effect_wrenches_;
  ros::Publisher import_report_;
  ros::Publisher accuracy_bill_;
  BodyTopics<geometry_msgs::TwistStamped> twists_;
  BodyTopics<nav_msgs::Odometry> odoms_;
  BodyTopics<geometry_msgs::WrenchStamped> applied_wrenches_;
  SendGate gate_;
};

}  // namespace rigid_body_sim

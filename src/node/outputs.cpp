#include "node/outputs.hpp"

#include <ros/publication.h>
#include <ros/topic_manager.h>
#include <rosgraph_msgs/Clock.h>
#include <std_msgs/String.h>

#include "node/conversions.hpp"
#include "node/names.hpp"

namespace rigid_body_sim {
namespace {

constexpr std::uint32_t kQueueSize = 100;  // two seconds at 50 Hz

rosgraph_msgs::Clock toClock(const ros::Time& stamp) {
  rosgraph_msgs::Clock clock;
  clock.clock = stamp;
  return clock;
}

/// Whether anything was sent to the subscriber, by roscpp's own count. One that came while a tick
/// waited to be sent has got it with all others; one that came later has not.
bool hasGotSomething(const ros::SingleSubscriberPublisher& subscriber) {
  const auto publication = ros::TopicManager::instance()->lookupPublication(subscriber.getTopic());
  if (!publication) return true;
  XmlRpc::XmlRpcValue links, counts = publication->getStats()[1];  // id, bytes, data, messages, 0
  links.setSize(0);
  publication->getInfo(links);  // id, subscriber, ...
  for (int i = 0; i < links.size(); ++i) {
    if (static_cast<std::string>(links[i][1]) != subscriber.getSubscriberName()) continue;
    for (int k = 0; k < counts.size(); ++k)
      if (counts[k][0] == links[i][0] && static_cast<int>(counts[k][3]) == 0) return false;
  }
  return true;
}

}  // namespace

Outputs::Outputs(ros::NodeHandle nh, const Simulator& simulator, const SimTime& time,
                 const NodeOptions& options)
    : nh_(nh), simulator_(simulator), time_(time), options_(options) {
  nh_.setCallbackQueue(&connections_);
  if (options_.publish_clock)
    clock_ = advertise<rosgraph_msgs::Clock>(names::kClock, [this] { return toClock(stamp()); });
  tf_ = advertise<tf2_msgs::TFMessage>(
      names::kTf, [this] { return toTf(simulator_, options_.world_frame, stamp()); });
  states_ = advertise<BodyStates>(
      names::kStates, [this] { return toStates(simulator_, options_.world_frame, stamp()); });
  effect_wrenches_ = advertise<EffectWrenches>(names::kEffectWrenches, [this] {
    return toEffectWrenches(simulator_, options_.world_frame, stamp());
  });
  for (Eigen::Index i = 0; i < simulator.bodies().count(); ++i) {
    const std::string body = simulator.scene().bodies[i].name + "/";
    twists_.push_back(advertise<geometry_msgs::TwistStamped>(
        body + names::kTwist, [this, i] { return toTwist(simulator_, i, stamp()); }));
    odoms_.push_back(advertise<nav_msgs::Odometry>(body + names::kOdom, [this, i] {
      return toOdometry(simulator_, i, options_.world_frame, stamp());
    }));
    applied_wrenches_.push_back(advertise<geometry_msgs::WrenchStamped>(
        body + names::kAppliedWrench,
        [this, i] { return toAppliedWrench(simulator_, i, stamp()); }));
  }
  const bool is_latched = true;
  import_report_ = nh_.advertise<std_msgs::String>(names::kImportReport, 1, is_latched);
  std_msgs::String report;
  report.data = simulator.scene().import_report;
  import_report_.publish(report);
  if (simulator.accuracy()) {
    accuracy_bill_ = nh_.advertise<std_msgs::String>(names::kAccuracyBill, 1, is_latched);
    publishBill();
  }
  static_broadcaster_.sendTransform(toStaticTf(simulator, options.publish_link_frames, stamp()));
}

template <class Message>
ros::Publisher Outputs::advertise(const std::string& topic, std::function<Message()> make) {
  return nh_.advertise<Message>(topic, kQueueSize,
                                [this, make](const ros::SingleSubscriberPublisher& subscriber) {
                                  if (is_paused_ && !hasGotSomething(subscriber))
                                    subscriber.publish(make());
                                });
}

void Outputs::serveNewSubscribers() {
  if (connections_.isEmpty()) return;
  if (is_paused_) gate_.drain();
  connections_.callAvailable(ros::WallDuration(0));
}

void Outputs::publishBill() {
  std_msgs::String bill;
  bill.data = toText(simulator_.accuracy()->bill, simulator_.scene());
  accuracy_bill_.publish(bill);
}

void Outputs::publish() {
  if (options_.publish_clock) clock_.publish(toClock(stamp()));
  tf_.publish(toTf(simulator_, options_.world_frame, stamp()));
  states_.publish(toStates(simulator_, options_.world_frame, stamp()));
  if (effect_wrenches_.getNumSubscribers() > 0)
    effect_wrenches_.publish(toEffectWrenches(simulator_, options_.world_frame, stamp()));
  for (Eigen::Index i = 0; i < simulator_.bodies().count(); ++i) {
    if (twists_[i].getNumSubscribers() > 0) twists_[i].publish(toTwist(simulator_, i, stamp()));
    if (odoms_[i].getNumSubscribers() > 0)
      odoms_[i].publish(toOdometry(simulator_, i, options_.world_frame, stamp()));
    if (applied_wrenches_[i].getNumSubscribers() > 0)
      applied_wrenches_[i].publish(toAppliedWrench(simulator_, i, stamp()));
  }
  gate_.pass();
}

}  // namespace rigid_body_sim

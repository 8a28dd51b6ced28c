#include "node/outputs.hpp"

#include <rosgraph_msgs/Clock.h>
#include <std_msgs/String.h>

#include "node/conversions.hpp"
#include "node/names.hpp"

namespace rigid_body_sim {
namespace {

constexpr std::uint32_t kQueueSize = 100;  // two seconds at 50 Hz
constexpr bool kLatched = true;

}  // namespace

Outputs::Outputs(ros::NodeHandle& nh, const Simulator& simulator, const SimTime& time,
                 const NodeOptions& options)
    : simulator_(simulator), time_(time), options_(options) {
  if (options_.publish_clock)
    clock_ = nh.advertise<rosgraph_msgs::Clock>(names::kClock, kQueueSize, kLatched);
  tf_ = nh.advertise<tf2_msgs::TFMessage>(names::kTf, kQueueSize, kLatched);
  states_ = nh.advertise<BodyStates>(names::kStates, kQueueSize, kLatched);
  for (const SceneBody& body : simulator.scene().bodies) {
    twists_.push_back(
        nh.advertise<geometry_msgs::TwistStamped>(body.name + "/" + names::kTwist, kQueueSize));
    odoms_.push_back(nh.advertise<nav_msgs::Odometry>(body.name + "/" + names::kOdom, kQueueSize));
  }
  import_report_ = nh.advertise<std_msgs::String>(names::kImportReport, 1, kLatched);
  std_msgs::String report;
  report.data = simulator.scene().import_report;
  import_report_.publish(report);
  static_broadcaster_.sendTransform(
      toStaticTf(simulator, options.publish_link_frames, time.at(simulator.tick())));
}

void Outputs::publish() {
  const ros::Time stamp = time_.at(simulator_.tick());
  if (options_.publish_clock) {
    rosgraph_msgs::Clock clock;
    clock.clock = stamp;
    clock_.publish(clock);
  }
  tf_.publish(toTf(simulator_, options_.world_frame, stamp));
  states_.publish(toStates(simulator_, options_.world_frame, stamp));
  for (Eigen::Index i = 0; i < simulator_.bodies().count(); ++i) {
    if (twists_[i].getNumSubscribers() > 0) twists_[i].publish(toTwist(simulator_, i, stamp));
    if (odoms_[i].getNumSubscribers() > 0)
      odoms_[i].publish(toOdometry(simulator_, i, options_.world_frame, stamp));
  }
  gate_.pass();
}

}  // namespace rigid_body_sim

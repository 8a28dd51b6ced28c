// An example of a node that compares simulators: each rung of ladder.launch flies the same body
// with an integrator of its own, and this node
//   lets all of them go at once, as each starts paused
//   puts them side by side on /tf, in step: always states of the same time
//   says over each what its steps cost and how far it is off the last rung, the exact one
// A rung's frames are `<rung>/<frame>`; `<rung>/true/<frame>` is where the last rung has the body.

#include <geometry_msgs/TransformStamped.h>
#include <rigid_body_sim/BodyStates.h>
#include <ros/ros.h>
#include <std_srvs/SetBool.h>
#include <tf2_msgs/TFMessage.h>
#include <tf2_ros/static_transform_broadcaster.h>
#include <tf2_ros/transform_broadcaster.h>
#include <visualization_msgs/MarkerArray.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <string>
#include <vector>

#include "rigid_body_sim/integrator.hpp"
#include "rigid_body_sim/rotation.hpp"

namespace {

using geometry_msgs::TransformStamped;
using rigid_body_sim::BodyStates;
using visualization_msgs::Marker;

constexpr double kGap = 0.66;              // [m] between two rungs, along y
constexpr double kLabelHeight = 1.50;      // [m] of the names
constexpr double kTitleHeight = 1.84;      // [m]
constexpr std::size_t kMaxWaiting = 2000;  // ticks of which a rung is still missing

struct Color {
  float r, g, b;
};
constexpr Color kWhite{1, 1, 1}, kGrey{0.72f, 0.76f, 0.82f};
constexpr Color kGood{0.45f, 0.95f, 0.45f}, kFair{1, 0.85f, 0.3f}, kBad{1, 0.45f, 0.4f};

// Half a degree is hardly seen; ten are at once.
Color colorOf(double error) {
  if (error < 0.5 * M_PI / 180) return kGood;
  return error < 10 * M_PI / 180 ? kFair : kBad;
}

std::string print(const char* format, double number) {
  char text[64];
  std::snprintf(text, sizeof(text), format, number);
  return text;
}

std::string inWords(double error) {
  const double degrees = error * 180 / M_PI;
  if (degrees >= 10) return print("%.0f deg off", degrees);
  return degrees >= 0.1 ? print("%.1f deg off", degrees) : print("%.0e deg off", degrees);
}

struct Rung {
  std::string name;
  double y;                     // [m] where it is shown
  double price;                 // of a step, in those of semi-implicit Euler
  double error = 0, worst = 0;  // [rad] now, and the largest so far
};

Eigen::Quaterniond toEigen(const geometry_msgs::Quaternion& q) { return {q.w, q.x, q.y, q.z}; }

class LadderLabels {
 public:
  LadderLabels() {
    std::vector<std::string> names;
    ros::NodeHandle("~").getParam("rungs", names);
    if (names.size() < 2) throw std::invalid_argument("~rungs: two integrators at least");
    for (const std::string& name : names) {
      const double k = static_cast<double>(rungs_.size()) - 0.5 * (names.size() - 1.0);
      rungs_.push_back({name, k * kGap, rigid_body_sim::integratorNamed(name).cost});
    }
    marker_pub_ = nh_.advertise<visualization_msgs::MarkerArray>("ladder/labels", 1);
    for (std::size_t i = 0; i < rungs_.size(); ++i)
      subscribers_.push_back(nh_.subscribe<BodyStates>(
          rungs_[i].name + "/states", 1000,
          [this, i](const BodyStates::ConstPtr& states) { onStates(i, states); }));
    subscribers_.push_back(
        nh_.subscribe(rungs_.back().name + "/tf_static", 10, &LadderLabels::onStaticFrames, this));
    draw_timer_ = nh_.createWallTimer(ros::WallDuration(0.1), &LadderLabels::draw, this);
  }

 private:
  using Row = std::vector<BodyStates::ConstPtr>;  // of one time, one a rung

  void onStates(std::size_t rung, const BodyStates::ConstPtr& states) {
    Row& row = waiting_[states->header.stamp];
    row.resize(rungs_.size());
    row[rung] = states;
    const auto is_there = [](const auto& one) { return one != nullptr; };
    if (std::all_of(row.begin(), row.end(), is_there)) {
      show(row);
      waiting_.erase(waiting_.begin(), waiting_.upper_bound(states->header.stamp));
    }
    while (waiting_.size() > kMaxWaiting) waiting_.erase(waiting_.begin());
  }

  // States of one time.
  void show(const Row& row) {
    if (start_.isZero()) start_ = row.back()->header.stamp;
    now_ = row.back()->header.stamp;
    world_ = row.back()->header.frame_id;
    const geometry_msgs::Pose& truth = row.back()->poses.at(0);
    std::vector<TransformStamped> transforms;
    for (std::size_t i = 0; i < rungs_.size(); ++i) {
      Rung& rung = rungs_[i];
      const geometry_msgs::Pose& pose = row[i]->poses.at(0);
      rung.error = angleBetween(pose, truth);
      rung.worst = std::max(rung.worst, rung.error);
      transforms.push_back(transform(rung, rung.name, row[i]->names.at(0), pose));
      transforms.push_back(transform(rung, rung.name + "/true", row[i]->names.at(0), truth));
    }
    broadcaster_.sendTransform(transforms);
    if (is_started_) return;
    is_started_ = true;
    for (const Rung& rung : rungs_) go(rung.name);
  }

  static double angleBetween(const geometry_msgs::Pose& a, const geometry_msgs::Pose& b) {
    return rigid_body_sim::rotationLog(toEigen(a.orientation).conjugate() * toEigen(b.orientation))
        .norm();
  }

  TransformStamped transform(const Rung& rung, const std::string& prefix, const std::string& body,
                             const geometry_msgs::Pose& pose) const {
    TransformStamped msg;
    msg.header.stamp = now_;
    msg.header.frame_id = world_;
    msg.child_frame_id = prefix + "/" + body;
    msg.transform.translation.x = pose.position.x;
    msg.transform.translation.y = pose.position.y + rung.y;
    msg.transform.translation.z = pose.position.z;
    msg.transform.rotation = pose.orientation;
    return msg;
  }

  // The frames that are fixed to the body, once for every place where it is shown.
  void onStaticFrames(const tf2_msgs::TFMessage& frames) {
    std::vector<TransformStamped> transforms;
    for (const Rung& rung : rungs_) {
      for (const std::string& prefix : {rung.name + "/", rung.name + "/true/"}) {
        for (TransformStamped one : frames.transforms) {
          one.header.frame_id = prefix + one.header.frame_id;
          one.child_frame_id = prefix + one.child_frame_id;
          transforms.push_back(one);
        }
      }
    }
    static_broadcaster_.sendTransform(transforms);
  }

  static void go(const std::string& rung) {
    std_srvs::SetBool is_paused;
    is_paused.request.data = false;
    if (!ros::service::call(rung + "/rigid_body_sim/pause", is_paused))
      ROS_ERROR("%s cannot be started", rung.c_str());
  }

  void draw(const ros::WallTimerEvent&) {
    if (start_.isZero()) return;
    markers_.markers.clear();
    addText("title", 0, kTitleHeight, 0.105, kWhite,
            "One T-handle, five integrators, " + print("%.0f s flown", (now_ - start_).toSec()));
    addText("title", 0, kTitleHeight - 0.13, 0.065, kGrey,
            "solid: as each has it; faint: where it truly is. Price: a step's time, in those of "
            "semi-implicit Euler");
    for (const Rung& rung : rungs_) {
      addText("name", rung.y, kLabelHeight, 0.095, kWhite, rung.name);
      addText("price", rung.y, kLabelHeight - 0.115, 0.07, kGrey, print("price %.2g", rung.price));
      const bool is_truth = &rung == &rungs_.back();
      addText("error", rung.y, kLabelHeight - 0.215, 0.075, colorOf(rung.error),
              is_truth ? "exact to rounding" : inWords(rung.error));
      addText("worst", rung.y, kLabelHeight - 0.305, 0.06, kGrey,
              is_truth ? "the others' measure" : "at worst " + inWords(rung.worst));
    }
    marker_pub_.publish(markers_);
  }

  void addText(const std::string& ns, double y, double z, double height, const Color& color,
               const std::string& text) {
    Marker marker;
    marker.header.frame_id = world_;
    marker.ns = ns;
    marker.id = static_cast<int>(markers_.markers.size());
    marker.type = Marker::TEXT_VIEW_FACING;
    marker.pose.position.y = y;
    marker.pose.position.z = z;
    marker.pose.orientation.w = 1;
    marker.scale.z = height;
    marker.color.r = color.r, marker.color.g = color.g, marker.color.b = color.b;
    marker.color.a = 1;
    marker.text = text;
    markers_.markers.push_back(marker);
  }

  ros::NodeHandle nh_;
  std::vector<Rung> rungs_;
  std::vector<ros::Subscriber> subscribers_;
  ros::Publisher marker_pub_;
  tf2_ros::TransformBroadcaster broadcaster_;
  tf2_ros::StaticTransformBroadcaster static_broadcaster_;
  ros::WallTimer draw_timer_;
  std::map<ros::Time, Row> waiting_;  // until every rung has got there
  ros::Time start_, now_;
  std::string world_;
  bool is_started_ = false;
  visualization_msgs::MarkerArray markers_;
};

}  // namespace

int main(int argc, char** argv) try {
  ros::init(argc, argv, "ladder_labels");
  LadderLabels labels;
  ros::spin();
} catch (const std::invalid_argument& error) {
  ROS_FATAL("%s", error.what());
  return 1;
}

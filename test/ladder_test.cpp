// ladder.launch: five simulators in step, side by side on /tf, and what is said over each.

#include <tf2_msgs/TFMessage.h>
#include <visualization_msgs/MarkerArray.h>

#include <algorithm>
#include <set>

#include "generic.hpp"
#include "rigid_body_sim/trajectory.hpp"
#include "ros_fixture.hpp"

namespace rigid_body_sim {
namespace {

constexpr int kTicks = 500;  // 20 s
const std::vector<std::string> kRungs = {"semi_implicit", "split2", "rk4", "rk8", "exact"};

using Frames = std::map<std::string, geometry_msgs::Transform>;  // by child frame

Quaterniond attitudeOf(const geometry_msgs::Transform& transform) {
  const auto& q = transform.rotation;
  return Quaterniond(q.w, q.x, q.y, q.z);
}

/// What the demo sends, from its start.
class Ladder : public testing::Test {
 protected:
  struct Heard {
    ros::NodeHandle nh;
    std::map<ros::Time, Frames> frames;
    std::set<std::string> fixed_frames;
    visualization_msgs::MarkerArray labels;
    std::vector<ros::Subscriber> subscribers;
  };

  static void SetUpTestSuite() {
    heard_ = new Heard;
    auto& nh = heard_->nh;
    heard_->subscribers = {nh.subscribe("/tf", 1000, hearFrames),
                           nh.subscribe("/tf_static", 10, hearFixedFrames),
                           nh.subscribe("ladder/labels", 10, hearLabels)};
    const auto has_flown = [] { return heard_->frames.count(stampOf(kTicks)) == 1; };
    need("20 s of flight", has_flown, 40);
    need("labels", [] { return !heard_->labels.markers.empty(); });
  }
  static void TearDownTestSuite() {
    delete heard_;
    heard_ = nullptr;
  }

  static void hearFrames(const tf2_msgs::TFMessage::ConstPtr& tf) {
    for (const auto& one : tf->transforms)
      heard_->frames[one.header.stamp][one.child_frame_id] = one.transform;
  }
  static void hearFixedFrames(const tf2_msgs::TFMessage::ConstPtr& tf) {
    for (const auto& one : tf->transforms) heard_->fixed_frames.insert(one.child_frame_id);
  }
  static void hearLabels(const visualization_msgs::MarkerArray::ConstPtr& labels) {
    heard_->labels = *labels;
  }

  static ros::Time stampOf(int tick) { return ros::Time(1 + tick / 25, tick % 25 * 40'000'000); }

  /// Angle from the truth, as /tf has it.
  static double errorOf(const std::string& rung, int tick) {
    const Frames& frames = heard_->frames.at(stampOf(tick));
    return angleBetween(attitudeOf(frames.at(rung + "/t_handle")),
                        attitudeOf(frames.at(rung + "/true/t_handle")));
  }

  static Heard* heard_;
};

Ladder::Heard* Ladder::heard_ = nullptr;

TEST_F(Ladder, ShowsTheRungsInStepAndSideBySide) {
  for (const auto& [stamp, frames] : heard_->frames) {
    ASSERT_EQ(frames.size(), 2 * kRungs.size()) << stamp;
    double y = -kInf;
    for (const std::string& rung : kRungs) {
      ASSERT_EQ(frames.count(rung + "/t_handle"), 1u);
      EXPECT_GT(frames.at(rung + "/true/t_handle").translation.y, y + 0.4);
      y = frames.at(rung + "/true/t_handle").translation.y;
    }
  }
  for (const std::string& rung : kRungs)
    for (const char* frame : {"/t_handle_stem", "/true/t_handle_stem"})
      EXPECT_TRUE(waitFor([&] { return heard_->fixed_frames.count(rung + frame) == 1; }));
}

TEST_F(Ladder, EachRungErrsAsItDoesWithoutRos) {
  const Scene scene = readSceneFile(PACKAGE_DIR "/config/ladder.yaml");
  const Trajectory truth = fly(scene, {"exact"}, kTicks, kTicks);
  for (const std::string& rung : kRungs) {
    const Trajectory flown = fly(scene, {rung}, kTicks, kTicks);
    const double expected = deviation(flown, truth).attitude_rad;
    // The messages hold the link's attitude: a few roundings more.
    EXPECT_NEAR(errorOf(rung, kTicks), expected, 1e-14) << rung;
  }
}

TEST_F(Ladder, ErrorsAreInTheOrderOfTheRungs) {
  std::vector<double> worst(kRungs.size(), 0);
  for (int tick = 0; tick <= kTicks; tick += 20) {
    if (heard_->frames.count(stampOf(tick)) == 0) continue;  // before this test was there
    for (std::size_t i = 0; i < kRungs.size(); ++i)
      worst[i] = std::max(worst[i], errorOf(kRungs[i], tick));
  }
  for (std::size_t i = 0; i + 1 < worst.size(); ++i) EXPECT_GT(worst[i], 2 * worst[i + 1]) << i;
  EXPECT_EQ(worst.back(), 0);
  EXPECT_GT(worst.front(), 1);
  EXPECT_GT(worst[1], 1e-2);  // to be seen
}

TEST_F(Ladder, LabelsSayThePriceAndTheError) {
  std::string all;
  for (const auto& marker : heard_->labels.markers) all += marker.text + "\n";
  EXPECT_TRUE(contains(all, {"One T-handle, five integrators, ", " s flown", " deg off"}));
  for (const std::string& rung : kRungs) EXPECT_TRUE(contains(all, {"\n" + rung + "\nprice "}));
}

}  // namespace
}  // namespace rigid_body_sim

int main(int argc, char** argv) { return rigid_body_sim::runRostest(argc, argv, "ladder_test"); }

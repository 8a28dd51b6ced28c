#pragma once

#include <string>
#include <vector>

#include "node/conversions.hpp"

namespace rigid_body_sim {

/// The messages of a tick, each kept for the next one: names and frames are written once, a tick
/// writes numbers and allocates nothing. Nothing is worked out before it is asked for, nor twice a
/// tick: motions are shared by tf, states, odometry and twists.
class TickMessages {
 public:
  /// @param simulator outlives this
  TickMessages(const Simulator& simulator, const std::string& world_frame);

  /// What is asked for from now on is of the simulator's present state.
  void begin(const ros::Time& stamp);

  // Each is valid until it is asked for again, of whatever body.
  const tf2_msgs::TFMessage& tf();
  const BodyStates& states();
  const nav_msgs::Odometry& odometry(Eigen::Index body);
  const geometry_msgs::TwistStamped& twist(Eigen::Index body);
  const geometry_msgs::WrenchStamped& appliedWrench(Eigen::Index body);
  const EffectWrenches& effectWrenches();

 private:
  const std::vector<LinkMotion>& motions();
  const std::vector<WrenchesOfEffect>& effects();

  const Simulator& simulator_;
  ros::Time stamp_;
  bool has_motions_ = false;
  bool has_effects_ = false;
  std::vector<LinkMotion> motions_;
  std::vector<WrenchesOfEffect> effects_;
  std::vector<std::string> com_frames_;
  tf2_msgs::TFMessage tf_;
  BodyStates states_;
  nav_msgs::Odometry odometry_;
  geometry_msgs::TwistStamped twist_;
  geometry_msgs::WrenchStamped applied_wrench_;
  EffectWrenches effect_wrenches_;
};

}  // namespace rigid_body_sim

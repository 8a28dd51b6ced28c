#include "node/tick_messages.hpp"

namespace rigid_body_sim {

TickMessages::TickMessages(const Simulator& simulator, const std::string& world_frame)
    : simulator_(simulator),
      motions_(simulator.scene().bodies.size()),
      tf_(toTf(simulator, world_frame, {})),
      states_(toStates(simulator, world_frame, {})) {
  odometry_.header.frame_id = world_frame;
  effect_wrenches_.header.frame_id = world_frame;
  effect_wrenches_.names = states_.names;
  for (const std::string& name : states_.names) com_frames_.push_back(comFrameName(name));
  // Room for the longest name at once.
  for (const std::string& frame : com_frames_) applied_wrench_.header.frame_id = frame;
  for (const std::string& name : states_.names)
    odometry_.child_frame_id = twist_.header.frame_id = name;
}

void TickMessages::begin(const ros::Time& stamp) {
  stamp_ = stamp;
  has_motions_ = has_effects_ = false;
}

const std::vector<LinkMotion>& TickMessages::motions() {
  if (!has_motions_)
    for (std::size_t i = 0; i < motions_.size(); ++i)
      motions_[i] = simulator_.linkMotion(static_cast<Eigen::Index>(i));
  has_motions_ = true;
  return motions_;
}

const std::vector<WrenchesOfEffect>& TickMessages::effects() {
  if (!has_effects_) effects_ = simulator_.effectWrenches();
  has_effects_ = true;
  return effects_;
}

const tf2_msgs::TFMessage& TickMessages::tf() {
  const std::vector<LinkMotion>& all = motions();
  for (std::size_t i = 0; i < all.size(); ++i) write(all[i], stamp_, tf_.transforms[i]);
  return tf_;
}

const BodyStates& TickMessages::states() {
  states_.header.stamp = stamp_;
  states_.tick = static_cast<std::uint64_t>(simulator_.tick());
  const std::vector<LinkMotion>& all = motions();
  for (std::size_t i = 0; i < all.size(); ++i) {
    states_.poses[i] = poseOf(all[i]);
    states_.twists[i] = twistOf(all[i]);
  }
  return states_;
}

const nav_msgs::Odometry& TickMessages::odometry(Eigen::Index body) {
  odometry_.child_frame_id = states_.names[body];
  write(motions()[body], stamp_, odometry_);
  return odometry_;
}

const geometry_msgs::TwistStamped& TickMessages::twist(Eigen::Index body) {
  twist_.header.frame_id = states_.names[body];
  write(motions()[body], stamp_, twist_);
  return twist_;
}

const geometry_msgs::WrenchStamped& TickMessages::appliedWrench(Eigen::Index body) {
  // As Simulator::wrenchOn() sums, which would work out all bodies for each.
  Wrench sum;
  for (const WrenchesOfEffect& one : effects()) {
    sum.f_F += one.wrenches.f_W.row(body);
    sum.t_Q_F += one.wrenches.t_Bcm_W.row(body);
  }
  applied_wrench_.header.frame_id = com_frames_[body];
  write(sum, simulator_.state(body).q_WB, stamp_, applied_wrench_);
  return applied_wrench_;
}

const EffectWrenches& TickMessages::effectWrenches() {
  effect_wrenches_.header.stamp = stamp_;
  const std::vector<WrenchesOfEffect>& all = effects();
  effect_wrenches_.effects.resize(all.size());
  for (std::size_t i = 0; i < all.size(); ++i) write(all[i], effect_wrenches_.effects[i]);
  return effect_wrenches_;
}

}  // namespace rigid_body_sim

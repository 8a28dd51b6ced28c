#include "node/conversions.hpp"

#include <stdexcept>

namespace rigid_body_sim {

Value toValue(XmlRpc::XmlRpcValue& value) {
  using XmlRpc::XmlRpcValue;
  switch (value.getType()) {
    case XmlRpcValue::TypeInvalid:
      return {};
    case XmlRpcValue::TypeBoolean:
      return {static_cast<bool>(value)};
    case XmlRpcValue::TypeInt:
      return {static_cast<std::int64_t>(static_cast<int>(value))};
    case XmlRpcValue::TypeDouble:
      return {static_cast<double>(value)};
    case XmlRpcValue::TypeString:
      return {static_cast<std::string>(value)};
    case XmlRpcValue::TypeArray: {
      Value::List list;
      for (int i = 0; i < value.size(); ++i) list.push_back(toValue(value[i]));
      return {list};
    }
    case XmlRpcValue::TypeStruct: {
      Value::Map map;
      for (auto& entry : value) map[entry.first] = toValue(entry.second);
      return {map};
    }
    default:
      throw std::invalid_argument("a parameter holds a date or binary data");
  }
}

Vector3d toVector(const geometry_msgs::Vector3& vector) { return {vector.x, vector.y, vector.z}; }
Vector3d toVector(const geometry_msgs::Point& point) { return {point.x, point.y, point.z}; }

geometry_msgs::Vector3 toMessage(const Vector3d& vector) {
  geometry_msgs::Vector3 message;
  message.x = vector.x();
  message.y = vector.y();
  message.z = vector.z();
  return message;
}

geometry_msgs::Quaternion toMessage(const Quaterniond& q) {
  geometry_msgs::Quaternion message;
  message.x = q.x();
  message.y = q.y();
  message.z = q.z();
  message.w = q.w();
  return message;
}

geometry_msgs::Pose poseOf(const LinkMotion& link) {
  geometry_msgs::Pose pose;
  pose.position.x = link.p_WL.x();
  pose.position.y = link.p_WL.y();
  pose.position.z = link.p_WL.z();
  pose.orientation = toMessage(link.q_WL);
  return pose;
}

geometry_msgs::Twist twistOf(const LinkMotion& link) {
  geometry_msgs::Twist twist;
  twist.linear = toMessage(link.v_WL_L);
  twist.angular = toMessage(link.w_WL_L);
  return twist;
}

namespace {

geometry_msgs::Wrench wrenchOf(const Vector3d& force, const Vector3d& torque) {
  geometry_msgs::Wrench wrench;
  wrench.force = toMessage(force);
  wrench.torque = toMessage(torque);
  return wrench;
}

}  // namespace

void write(const LinkMotion& link, const ros::Time& stamp,
           geometry_msgs::TransformStamped& transform) {
  transform.header.stamp = stamp;
  transform.transform.translation = toMessage(link.p_WL);
  transform.transform.rotation = toMessage(link.q_WL);
}

void write(const LinkMotion& link, const ros::Time& stamp, nav_msgs::Odometry& odometry) {
  odometry.header.stamp = stamp;
  odometry.pose.pose = poseOf(link);
  odometry.twist.twist = twistOf(link);
}

void write(const LinkMotion& link, const ros::Time& stamp, geometry_msgs::TwistStamped& twist) {
  twist.header.stamp = stamp;
  twist.twist = twistOf(link);
}

void write(const Wrench& wrench_Bcm_W, const Quaterniond& q_WB, const ros::Time& stamp,
           geometry_msgs::WrenchStamped& wrench) {
  wrench.header.stamp = stamp;
  wrench.wrench =
      wrenchOf(q_WB.conjugate() * wrench_Bcm_W.f_F, q_WB.conjugate() * wrench_Bcm_W.t_Q_F);
}

void write(const WrenchesOfEffect& one, EffectWrench& message) {
  message.effect = one.name;
  message.wrenches.resize(static_cast<std::size_t>(one.wrenches.f_W.rows()));
  for (std::size_t i = 0; i < message.wrenches.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    message.wrenches[i] = wrenchOf(one.wrenches.f_W.row(row), one.wrenches.t_Bcm_W.row(row));
  }
}

tf2_msgs::TFMessage toTf(const Simulator& simulator, const std::string& world_frame,
                         const ros::Time& stamp) {
  tf2_msgs::TFMessage message;
  const std::vector<SceneBody>& bodies = simulator.scene().bodies;
  message.transforms.resize(bodies.size());
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    message.transforms[i].header.frame_id = world_frame;
    message.transforms[i].child_frame_id = bodies[i].name;
    write(simulator.linkMotion(static_cast<Eigen::Index>(i)), stamp, message.transforms[i]);
  }
  return message;
}

std::vector<geometry_msgs::TransformStamped> toStaticTf(const Simulator& simulator,
                                                        bool with_link_frames,
                                                        const ros::Time& stamp) {
  std::vector<geometry_msgs::TransformStamped> transforms;
  const auto add = [&](const std::string& parent, const std::string& child, const Vector3d& p,
                       const Quaterniond& q) {
    geometry_msgs::TransformStamped transform;
    transform.header.stamp = stamp;
    transform.header.frame_id = parent;
    transform.child_frame_id = child;
    transform.transform.translation = toMessage(p);
    transform.transform.rotation = toMessage(q);
    transforms.push_back(transform);
  };
  for (std::size_t i = 0; i < simulator.scene().bodies.size(); ++i) {
    const SceneBody& body = simulator.scene().bodies[i];
    const BodyFrame& B = simulator.bodyFrame(static_cast<Eigen::Index>(i));
    add(body.name, comFrameName(body.name), B.p_LBcm, B.q_LB);
    if (!with_link_frames) continue;
    for (const FixedFrame& frame : body.frames)
      add(body.name, frame.name, frame.X_LF.translation(), Quaterniond(frame.X_LF.linear()));
  }
  return transforms;
}

BodyStates toStates(const Simulator& simulator, const std::string& world_frame,
                    const ros::Time& stamp) {
  BodyStates states;
  states.header.stamp = stamp;
  states.header.frame_id = world_frame;
  states.tick = static_cast<std::uint64_t>(simulator.tick());
  const std::vector<SceneBody>& bodies = simulator.scene().bodies;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const LinkMotion link = simulator.linkMotion(static_cast<Eigen::Index>(i));
    states.names.push_back(bodies[i].name);
    states.poses.push_back(poseOf(link));
    states.twists.push_back(twistOf(link));
  }
  return states;
}

nav_msgs::Odometry toOdometry(const Simulator& simulator, Eigen::Index body,
                              const std::string& world_frame, const ros::Time& stamp) {
  nav_msgs::Odometry odometry;
  odometry.header.frame_id = world_frame;
  odometry.child_frame_id = simulator.scene().bodies[body].name;
  write(simulator.linkMotion(body), stamp, odometry);
  return odometry;
}

EffectWrenches toEffectWrenches(const Simulator& simulator, const std::string& world_frame,
                                const ros::Time& stamp) {
  EffectWrenches message;
  message.header.stamp = stamp;
  message.header.frame_id = world_frame;
  for (const SceneBody& body : simulator.scene().bodies) message.names.push_back(body.name);
  for (const rigid_body_sim::WrenchesOfEffect& one : simulator.effectWrenches()) {
    message.effects.emplace_back();
    write(one, message.effects.back());
  }
  return message;
}

geometry_msgs::WrenchStamped toAppliedWrench(const Simulator& simulator, Eigen::Index body,
                                             const ros::Time& stamp) {
  geometry_msgs::WrenchStamped message;
  message.header.frame_id = comFrameName(simulator.scene().bodies[body].name);
  write(simulator.wrenchOn(body), simulator.state(body).q_WB, stamp, message);
  return message;
}

geometry_msgs::TwistStamped toTwist(const Simulator& simulator, Eigen::Index body,
                                    const ros::Time& stamp) {
  geometry_msgs::TwistStamped twist;
  twist.header.frame_id = simulator.scene().bodies[body].name;
  write(simulator.linkMotion(body), stamp, twist);
  return twist;
}

}  // namespace rigid_body_sim

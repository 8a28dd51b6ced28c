#pragma once

#include <XmlRpcValue.h>
#include <geometry_msgs/TransformStamped.h>
#include <geometry_msgs/TwistStamped.h>
#include <geometry_msgs/WrenchStamped.h>
#include <nav_msgs/Odometry.h>
#include <rigid_body_sim/BodyStates.h>
#include <rigid_body_sim/EffectWrenches.h>
#include <tf2_msgs/TFMessage.h>

#include <string>
#include <vector>

#include "rigid_body_sim/simulator.hpp"

namespace rigid_body_sim {

/// A typed tree as the parameter server holds it. @throws std::invalid_argument for dates and
/// binary data, which no parameter is.
Value toValue(XmlRpc::XmlRpcValue& value);

Vector3d toVector(const geometry_msgs::Vector3& vector);
Vector3d toVector(const geometry_msgs::Point& point);
geometry_msgs::Vector3 toMessage(const Vector3d& vector);
geometry_msgs::Quaternion toMessage(const Quaterniond& q);
geometry_msgs::Pose poseOf(const LinkMotion& link);
geometry_msgs::Twist twistOf(const LinkMotion& link);

/// The numbers of a message that has its names already: to use it again allocates nothing.
void write(const LinkMotion& link, const ros::Time& stamp,
           geometry_msgs::TransformStamped& transform);
void write(const LinkMotion& link, const ros::Time& stamp, nav_msgs::Odometry& odometry);
void write(const LinkMotion& link, const ros::Time& stamp, geometry_msgs::TwistStamped& twist);
void write(const Wrench& wrench_Bcm_W, const Quaterniond& q_WB, const ros::Time& stamp,
           geometry_msgs::WrenchStamped& wrench);
void write(const WrenchesOfEffect& one, EffectWrench& message);

/// One message with the transform world -> root link of every body, stamped with the tick's time.
tf2_msgs::TFMessage toTf(const Simulator& simulator, const std::string& world_frame,
                         const ros::Time& stamp);

/// The constant frames of all bodies: <body>/com and, if asked for, the lumped links.
std::vector<geometry_msgs::TransformStamped> toStaticTf(const Simulator& simulator,
                                                        bool with_link_frames,
                                                        const ros::Time& stamp);

BodyStates toStates(const Simulator& simulator, const std::string& world_frame,
                    const ros::Time& stamp);

/// Pose in the world, twist in the root link's axes, as nav_msgs/Odometry defines it.
nav_msgs::Odometry toOdometry(const Simulator& simulator, Eigen::Index body,
                              const std::string& world_frame, const ros::Time& stamp);

/// What each effect does to each body now.
EffectWrenches toEffectWrenches(const Simulator& simulator, const std::string& world_frame,
                                const ros::Time& stamp);

/// What acts on the body now, in all, at <body>/com and in its axes.
geometry_msgs::WrenchStamped toAppliedWrench(const Simulator& simulator, Eigen::Index body,
                                             const ros::Time& stamp);

geometry_msgs::TwistStamped toTwist(const Simulator& simulator, Eigen::Index body,
                                    const ros::Time& stamp);

}  // namespace rigid_body_sim

#pragma once

#include <rigid_body_sim/BodyImpulses.h>
#include <rigid_body_sim/BodyWrenches.h>
#include <ros/ros.h>

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "node/input_rules.hpp"

namespace rigid_body_sim {

/// What became of the inputs so far.
struct InputCounts {
  std::uint64_t accepted = 0;
  std::array<std::uint64_t, kRefusalCount> refused = {};
  std::uint64_t expired = 0;  ///< held wrenches that the timeout ended

  std::uint64_t refusedInAll() const {
    std::uint64_t sum = 0;
    for (const std::uint64_t count : refused) sum += count;
    return sum;
  }
};

/// The subscribers. Callbacks check each message and queue it in the simulator; nothing else.
class Inputs {
 public:
  Inputs(ros::NodeHandle& nh, Simulator& simulator, const SimTime& time,
         const NodeOptions& options);

  /// Says which held wrenches the latest tick ended.
  void reportExpired();

  const InputCounts& counts() const { return counts_; }

 private:
  void subscribeBody(ros::NodeHandle& nh, Eigen::Index body);
  template <class Convert>
  void take(const std::string& source, std::uint64_t entry, bool is_list, Convert convert);
  void refuse(const RefusedInput& refused, const std::string& source);

  Simulator& simulator_;
  InputRules rules_;
  std::vector<ros::Subscriber> subscribers_;
  std::uint64_t sequence_ = 0;  // of arrival; TCP keeps the order of each publisher
  InputCounts counts_;
  std::array<ros::SteadyTime, kRefusalCount> warned_;
  ros::SteadyTime told_expiry_;
};

}  // namespace rigid_body_sim

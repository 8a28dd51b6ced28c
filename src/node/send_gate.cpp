#include "node/send_gate.hpp"

#include <ros/poll_manager.h>
#include <ros/ros.h>

#include <chrono>

namespace rigid_body_sim {

// Listeners are called in the order of their coming, and the one that takes all that is published
// came when ROS started.
SendGate::SendGate()
    : connection_(ros::PollManager::instance()->addPollThreadListener([this] { taken(); })) {}

SendGate::~SendGate() { ros::PollManager::instance()->removePollThreadListener(connection_); }

void SendGate::pass() {
  std::unique_lock<std::mutex> lock(mutex_);
  ++ahead_;
  while (ahead_ >= kMaxAhead && ros::ok()) taken_.wait_for(lock, std::chrono::milliseconds(100));
}

void SendGate::drain() {
  std::unique_lock<std::mutex> lock(mutex_);
  while (ahead_ > 0 && ros::ok()) taken_.wait_for(lock, std::chrono::milliseconds(100));
}

void SendGate::taken() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    ahead_ = 0;
  }
  taken_.notify_one();
}

}  // namespace rigid_body_sim

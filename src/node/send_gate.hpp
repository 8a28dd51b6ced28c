#pragma once

#include <boost/signals2/connection.hpp>
#include <condition_variable>
#include <mutex>

namespace rigid_body_sim {

/// Holds the simulation back while ROS is behind with sending. What is published waits, without
/// bound, until roscpp's own thread takes it; a simulation that runs as fast as it can may starve
/// that thread on a busy machine, and filled a gigabyte in ten seconds.
class SendGate {
 public:
  SendGate();
  ~SendGate();
  SendGate(const SendGate&) = delete;
  SendGate& operator=(const SendGate&) = delete;

  /// To be called after each tick is published; returns when fewer than kMaxAhead of them wait, or
  /// ROS is shut down.
  void pass();

  /// Returns when nothing waits any more, or ROS is shut down.
  void drain();

 private:
  static constexpr int kMaxAhead = 50;  // half of what a publisher holds for a slow subscriber

  void taken();

  std::mutex mutex_;
  std::condition_variable taken_;
  int ahead_ = 0;
  boost::signals2::connection connection_;
};

}  // namespace rigid_body_sim

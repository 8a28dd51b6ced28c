#pragma once

#include <ros/ros.h>

#include <atomic>
#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace rigid_body_sim {

/// Registers the node again when the master comes back after a restart, which roscpp does not:
/// without it the node goes on but nobody new can find it. Connections that exist are not touched.
///
/// It asks the master once a second from a thread of its own, as a dead host may block the
/// question; it shares no state with the simulation.
class MasterWatch {
 public:
  /// @param services full names of the node's services; roscpp does not list them
  explicit MasterWatch(std::vector<std::string> services);
  ~MasterWatch();

 private:
  void run();
  void registerAll();

  std::vector<std::string> services_;
  std::mutex mutex_;
  std::condition_variable stop_;
  bool stopping_ = false;
  std::thread thread_;
};

}  // namespace rigid_body_sim

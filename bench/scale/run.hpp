#pragma once

#include <string>
#include <vector>

namespace rigid_body_sim::scale {

/// What is simulated, and who listens.
struct Load {
  int bodies = 1000;
  std::vector<std::string> topics;  ///< tf, states, and those of every body: twist, odom
  int every = 1;                    ///< ticks between two messages of a topic of a single body
  bool is_lean = false;             ///< topics of single bodies that nobody wants are left out
  double seconds = 10;              ///< how long it is measured
};

/// What it took.
struct Result {
  double start_s = 0;  ///< from the program's start to its first tick
  double cpu = 0;      ///< of one core: processor time of the node, all threads, by wall time
  double subscribers_cpu = 0;
  double messages = 0;  ///< received a second, by all subscribers
  double expected = 0;  ///< that were to be received a second
  double real_time_factor = 0;
  long overruns = 0;     ///< ticks that were published more than a period late
  double latest_ms = 0;  ///< the latest of all, after it was due
  long resident_kB = 0;
};

/// A scene of bodies that all differ, tumble and fall, as YAML.
std::string sceneText(const Load& load);

/// Starts the node and its subscribers, each in a process of its own, and measures. Needs a master.
/// @param node path of the program; `self` that of a program whose main calls subscribe() when its
/// first argument is --subscribe
/// @throws std::runtime_error if one of them does not do its part
Result measure(const Load& load, const std::string& node, const std::string& self);

}  // namespace rigid_body_sim::scale

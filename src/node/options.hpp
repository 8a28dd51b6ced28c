#pragma once

#include <cstdint>
#include <string>

#include "rigid_body_sim/parameters.hpp"

namespace rigid_body_sim {

/// Largest inputs that are taken for meant; a larger one is refused whole.
struct Limits {
  double force;            ///< [N]
  double torque;           ///< [N m]
  double linear_impulse;   ///< [N s]
  double angular_impulse;  ///< [N m s]
  double speed;            ///< change of speed by one input in one tick [m/s]
  double angular_speed;    ///< change of angular speed by one input in one tick [rad/s]
};

/// Ticks from one message of a topic to the next; 0: there is no such topic.
struct PublishEvery {
  int tf = 1;
  int states = 1;
  int effect_wrenches = 1;
  int twist = 1;  ///< this and the next ones: of each body
  int odom = 1;
  int applied_wrench = 1;
};

/// The node's own parameters; config/default.yaml documents each.
struct NodeOptions {
  std::string scene_folder;  ///< where relative URDF paths start; empty: the working directory
  std::string world_frame;
  bool publish_clock;
  bool publish_link_frames;
  PublishEvery publish_every;
  bool body_inputs;  ///< whether each body has topics of its own for inputs
  bool paused;
  double real_time_factor;     ///< 0: as fast as possible
  double wrench_timeout_s;     ///< 0: never
  double stale_after_s;        ///< 0: never
  std::int64_t start_time_ns;  ///< stamp of tick 0
  Limits limits;
};

/// Reads the node's keys of the private parameters; the scene's keys stay unread.
/// @param use_sim_time the global parameter: whether other nodes take their time from /clock
/// @param wall_time_ns stands in for start_time_s where time is the wall's
/// @throws std::invalid_argument with key, value, what is allowed, unit
NodeOptions readNodeOptions(const Parameters& parameters, bool use_sim_time,
                            std::int64_t wall_time_ns);

}  // namespace rigid_body_sim

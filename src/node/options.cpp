#include "node/options.hpp"

#include <cmath>

#include "rigid_body_sim/urdf.hpp"

namespace rigid_body_sim {
namespace {

Limits readLimits(const Parameters& parameters) {
  const Parameters block = parameters.child("limits");
  Limits limits;
  limits.force = block.number("force", positive("N"), 1e12);
  limits.torque = block.number("torque", positive("N m"), 1e12);
  limits.linear_impulse = block.number("linear_impulse", positive("N s"), 1e12);
  limits.angular_impulse = block.number("angular_impulse", positive("N m s"), 1e12);
  limits.speed = block.number("speed", positive("m/s"), 1e8);
  limits.angular_speed = block.number("angular_speed", positive("rad/s"), 1e6);
  block.refuseUnknown();
  return limits;
}

PublishEvery readPublishEvery(const Parameters& parameters) {
  const Parameters block = parameters.child("publish_every");
  PublishEvery every;
  for (const auto& [key, ticks] : {std::pair<const char*, int*>{"tf", &every.tf},
                                   {"states", &every.states},
                                   {"effect_wrenches", &every.effect_wrenches},
                                   {"twist", &every.twist},
                                   {"odom", &every.odom},
                                   {"applied_wrench", &every.applied_wrench}})
    *ticks = block.integer(key, 0, 1'000'000, *ticks, "ticks");
  block.refuseUnknown();
  return every;
}

std::string folderOf(const std::string& path) {
  const auto slash = path.rfind('/');
  if (slash == 0) return "/";
  return slash == std::string::npos ? std::string() : path.substr(0, slash);
}

/// 0 is as fast as possible; the least above it keeps a tick of 1 s well within integer
/// nanoseconds.
double readRealTimeFactor(const Parameters& parameters) {
  const double least = 1e-6;
  const double factor = parameters.number("real_time_factor", {0, 1e6, "times real time"}, 1);
  if (factor > 0 && factor < least)
    parameters.refuse("real_time_factor", toText({factor}) + " is neither 0 nor from " +
                                              toText({least}) + " [times real time]");
  return factor;
}

/// Simulated time starts at 1 s, as tf2 reads the stamp 0 as "latest"; without /clock it starts at
/// the wall's time, as other nodes stamp their messages with that.
std::int64_t readStartTime(const Parameters& parameters, bool publish_clock,
                           std::int64_t wall_time_ns) {
  const double max_s = 4e9;  // ros::Time ends at 2^32 s
  if (!parameters.has("start_time_s")) return publish_clock ? 1'000'000'000 : wall_time_ns;
  const double start_s = parameters.number("start_time_s", {1e-3, max_s, "s"});
  return static_cast<std::int64_t>(std::llround(start_s * 1e3)) * 1'000'000;
}

}  // namespace

NodeOptions readNodeOptions(const Parameters& parameters, bool use_sim_time,
                            std::int64_t wall_time_ns) {
  NodeOptions options;
  options.scene_folder = folderOf(parameters.text("scene_file", "scene.yaml"));
  options.world_frame = parameters.text("world_frame", "world");
  try {
    requireName(options.world_frame, "frame");
  } catch (const std::invalid_argument& error) {
    parameters.refuse("world_frame", error.what());
  }
  options.publish_clock = parameters.boolean("publish_clock", use_sim_time);
  if (use_sim_time && !options.publish_clock) {
    parameters.refuse("publish_clock",
                      "false while /use_sim_time is true: the stamps would follow no clock");
  }
  options.publish_link_frames = parameters.boolean("publish_link_frames", true);
  options.publish_every = readPublishEvery(parameters);
  options.body_inputs = parameters.boolean("body_inputs", true);
  options.paused = parameters.boolean("paused", false);
  options.real_time_factor = readRealTimeFactor(parameters);
  options.wrench_timeout_s = parameters.number("wrench_timeout_s", {0, 1e9, "s"}, 1);
  options.stale_after_s = parameters.number("stale_after_s", {0, 1e9, "s"}, 1);
  options.start_time_ns = readStartTime(parameters, options.publish_clock, wall_time_ns);
  options.limits = readLimits(parameters);
  return options;
}

}  // namespace rigid_body_sim

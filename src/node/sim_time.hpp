#pragma once

#include <ros/time.h>

#include <algorithm>
#include <cstdint>

#include "rigid_body_sim/conventions.hpp"

namespace rigid_body_sim {

/// Ticks and stamps: tick k begins at start + k step, in whole nanoseconds.
struct SimTime {
  std::int64_t start_ns = 0;
  std::int64_t step_ns = 20'000'000;

  ros::Time at(Tick tick) const {
    ros::Time stamp;
    stamp.fromNSec(static_cast<std::uint64_t>(start_ns + tick * step_ns));
    return stamp;
  }

  /// The first tick that begins at or after `stamp`. Clients turn decimal seconds into nanoseconds
  /// by truncation or rounding; half a microsecond (or a quarter of a step) of that is forgiven.
  Tick firstTickFrom(const ros::Time& stamp) const {
    const std::int64_t ahead_ns = static_cast<std::int64_t>(stamp.toNSec()) - start_ns - slack();
    return ahead_ns <= 0 ? 0 : (ahead_ns + step_ns - 1) / step_ns;
  }

  /// The whole number of ticks that `duration` is, with the same slack; -1 if it is none.
  Tick wholeTicks(const ros::Duration& duration) const {
    const Tick ticks = (duration.toNSec() + step_ns / 2) / step_ns;
    const std::int64_t off_ns = duration.toNSec() - ticks * step_ns;
    return std::max(off_ns, -off_ns) <= slack() ? ticks : -1;
  }

  std::int64_t slack() const { return std::min<std::int64_t>(500, step_ns / 4); }
};

}  // namespace rigid_body_sim

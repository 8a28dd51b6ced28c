#pragma once

#include <geometry_msgs/WrenchStamped.h>
#include <rigid_body_sim/BodyImpulse.h>
#include <rigid_body_sim/BodyWrench.h>
#include <rigid_body_sim/ImpulseStamped.h>

#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "node/options.hpp"
#include "node/sim_time.hpp"
#include "rigid_body_sim/simulator.hpp"

namespace rigid_body_sim {

/// Why an input was not taken.
enum class Refusal {
  kNotFinite,
  kUnknownBody,
  kUnknownFrame,
  kStale,
  kTooFarAhead,
  kTooManyWaiting,
  kDuration,
  kLimit,
  kPointMass,
};
constexpr int kRefusalCount = 9;

/// As it stands in diagnostics.
const char* toText(Refusal refusal);

/// An input that is refused whole, with the reason for people.
class RefusedInput : public std::invalid_argument {
 public:
  RefusedInput(Refusal refusal, const std::string& what)
      : std::invalid_argument(what), refusal(refusal) {}
  const Refusal refusal;
};

/// What a message means: its frame, point, time and size, checked. The one place where wrenches and
/// impulses are turned into what the simulator takes.
///
/// A frame fixed to the body names axes and point of application, and the wrench turns with the
/// body while it is held. The world frame means world axes, acting at the centre of mass. A leading
/// "/" of a frame is ignored. All functions throw RefusedInput.
class InputRules {
 public:
  InputRules(const Simulator& simulator, const SimTime& time, const NodeOptions& options);

  WrenchInput held(Eigen::Index body, const geometry_msgs::WrenchStamped& message) const;
  WrenchInput scheduled(const BodyWrench& message) const;
  ImpulseInput impulse(Eigen::Index body, const ImpulseStamped& message) const;
  ImpulseInput impulse(const BodyImpulse& message) const;

 private:
  /// How large an input may be, in its own words and units.
  struct Bounds {
    const char* force;  ///< "force" or "linear impulse"
    const char* torque;
    const char* force_unit;
    const char* torque_unit;
    double max_force;
    double max_torque;
    double seconds;  ///< of momentum that it gives in a tick
  };
  Bounds wrenchBounds() const;
  Bounds impulseBounds() const;

  /// A frame in which inputs to one body may be given.
  struct Frame {
    Axes axes;
    Isometry3d X_BF;  ///< pose of the frame in B; identity for the world's
  };

  Eigen::Index bodyNamed(const std::string& name) const;
  Frame frameNamed(Eigen::Index body, const std::string& frame_id) const;
  AppliedWrench applied(Eigen::Index body, const std::string& frame_id, const Wrench& wrench) const;
  AppliedWrench appliedAt(Eigen::Index body, const std::string& frame_id,
                          const std::string& point_frame, const Vector3d& point,
                          const Wrench& wrench) const;
  void requireRoom(bool is_ahead) const;
  Tick startTick(const ros::Time& stamp) const;
  Tick heldTicks() const;
  void check(Eigen::Index body, const AppliedWrench& applied, const Bounds& bounds) const;
  WrenchInput checked(Eigen::Index body, const AppliedWrench& applied) const;
  ImpulseInput checkedImpulse(Eigen::Index body, const AppliedWrench& applied) const;

  const Simulator& simulator_;
  SimTime time_;
  NodeOptions options_;
  std::map<std::string, Eigen::Index> bodies_;
  std::vector<std::map<std::string, Isometry3d>> frames_;  // of each body, X_BF by name
};

}  // namespace rigid_body_sim

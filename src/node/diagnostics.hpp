#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/ros.h>

#include <optional>

#include "node/inputs.hpp"
#include "node/pace.hpp"

namespace rigid_body_sim {

/// Publishes on /diagnostics once a second of wall time: what is simulated, whether it keeps up
/// and keeps its accuracy, what became of the inputs, and which bodies are frozen.
class Diagnostics {
 public:
  Diagnostics(ros::NodeHandle& nh, const Simulator& simulator, const Inputs& inputs, Pace& pace,
              double real_time_factor);

  /// The simulation begins anew: what it lost before is forgotten.
  void reset() { lost_.reset(); }

  void setPaused(bool is_paused) { is_paused_ = is_paused; }

 private:
  /// Energy that nothing accounts for, when there was first too much of it.
  struct Lost {
    double energy_J;
    Tick tick;
  };

  void report(diagnostic_updater::DiagnosticStatusWrapper& status);
  void reportEffects(diagnostic_updater::DiagnosticStatusWrapper& status);
  void reportPace(diagnostic_updater::DiagnosticStatusWrapper& status);
  void reportInputs(diagnostic_updater::DiagnosticStatusWrapper& status);
  void reportAccuracy(diagnostic_updater::DiagnosticStatusWrapper& status);
  void reportStability(diagnostic_updater::DiagnosticStatusWrapper& status);
  void reportFrozen(diagnostic_updater::DiagnosticStatusWrapper& status);

  const Simulator& simulator_;
  const Inputs& inputs_;
  Pace& pace_;
  double real_time_factor_;
  std::vector<std::string> elisions_;  // looks at the tensors of all bodies: once
  diagnostic_updater::Updater updater_;
  ros::SteadyTimer timer_;
  ros::SteadyTime last_time_ = ros::SteadyTime::now();
  Tick last_tick_ = 0;
  std::uint64_t last_refused_ = 0;
  std::uint64_t last_rebases_ = 0;
  bool is_paused_ = false;
  std::optional<Lost> lost_;
};

}  // namespace rigid_body_sim

#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "rigid_body_sim/body_frame.hpp"
#include "rigid_body_sim/integrator.hpp"
#include "rigid_body_sim/mass_properties.hpp"
#include "rigid_body_sim/method.hpp"
#include "rigid_body_sim/parameters.hpp"
#include "rigid_body_sim/urdf.hpp"

namespace rigid_body_sim {

/// A body of a scene and how it starts.
struct SceneBody {
  std::string name;                ///< of its root link; also its frame and topic name
  MassProperties mass_properties;  ///< in the root link frame L
  std::vector<FixedFrame> frames;  ///< further frames fixed to it (lumped links)
  Isometry3d X_WL = Isometry3d::Identity();
  Vector3d v_WBcm = Vector3d::Zero();  ///< velocity of the centre of mass [m/s], world axes
  Vector3d w_WB_L = Vector3d::Zero();  ///< angular velocity [rad/s], root link axes
  bool is_point_mass = false;          ///< has no rotation; takes no torque
  std::optional<Gyroscopic> gyroscopic = std::nullopt;  ///< unset: as the scene's
  AddedMass added_mass_L = {};
};

/// Frame and inertia that a scene's body is simulated with.
/// @throws std::invalid_argument naming the body, if no rigid body has its mass properties.
BodyFrame bodyFrame(const SceneBody& body);

/// Name of the frame at a body's centre of mass, along its principal axes.
inline std::string comFrameName(const std::string& body) { return body + "/com"; }

/// How far any body's pose may be from the truth, at any time of a span from the start.
struct Budget {
  double attitude_rad = std::numeric_limits<double>::infinity();  ///< infinite: any will do
  double position_m = std::numeric_limits<double>::infinity();
  double over_s = 0;    ///< [s]
  bool replan = false;  ///< choose anew when inputs have broken it
};

/// All that a simulation starts from.
struct Scene {
  std::int64_t step_ns = 20'000'000;
  std::string integrator = "exact";
  int substeps = 1;          ///< steps of the integrator a tick
  int threads = 0;           ///< that share a tick's work, to the same bits; 0: as many as the
                             ///< processor has where bodies are many, else one
  double tolerance = 1e-12;  ///< see IntegratorOptions
  /// Bodies by the method that steps them, each body once; empty: all by `integrator`.
  std::vector<MethodOfBodies> methods;
  /// If there, methods are chosen to keep it, and the four members before do not count.
  std::optional<Budget> accuracy;
  Gyroscopic gyroscopic = Gyroscopic::kOn;
  std::vector<SceneBody> bodies;
  EffectList effects;
  std::vector<std::string> elided;    ///< effects that do nothing here, and why; one line each
  bool energy_audit = false;          ///< keep account of the work of all effects
  std::string import_report;          ///< what the URDF files held; empty without any
  std::vector<std::string> warnings;  ///< of the import and of the integrator, one line each

  double step_s() const { return static_cast<double>(step_ns) / 1e9; }
};

/// Where a scene finds what it refers to.
struct SceneSources {
  std::string folder;  ///< relative `urdf` paths start here
  /// Text of the URDF in the parameter of this name; unset where there are no parameters (offline).
  std::function<std::string(const std::string& parameter)> urdf_parameter;
};

/// Reads a scene from parameters (config/default.yaml documents every key). Leaves keys that are
/// not a scene's unread: call refuseUnknown() on `parameters` after everything that reads from
/// them.
/// @throws std::invalid_argument with the path of the key, its value, and what is allowed.
Scene readScene(const Parameters& parameters, const SceneSources& sources);

/// Reads a scene file (YAML). @throws std::invalid_argument as readScene, also for unknown keys.
Scene readSceneFile(const std::string& path);

/// `1e-06 rad and 0.001 m over 60 s`.
std::string summary(const Budget& budget);

/// One line that says what a body is: mass, centre of mass, principal moments.
std::string summary(const SceneBody& body);

/// The method of a scene that has neither `methods` nor `accuracy`.
inline Method methodOf(const Scene& scene) {
  return {scene.integrator, scene.substeps, scene.tolerance};
}

/// One line that says what is simulated: `3 bodies; effects: gravity (2 bodies), gyroscopic on;
/// integrator: exact, step 0.02 s`.
std::string summary(const Scene& scene);

/// What is not computed, as it would change nothing, and why; one line each: effects whose
/// parameters are zero, the gyroscopic term of spheres, the rotation of point masses.
std::vector<std::string> elisions(const Scene& scene);

/// The bodies without the gyroscopic term. Spherical ones and point masses are not among them: for
/// them the term is zero, and they fly the same way with and without.
/// @param some to look at; the result are places in it
std::vector<Eigen::Index> ungyroscopicBodies(const Scene& scene,
                                             const std::vector<Eigen::Index>& some);
std::vector<Eigen::Index> ungyroscopicBodies(const Scene& scene);

}  // namespace rigid_body_sim

#include "rigid_body_sim/scene.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <sstream>
#include <stdexcept>

#include "core/scene_body.hpp"
#include "core/scene_effects.hpp"

namespace rigid_body_sim {
namespace {

std::int64_t readStep(const Parameters& parameters) {
  const double step_s = parameters.number("step_s", {1e-6, 1, "s"}, 0.02);
  const auto step_ns = static_cast<std::int64_t>(std::llround(step_s * 1e9));
  // A decimal number of nanoseconds is off by at most an ulp of the product.
  if (std::abs(step_s * 1e9 - static_cast<double>(step_ns)) > 4.5e-16 * step_s * 1e9)
    parameters.refuse("step_s", toText({step_s}) + " is not a whole number of nanoseconds");
  return step_ns;
}

/// `integrator` with its `substeps` and `tolerance`.
void readMethod(const Parameters& parameters, Scene& scene) {
  scene.integrator = parameters.text("integrator", scene.integrator);
  try {
    integratorNamed(scene.integrator);
  } catch (const std::invalid_argument& error) {
    parameters.refuse("integrator", error.what());
  }
  scene.substeps = parameters.integer("substeps", 1, kMostSubsteps, scene.substeps);
  const bool adapts = integratorNamed(scene.integrator).order == 0;
  if (parameters.has("tolerance") && !adapts)
    parameters.refuse("tolerance", "the integrator '" + scene.integrator +
                                       "' does not adapt its steps; `adaptive` takes it");
  scene.threads = parameters.integer("threads", 0, 256, scene.threads);
  scene.tolerance = parameters.number("tolerance", {1e-15, 1e-2, "rad in 1 s"}, scene.tolerance);
}

std::optional<Budget> readBudget(const Parameters& parameters) {
  if (!parameters.has("accuracy")) return std::nullopt;
  for (const char* key : {"integrator", "substeps", "tolerance"})
    if (parameters.has(key))
      parameters.refuse(key, "`accuracy` chooses the method; give one of the two");
  const Parameters block = parameters.child("accuracy");
  for (const char* key : {"attitude_rad", "position_m", "over_s", "replan"}) block.has(key);
  block.refuseUnknown();  // before what is missing: it may be there, but misspelt
  if (!block.has("attitude_rad") && !block.has("position_m"))
    parameters.refuse("accuracy", "it takes attitude_rad, position_m or both");
  Budget budget;
  if (block.has("attitude_rad"))
    budget.attitude_rad = block.number("attitude_rad", positive("rad"));
  if (block.has("position_m")) budget.position_m = block.number("position_m", positive("m"));
  budget.over_s = block.number("over_s", {0, 1e9, "s", true});
  budget.replan = block.boolean("replan", false);
  return budget;
}

std::string pathFrom(const std::string& folder, const std::string& path) {
  return path.front() == '/' || folder.empty() ? path : folder + "/" + path;
}

/// All bodies of the URDF files and parameters that the scene names, and their report.
void readUrdfs(const Parameters& parameters, const SceneSources& sources, Scene& scene) {
  const std::string joints = parameters.text("joints", "refuse");
  if (joints != "refuse" && joints != "lock")
    parameters.refuse("joints", "'" + joints + "' is not refuse or lock");
  const MovableJoints movable = joints == "lock" ? MovableJoints::kLock : MovableJoints::kRefuse;

  std::vector<UrdfModel> models;
  for (const std::string& path : parameters.texts("urdf"))
    models.push_back(readUrdfFile(pathFrom(sources.folder, path), movable));
  if (parameters.has("urdf_parameter")) {
    const std::string name = parameters.text("urdf_parameter");
    if (!sources.urdf_parameter)
      parameters.refuse("urdf_parameter",
                        "there is no parameter server here; name files in `urdf`");
    models.push_back(readUrdf(sources.urdf_parameter(name), "parameter " + name, movable));
  }
  for (const UrdfModel& model : models) {
    scene.import_report += importReport(model);
    for (const std::string& warning : model.warnings) scene.warnings.push_back(warning);
    for (const UrdfBody& body : model.bodies) {
      SceneBody scene_body;
      scene_body.name = body.name;
      scene_body.mass_properties = body.mass_properties;
      scene_body.frames = body.frames;
      scene_body.X_WL = body.X_ML;
      scene.bodies.push_back(scene_body);
    }
  }
}

/// Completes the scene with the bodies that have no URDF and with initial motions. Returns the
/// block of every body below `bodies`; a body of a URDF need not have one.
std::vector<Parameters> readBodies(const Parameters& parameters, Scene& scene) {
  const Parameters all = parameters.child("bodies");
  std::vector<Parameters> blocks;
  for (const SceneBody& body : scene.bodies) blocks.push_back(all.child(body.name));
  std::set<std::string> urdf_names;
  for (const SceneBody& body : scene.bodies) urdf_names.insert(body.name);
  for (const std::string& name : all.keys()) {
    if (urdf_names.count(name)) continue;
    blocks.push_back(all.child(name));
    const std::string nearest = nearestWord(name, urdf_names);
    if (!nearest.empty() && !saysWhatItIs(blocks.back()))
      all.refuse(name, "no URDF has a root link of this name; did you mean '" + nearest + "'?");
    scene.bodies.push_back(bodyFromNumbers(blocks.back(), name));
  }
  for (std::size_t i = 0; i < blocks.size(); ++i) readInitialMotion(blocks[i], scene.bodies[i]);
  return blocks;
}

std::string summaryOfGyroscopic(const Scene& scene) {
  const bool is_on = scene.gyroscopic == Gyroscopic::kOn;
  const auto others =
      std::count_if(scene.bodies.begin(), scene.bodies.end(), [&](const SceneBody& body) {
        return body.gyroscopic.value_or(scene.gyroscopic) != scene.gyroscopic;
      });
  std::string text = is_on ? "gyroscopic on" : "gyroscopic off";
  if (others > 0) text += (is_on ? " (off for " : " (on for ") + std::to_string(others) + ")";
  return text;
}

std::string summaryOfMethods(const Scene& scene) {
  if (scene.methods.empty())
    return scene.accuracy ? "integrator: what keeps " + summary(*scene.accuracy)
                          : "integrator: " + toText(methodOf(scene));
  std::string text = "integrators: ";
  for (const MethodOfBodies& part : scene.methods)
    text += (&part == &scene.methods.front() ? "" : ", ") + toText(part.method) + " (" +
            std::to_string(part.bodies.size()) + (part.bodies.size() == 1 ? " body)" : " bodies)");
  return scene.accuracy ? text + " to keep " + summary(*scene.accuracy) : text;
}

}  // namespace

Scene readScene(const Parameters& parameters, const SceneSources& sources) {
  Scene scene;
  scene.step_ns = readStep(parameters);
  scene.accuracy = readBudget(parameters);
  readMethod(parameters, scene);
  readUrdfs(parameters, sources, scene);
  const std::vector<Parameters> bodies = readBodies(parameters, scene);
  if (scene.bodies.empty())
    parameters.refuse("bodies", "the scene has no body; name URDF files in `urdf` or give masses");
  readEffects(parameters, bodies, scene);
  scene.energy_audit = parameters.boolean("energy_audit", false);
  for (const Parameters& body : bodies) body.refuseUnknown();
  return scene;
}

Scene readSceneFile(const std::string& path) {
  const auto slash = path.rfind('/');
  try {
    const Parameters parameters(readYaml(readTextFile(path), path), "");
    Scene scene =
        readScene(parameters, {slash == std::string::npos ? "" : path.substr(0, slash), {}});
    parameters.refuseUnknown();
    return scene;
  } catch (const std::invalid_argument& error) {
    const std::string what = error.what();
    throw std::invalid_argument(what.rfind(path, 0) == 0 ? what : path + ": " + what);
  }
}

BodyFrame bodyFrame(const SceneBody& body) {
  if (body.is_point_mass) {
    // It has no rotation: L stays zero, and a unit tensor keeps its angular velocity at zero.
    BodyFrame frame;
    frame.mass = body.mass_properties.mass;
    frame.I_BBcm_B = Vector3d::Ones();
    frame.p_LBcm = body.mass_properties.p_FBcm;
    return frame;
  }
  try {
    return bodyFrame(body.mass_properties, body.added_mass_L);
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument("body '" + body.name + "': " + error.what());
  }
}

std::string summary(const SceneBody& body) {
  const MassProperties& properties = body.mass_properties;
  const Eigen::IOFormat in_a_row(Eigen::StreamPrecision, Eigen::DontAlignCols, ", ", ", ");
  std::ostringstream text;
  text << body.name << ": " << properties.mass << " kg, centre of mass ("
       << properties.p_FBcm.transpose().format(in_a_row) << ") m";
  if (body.is_point_mass)
    text << ", a point mass";
  else
    text << ", principal moments ("
         << principalInertia(properties.I_BBcm_F).I_BBcm_B.transpose().format(in_a_row)
         << ") kg m^2";
  return text.str();
}

std::string summary(const Budget& budget) {
  std::ostringstream text;
  if (std::isfinite(budget.attitude_rad)) text << budget.attitude_rad << " rad";
  if (std::isfinite(budget.attitude_rad) && std::isfinite(budget.position_m)) text << " and ";
  if (std::isfinite(budget.position_m)) text << budget.position_m << " m";
  text << " over " << budget.over_s << " s";
  return text.str();
}

std::string summary(const Scene& scene) {
  std::ostringstream text;
  text << scene.bodies.size() << (scene.bodies.size() == 1 ? " body" : " bodies") << "; effects: ";
  for (const auto& effect : scene.effects) {
    text << effect->name() << " (" << effect->bodyCount()
         << (effect->bodyCount() == 1 ? " body), " : " bodies), ");
  }
  text << summaryOfGyroscopic(scene) << "; " << summaryOfMethods(scene) << ", step "
       << scene.step_s() << " s";
  return text.str();
}

}  // namespace rigid_body_sim

// MuJoCo.
#include <mujoco/mujoco.h>

#include <algorithm>
#include <cstring>
#include <memory>
#include <sstream>
#include <stdexcept>

#include "peer.hpp"

namespace rigid_body_sim::bench {
namespace {

std::string modelOf(const Scene& scene) {
  std::ostringstream xml;
  xml.precision(17);
  // MuJoCo's own guess of its stack is too small for thousands of bodies: "engine error: Stack
  // overflow", while the model is compiled. With constraints on, this would be, too.
  xml << "<mujoco><size nstack='" << 100'000 + 2000 * scene.bodies.count() << "'/>"
      << "<option timestep='" << scene.step_s << "' gravity='" << scene.g_W.transpose() << "'>"
      << "<flag constraint='disable' contact='disable' passive='disable' actuation='disable' "
         "sensor='disable'/></option><worldbody>";
  for (Eigen::Index i = 0; i < scene.bodies.count(); ++i)
    xml << "<body><freejoint/><inertial pos='" << scene.offset(i).transpose() << "' mass='"
        << scene.bodies.mass(i) << "' diaginertia='" << scene.bodies.moments(i).transpose()
        << "'/></body>";
  xml << "</worldbody></mujoco>";
  return xml.str();
}

/// Compiles a model from memory.
mjModel* compiled(const std::string& xml) {
  const auto files = std::make_unique<mjVFS>();
  mj_defaultVFS(files.get());
  mj_makeEmptyFileVFS(files.get(), "scene.xml", static_cast<int>(xml.size()));
  std::memcpy(files->filedata[mj_findFileVFS(files.get(), "scene.xml")], xml.data(), xml.size());
  char why[1000] = "";
  mjModel* model = mj_loadXML("scene.xml", files.get(), why, sizeof why);
  mj_deleteVFS(files.get());
  if (!model) throw std::runtime_error(why);
  return model;
}

enum class Way { kStep, kStages };

class Mujoco {
 public:
  Mujoco(const Scene& scene, mjtIntegrator integrator, Way way)
      : scene_(scene), way_(way), model_(compiled(modelOf(scene))) {
    model_->opt.integrator = integrator;
    data_ = mj_makeData(model_);
    reset();
  }
  ~Mujoco() {
    mj_deleteData(data_);
    mj_deleteModel(model_);
  }
  Mujoco(const Mujoco&) = delete;
  Mujoco& operator=(const Mujoco&) = delete;

  void reset() {
    mj_resetData(model_, data_);
    for (Eigen::Index i = 0; i < scene_.bodies.count(); ++i) {
      const BodyState state = scene_.bodies.state(i);
      const Vector3d r_W = state.q_WB * scene_.offset(i);
      Eigen::Map<Vector3d>(data_->qpos + 7 * i) = state.p_WBcm - r_W;
      Eigen::Map<Eigen::Vector4d>(data_->qpos + 7 * i + 3) << state.q_WB.w(), state.q_WB.vec();
      Eigen::Map<Vector3d>(data_->qvel + 6 * i) = scene_.v_WBcm(i) - scene_.w_WB(i).cross(r_W);
      Eigen::Map<Vector3d>(data_->qvel + 6 * i + 3) = scene_.w_WB_B(i);
    }
  }

  void step(int steps) {
    for (int k = 0; k < steps; ++k) {
      if (scene_.load.has_wrenches) push();
      if (way_ == Way::kStep)
        mj_step(model_, data_);
      else
        stages();
    }
  }

  Motion motionOf(Eigen::Index i) const {
    const Quaterniond q_WB = attitudeOf(i);
    const Vector3d w_WB = q_WB * Vector3d(data_->qvel + 6 * i + 3), r_W = q_WB * scene_.offset(i);
    return {Vector3d(data_->qpos + 7 * i) + r_W, q_WB,
            Vector3d(data_->qvel + 6 * i) + w_WB.cross(r_W), w_WB};
  }

  /// What it does with a warning where a state is not finite, or larger than 1e10.
  bool hasStartedAnew() const {
    return data_->warning[mjWARN_BADQPOS].number + data_->warning[mjWARN_BADQVEL].number +
               data_->warning[mjWARN_BADQACC].number >
           0;
  }

 private:
  Quaterniond attitudeOf(Eigen::Index i) const {
    const mjtNum* q = data_->qpos + 7 * i + 3;
    return {q[0], q[1], q[2], q[3]};
  }

  /// What mj_step does for bodies that nothing joins or touches, and nothing else.
  void stages() {
    mj_kinematics(model_, data_);
    mj_comPos(model_, data_);
    mj_crb(model_, data_);
    mj_factorM(model_, data_);
    mj_comVel(model_, data_);
    mj_rne(model_, data_, 0, data_->qfrc_bias);
    mj_fwdAcceleration(model_, data_);
    std::copy_n(data_->qacc_smooth, model_->nv, data_->qacc);
    mj_Euler(model_, data_);
  }

  /// By the joint's forces: xfrc_applied is taken through Jacobians of all joints, 5 us a body when
  /// there are 256, in proportion to their number. A free joint's torque is in the body's axes.
  void push() {
    for (Eigen::Index i = 0; i < scene_.bodies.count(); ++i) {
      Eigen::Map<Vector3d>(data_->qfrc_applied + 6 * i) = scene_.wrenches->f_W.row(i);
      Eigen::Map<Vector3d>(data_->qfrc_applied + 6 * i + 3) =
          attitudeOf(i).conjugate() * Vector3d(scene_.wrenches->t_Bcm_W.row(i));
    }
  }

  Scene scene_;
  Way way_;
  mjModel* model_;
  mjData* data_;
};

PeerRow row(const std::string& way, const std::string& about, mjtIntegrator integrator,
            Way how = Way::kStep) {
  PeerRow row = {std::string("MuJoCo ") + mj_versionString(), way, about,
                 [integrator, how](const Scene& scene) {
                   const auto engine = std::make_shared<Mujoco>(scene, integrator, how);
                   Peer peer = peerOf(engine);
                   peer.has_started_anew = [engine] { return engine->hasStartedAnew(); };
                   return peer;
                 }};
  row.is_gyroscopic_optional = false;
  row.most_bodies = 4096;
  row.limit = "the time to compile a model grows with the square of the bodies";
  return row;
}

}  // namespace

std::vector<PeerRow> peerRows() {
  PeerRow stages = row("stages, Euler", "the stages that free bodies need, called one by one",
                       mjINT_EULER, Way::kStages);
  PeerRow euler = row("Euler", "`mj_step` without constraints, contacts, sensors", mjINT_EULER);
  PeerRow rk4 = row("RK4", "the same by Runge-Kutta", mjINT_RK4);
  euler.hard_cases = "MuJoCo";
  rk4.hard_cases = "MuJoCo RK4";
  return {stages, euler, rk4};
}

}  // namespace rigid_body_sim::bench

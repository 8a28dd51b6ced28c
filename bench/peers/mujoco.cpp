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
    xml << "<body><freejoint/><inertial pos='0 0 0' mass='" << scene.bodies.mass(i)
        << "' diaginertia='" << scene.bodies.moments(i).transpose() << "'/></body>";
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
      Eigen::Map<Vector3d>(data_->qpos + 7 * i) = state.p_WBcm;
      Eigen::Map<Eigen::Vector4d>(data_->qpos + 7 * i + 3) << state.q_WB.w(), state.q_WB.vec();
      Eigen::Map<Vector3d>(data_->qvel + 6 * i) = scene_.v_WBcm(i);
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

  Quaterniond attitudeOf(Eigen::Index i) const {
    const mjtNum* q = data_->qpos + 7 * i + 3;
    return {q[0], q[1], q[2], q[3]};
  }

 private:
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
      Eigen::Map<Vector3d>(data_->qfrc_applied + 6 * i) = scene_.wrenches.f_W.row(i);
      Eigen::Map<Vector3d>(data_->qfrc_applied + 6 * i + 3) =
          attitudeOf(i).conjugate() * Vector3d(scene_.wrenches.t_Bcm_W.row(i));
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
                   return peerOf(std::make_shared<Mujoco>(scene, integrator, how));
                 }};
  row.is_gyroscopic_optional = false;
  row.most_bodies = 4096;
  row.limit = "the time to compile a model grows with the square of the bodies";
  return row;
}

}  // namespace

std::vector<PeerRow> peerRows() {
  return {row("stages, Euler", "the stages that free bodies need, called one by one", mjINT_EULER,
              Way::kStages),
          row("Euler", "`mj_step` without constraints, contacts, sensors", mjINT_EULER),
          row("RK4", "the same by Runge-Kutta", mjINT_RK4)};
}

}  // namespace rigid_body_sim::bench

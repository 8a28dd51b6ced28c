// Open Dynamics Engine.
#include <ode/ode.h>

#include <memory>

#include "peer.hpp"

namespace rigid_body_sim::bench {
namespace {

enum class Stepper { kWorldStep, kQuickStep };

struct Options {
  Stepper stepper = Stepper::kWorldStep;
  bool has_finite_rotation = false;
};

class Ode {
 public:
  Ode(const Scene& scene, const Options& options)
      : scene_(scene), options_(options), world_(dWorldCreate()) {
    dWorldSetGravity(world_, scene.g_W.x(), scene.g_W.y(), scene.g_W.z());
    dWorldSetAutoDisableFlag(world_, 0);
    for (Eigen::Index i = 0; i < scene.bodies.count(); ++i) addBody(i);
    reset();
  }
  ~Ode() { dWorldDestroy(world_); }
  Ode(const Ode&) = delete;
  Ode& operator=(const Ode&) = delete;

  void reset() {
    for (std::size_t k = 0; k < bodies_.size(); ++k) {
      const auto i = static_cast<Eigen::Index>(k);
      const BodyState state = scene_.bodies.state(i);
      const Vector3d v = scene_.v_WBcm(i), w = scene_.w_WB(i);
      const dQuaternion q = {state.q_WB.w(), state.q_WB.x(), state.q_WB.y(), state.q_WB.z()};
      dBodySetPosition(bodies_[k], state.p_WBcm.x(), state.p_WBcm.y(), state.p_WBcm.z());
      dBodySetQuaternion(bodies_[k], q);
      dBodySetLinearVel(bodies_[k], v.x(), v.y(), v.z());
      dBodySetAngularVel(bodies_[k], w.x(), w.y(), w.z());
    }
  }

  void step(int steps) {
    for (int k = 0; k < steps; ++k) {
      if (scene_.load.has_wrenches) push();
      if (options_.stepper == Stepper::kWorldStep)
        dWorldStep(world_, scene_.step_s);
      else
        dWorldQuickStep(world_, scene_.step_s);
    }
  }

  Motion motionOf(Eigen::Index i) const {
    const dBodyID body = bodies_[static_cast<std::size_t>(i)];
    const dReal* q = dBodyGetQuaternion(body);
    return {Vector3d(dBodyGetPosition(body)), Quaterniond(q[0], q[1], q[2], q[3]),
            Vector3d(dBodyGetLinearVel(body)), Vector3d(dBodyGetAngularVel(body))};
  }

 private:
  void addBody(Eigen::Index i) {
    const dBodyID body = dBodyCreate(world_);
    const Vector3d I = scene_.bodies.moments(i);
    dMass mass;
    dMassSetParameters(&mass, scene_.bodies.mass(i), 0, 0, 0, I.x(), I.y(), I.z(), 0, 0, 0);
    dBodySetMass(body, &mass);
    dBodySetGyroscopicMode(body, scene_.load.gyroscopic == Gyroscopic::kOn);
    dBodySetFiniteRotationMode(body, options_.has_finite_rotation);
    bodies_.push_back(body);
  }

  void push() {
    const Wrenches& wrenches = *scene_.wrenches;
    for (std::size_t k = 0; k < bodies_.size(); ++k) {
      const auto i = static_cast<Eigen::Index>(k);
      dBodyAddForce(bodies_[k], wrenches.f_W(i, 0), wrenches.f_W(i, 1), wrenches.f_W(i, 2));
      dBodyAddTorque(bodies_[k], wrenches.t_Bcm_W(i, 0), wrenches.t_Bcm_W(i, 1),
                     wrenches.t_Bcm_W(i, 2));
    }
  }

  Scene scene_;
  Options options_;
  dWorldID world_;
  std::vector<dBodyID> bodies_;
};

PeerRow row(const std::string& way, const std::string& about, const Options& options) {
  return {"ODE " ENGINE_VERSION, way, about,
          [options](const Scene& scene) { return peerOf(std::make_shared<Ode>(scene, options)); }};
}

PeerRow inHardCases() {
  PeerRow it = row("dWorldStep", "the direct solver, without a space of collisions", {});
  it.hard_cases = "ODE";
  return it;
}

}  // namespace

std::vector<PeerRow> peerRows() {
  dInitODE2(0);
  dAllocateODEDataForThread(dAllocateMaskAll);
  return {inHardCases(),
          row("dWorldStep, finite", "the same with finite rotations", {Stepper::kWorldStep, true}),
          row("dWorldQuickStep", "the iterative solver", {Stepper::kQuickStep, false})};
}

}  // namespace rigid_body_sim::bench

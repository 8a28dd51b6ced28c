// Simbody.
#include <Simbody.h>

#include <memory>

#include "peer.hpp"

namespace rigid_body_sim::bench {
namespace {

using SimTK::Vec3;

Vec3 vectorOf(const Vector3d& v) { return {v.x(), v.y(), v.z()}; }
Vector3d vectorOf(const Vec3& v) { return {v[0], v[1], v[2]}; }

/// Bodies of a scene in a system.
class SimbodySystem {
 public:
  explicit SimbodySystem(const Scene& scene)
      : scene_(scene),
        matter_(system_),
        forces_(system_),
        gravity_(forces_, matter_, vectorOf(scene.g_W)),
        pushes_(forces_, matter_) {
    matter_.setShowDefaultGeometry(false);
    for (Eigen::Index i = 0; i < scene.bodies.count(); ++i) {
      const Vector3d I = scene.bodies.moments(i);
      const Vec3 offset = vectorOf(scene.offset(i));
      const SimTK::Inertia I_O =
          SimTK::Inertia(I.x(), I.y(), I.z()).shiftFromMassCenter(offset, scene.bodies.mass(i));
      const SimTK::Body::Rigid body(SimTK::MassProperties(scene.bodies.mass(i), offset, I_O));
      bodies_.emplace_back(matter_.Ground(), body);
    }
    start_ = system_.realizeTopology();
    system_.realizeModel(start_);
    for (std::size_t k = 0; k < bodies_.size(); ++k) setStart(k);
  }

  const SimTK::State& start() const { return start_; }
  const SimTK::MultibodySystem& system() const { return system_; }
  const SimTK::SimbodyMatterSubsystem& matter() const { return matter_; }
  const Scene& scene() const { return scene_; }

  void push(SimTK::State& state) const {
    for (std::size_t k = 0; k < bodies_.size(); ++k) {
      const auto i = static_cast<Eigen::Index>(k);
      pushes_.setOneBodyForce(state, bodies_[k],
                              SimTK::SpatialVec(vectorOf(scene_.wrenches->t_Bcm_W.row(i)),
                                                vectorOf(scene_.wrenches->f_W.row(i))));
    }
  }

  Motion motionOf(const SimTK::State& state, Eigen::Index i) const {
    const SimTK::MobilizedBody::Free& body = bodies_[static_cast<std::size_t>(i)];
    system_.realize(state, SimTK::Stage::Velocity);
    const SimTK::Vector q = body.getQAsVector(state);
    const Vec3 offset = vectorOf(scene_.offset(i));
    return {vectorOf(body.findStationLocationInGround(state, offset)),
            Quaterniond(q[0], q[1], q[2], q[3]).normalized(),
            vectorOf(body.findStationVelocityInGround(state, offset)),
            vectorOf(body.getBodyAngularVelocity(state))};
  }

 private:
  void setStart(std::size_t k) {
    const auto i = static_cast<Eigen::Index>(k);
    const BodyState body = scene_.bodies.state(i);
    const Quaterniond& q = body.q_WB;
    const SimTK::Rotation R_WB(SimTK::Quaternion(q.w(), q.x(), q.y(), q.z()));
    const Vector3d r_W = q * scene_.offset(i), w_WB = scene_.w_WB(i);
    bodies_[k].setQToFitTransform(start_, SimTK::Transform(R_WB, vectorOf(body.p_WBcm - r_W)));
    bodies_[k].setUToFitVelocity(
        start_, SimTK::SpatialVec(vectorOf(w_WB), vectorOf(scene_.v_WBcm(i) - w_WB.cross(r_W))));
  }

  Scene scene_;
  SimTK::MultibodySystem system_;
  SimTK::SimbodyMatterSubsystem matter_;
  SimTK::GeneralForceSubsystem forces_;
  SimTK::Force::UniformGravity gravity_;
  SimTK::Force::DiscreteForces pushes_;
  std::vector<SimTK::MobilizedBody::Free> bodies_;
  SimTK::State start_;
};

/// Steps by one of Simbody's integrators, at a fixed step.
template <class Method>
class Integrated {
 public:
  explicit Integrated(const Scene& scene) : system_(scene) { reset(); }

  void reset() {
    method_ = makeMethod();
    method_->setFinalTime(SimTK::Infinity);
    method_->initialize(system_.start());
    method_->stepTo(0);  // the first call only tells that it has begun
  }

  void step(int steps) {
    for (int k = 0; k < steps; ++k) {
      if (system_.scene().load.has_wrenches) system_.push(method_->updAdvancedState());
      method_->stepBy(system_.scene().step_s);
    }
  }

  Motion motionOf(Eigen::Index i) const { return system_.motionOf(method_->getState(), i); }

 private:
  std::unique_ptr<Method> makeMethod() const {
    if constexpr (std::is_constructible_v<Method, const SimTK::System&, SimTK::Real>) {
      return std::make_unique<Method>(system_.system(), system_.scene().step_s);
    } else {
      auto method = std::make_unique<Method>(system_.system());
      method->setFixedStepSize(system_.scene().step_s);
      return method;
    }
  }

  SimbodySystem system_;
  std::unique_ptr<Method> method_;
};

/// Semi-explicit Euler on the realised accelerations, without an integrator around it.
class Realized {
 public:
  explicit Realized(const Scene& scene) : system_(scene), state_(system_.start()) {}

  void reset() { state_ = system_.start(); }

  void step(int steps) {
    const double step_s = system_.scene().step_s;
    for (int k = 0; k < steps; ++k) {
      if (system_.scene().load.has_wrenches) system_.push(state_);
      system_.system().realize(state_, SimTK::Stage::Acceleration);
      state_.updU() += step_s * state_.getUDot();
      system_.matter().multiplyByN(state_, false, state_.getU(), rate_);
      state_.updQ() += step_s * rate_;
      system_.matter().normalizeQuaternions(state_);
      state_.updTime() += step_s;
    }
  }

  Motion motionOf(Eigen::Index i) const { return system_.motionOf(state_, i); }

 private:
  SimbodySystem system_;
  SimTK::State state_;
  SimTK::Vector rate_;
};

template <class Engine>
PeerRow row(const std::string& way, const std::string& about) {
  int major = 0, minor = 0, patch = 0;
  SimTK_version_simbody(&major, &minor, &patch);
  PeerRow row = {"Simbody " + std::to_string(major) + "." + std::to_string(minor), way, about,
                 [](const Scene& scene) { return peerOf(std::make_shared<Engine>(scene)); }};
  row.is_gyroscopic_optional = false;
  row.most_bodies = 65536;
  row.limit = "a million take some 10 GB";
  return row;
}

}  // namespace

std::vector<PeerRow> peerRows() {
  PeerRow merson = row<Integrated<SimTK::RungeKuttaMersonIntegrator>>(
      "RK-Merson", "Runge-Kutta-Merson at a fixed step");
  merson.most_bodies = 4096;
  merson.limit = "a step of 65,536 takes RK-Merson a second, and a million take some 10 GB";
  merson.hard_cases = "Simbody RK";
  PeerRow euler = row<Integrated<SimTK::SemiExplicitEulerIntegrator>>(
      "semi-explicit Euler", "the integrator of this name");
  euler.hard_cases = "Simbody Euler";
  return {row<Realized>("realize, Euler", "`realize` and semi-explicit Euler by hand"), euler,
          merson};
}

}  // namespace rigid_body_sim::bench

// DART. Single headers: dart/dart.hpp wants more of them than Debian's package has.
#include <dart/config.hpp>
#include <dart/dynamics/BodyNode.hpp>
#include <dart/dynamics/FreeJoint.hpp>
#include <dart/dynamics/Skeleton.hpp>
#include <dart/simulation/World.hpp>
#include <memory>

#include "peer.hpp"

namespace rigid_body_sim::bench {
namespace {

enum class Way { kWorld, kPerSkeleton };

class Dart {
 public:
  Dart(const Scene& scene, Way way) : scene_(scene), way_(way) {
    world_->setTimeStep(scene.step_s);
    world_->setGravity(scene.g_W);
    for (Eigen::Index i = 0; i < scene.bodies.count(); ++i) addBody(i);
    reset();
  }

  void reset() {
    for (std::size_t k = 0; k < bodies_.size(); ++k) {
      const auto i = static_cast<Eigen::Index>(k);
      const BodyState state = scene_.bodies.state(i);
      Isometry3d X_WB = Isometry3d::Identity();
      X_WB.linear() = state.q_WB.toRotationMatrix();
      X_WB.translation() = state.p_WBcm - state.q_WB * scene_.offset(i);
      auto* joint = static_cast<dart::dynamics::FreeJoint*>(bodies_[k]->getParentJoint());
      joint->setPositions(dart::dynamics::FreeJoint::convertToPositions(X_WB));
      joint->setLinearVelocity(scene_.v_WBcm(i) -
                               scene_.w_WB(i).cross(state.q_WB * scene_.offset(i)));
      joint->setAngularVelocity(scene_.w_WB(i));
    }
  }

  void step(int steps) {
    for (int k = 0; k < steps; ++k) {
      if (scene_.load.has_wrenches) push();
      if (way_ == Way::kWorld)
        world_->step();
      else
        stepSkeletons();
    }
  }

  Motion motionOf(Eigen::Index i) const {
    const dart::dynamics::BodyNode& body = *bodies_[static_cast<std::size_t>(i)];
    return {body.getCOM(), Quaterniond(body.getWorldTransform().linear()),
            body.getCOMLinearVelocity(), body.getAngularVelocity()};
  }

 private:
  void addBody(Eigen::Index i) {
    const auto skeleton = dart::dynamics::Skeleton::create("body" + std::to_string(i));
    auto* body = skeleton->createJointAndBodyNodePair<dart::dynamics::FreeJoint>().second;
    dart::dynamics::Inertia inertia;
    const Vector3d I = scene_.bodies.moments(i);
    inertia.setMass(scene_.bodies.mass(i));
    inertia.setMoment(I.x(), I.y(), I.z(), 0, 0, 0);
    inertia.setLocalCOM(scene_.offset(i));
    body->setInertia(inertia);
    skeleton->setTimeStep(scene_.step_s);
    skeleton->setGravity(scene_.g_W);
    if (way_ == Way::kWorld) world_->addSkeleton(skeleton);
    skeletons_.push_back(skeleton);
    bodies_.push_back(body);
  }

  /// What a world does for a body without contacts, in its order, without a world.
  void stepSkeletons() {
    for (const auto& skeleton : skeletons_) {
      skeleton->computeForwardDynamics();
      skeleton->integrateVelocities(scene_.step_s);
      skeleton->integratePositions(scene_.step_s);
      if (scene_.load.has_wrenches) skeleton->clearExternalForces();
    }
  }

  void push() {
    for (std::size_t k = 0; k < bodies_.size(); ++k) {
      const auto i = static_cast<Eigen::Index>(k);
      bodies_[k]->addExtForce(scene_.wrenches->f_W.row(i), scene_.offset(i));
      bodies_[k]->addExtTorque(scene_.wrenches->t_Bcm_W.row(i));
    }
  }

  Scene scene_;
  Way way_;
  dart::simulation::WorldPtr world_ = dart::simulation::World::create();
  std::vector<dart::dynamics::SkeletonPtr> skeletons_;
  std::vector<dart::dynamics::BodyNode*> bodies_;
};

PeerRow row(const std::string& name, const std::string& about, Way way) {
  PeerRow row = {"DART " DART_VERSION, name, about,
                 [way](const Scene& scene) { return peerOf(std::make_shared<Dart>(scene, way)); }};
  row.is_gyroscopic_optional = false;
  row.most_bodies = way == Way::kWorld ? 4096 : 65536;
  row.limit = way == Way::kWorld ? "the time to fill a world grows with the square of the bodies"
                                 : "a million skeletons take some 20 GB";
  return row;
}

}  // namespace

std::vector<PeerRow> peerRows() {
  PeerRow world = row("world", "`World::step`, nothing to collide with", Way::kWorld);
  world.hard_cases = "DART";
  return {row("per skeleton", "the calls of each skeleton, without a world", Way::kPerSkeleton),
          world};
}

}  // namespace rigid_body_sim::bench

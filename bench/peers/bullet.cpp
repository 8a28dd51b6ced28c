// Bullet; compiled twice, for its builds of 32 and of 64 bits.
#include <BulletCollision/CollisionDispatch/btSimulationIslandManager.h>
#include <btBulletDynamicsCommon.h>

#include <memory>

#include "peer.hpp"

namespace rigid_body_sim::bench {
namespace {

btVector3 vectorOf(const Vector3d& v) {
  return {static_cast<btScalar>(v.x()), static_cast<btScalar>(v.y()), static_cast<btScalar>(v.z())};
}

Vector3d vectorOf(const btVector3& v) { return {v.x(), v.y(), v.z()}; }

/// Bodies of a scene, and how they start.
class BulletBodies {
 public:
  explicit BulletBodies(const Scene& scene) : scene_(scene) {
    for (Eigen::Index i = 0; i < scene.bodies.count(); ++i) {
      btRigidBody::btRigidBodyConstructionInfo info(static_cast<btScalar>(scene.bodies.mass(i)),
                                                    nullptr, &shape_,
                                                    vectorOf(scene.bodies.moments(i)));
      bodies_.push_back(std::make_unique<btRigidBody>(info));
      bodies_.back()->setFlags(
          scene.load.gyroscopic == Gyroscopic::kOn ? BT_ENABLE_GYROSCOPIC_FORCE_IMPLICIT_BODY : 0);
      bodies_.back()->setActivationState(DISABLE_DEACTIVATION);
    }
    reset();
  }

  void reset() {
    for (std::size_t k = 0; k < bodies_.size(); ++k) {
      const auto i = static_cast<Eigen::Index>(k);
      const BodyState state = scene_.bodies.state(i);
      const btQuaternion q(
          static_cast<btScalar>(state.q_WB.x()), static_cast<btScalar>(state.q_WB.y()),
          static_cast<btScalar>(state.q_WB.z()), static_cast<btScalar>(state.q_WB.w()));
      btRigidBody& body = *bodies_[k];
      body.clearForces();
      body.setLinearVelocity(vectorOf(scene_.v_WBcm(i)));
      body.setAngularVelocity(vectorOf(scene_.w_WB(i)));
      body.setCenterOfMassTransform(btTransform(q, vectorOf(state.p_WBcm)));
    }
  }

  void push(std::size_t k) {
    const auto i = static_cast<Eigen::Index>(k);
    bodies_[k]->applyCentralForce(vectorOf(scene_.wrenches->f_W.row(i)));
    bodies_[k]->applyTorque(vectorOf(scene_.wrenches->t_Bcm_W.row(i)));
  }

  Motion motionOf(Eigen::Index i) const {
    const btRigidBody& body = *bodies_[static_cast<std::size_t>(i)];
    const btQuaternion q = body.getOrientation();
    return {vectorOf(body.getCenterOfMassPosition()),
            Quaterniond(q.w(), q.x(), q.y(), q.z()).normalized(),
            vectorOf(body.getLinearVelocity()), vectorOf(body.getAngularVelocity())};
  }

  const Scene& scene() const { return scene_; }
  const std::vector<std::unique_ptr<btRigidBody>>& all() const { return bodies_; }

 private:
  Scene scene_;
  btEmptyShape shape_;
  std::vector<std::unique_ptr<btRigidBody>> bodies_;
};

/// What a world does for a body without contacts, in its order, without a world: of all ways the
/// fastest.
class PerBody {
 public:
  explicit PerBody(const Scene& scene) : bodies_(scene) {
    for (const auto& body : bodies_.all()) body->setGravity(vectorOf(scene.g_W));
  }
  void reset() { bodies_.reset(); }
  Motion motionOf(Eigen::Index i) const { return bodies_.motionOf(i); }

  void step(int steps) {
    const Scene& scene = bodies_.scene();
    const auto step_s = static_cast<btScalar>(scene.step_s);
    const bool is_gyroscopic = scene.load.gyroscopic == Gyroscopic::kOn;
    btTransform next;
    for (int k = 0; k < steps; ++k) {
      for (std::size_t i = 0; i < bodies_.all().size(); ++i) {
        btRigidBody& body = *bodies_.all()[i];
        if (scene.load.has_wrenches) bodies_.push(i);
        body.applyGravity();
        const btVector3 turn =
            is_gyroscopic ? body.computeGyroscopicImpulseImplicit_Body(step_s) : btVector3(0, 0, 0);
        body.integrateVelocities(step_s);
        // As the solver does: the gyroscopic change is that of the rate before the step.
        if (is_gyroscopic) body.setAngularVelocity(body.getAngularVelocity() + turn);
        body.predictIntegratedTransform(step_s, next);
        body.proceedToTransform(next);
        body.clearForces();
      }
    }
  }

 private:
  BulletBodies bodies_;
};

enum class Collisions { kOn, kOff };

/// A world whose stages of collision can be left out.
class World : public btDiscreteDynamicsWorld {
 public:
  World(btDispatcher* dispatcher, btBroadphaseInterface* broadphase, btConstraintSolver* solver,
        btCollisionConfiguration* configuration, Collisions collisions)
      : btDiscreteDynamicsWorld(dispatcher, broadphase, solver, configuration),
        has_collisions_(collisions == Collisions::kOn) {}

  void performDiscreteCollisionDetection() override {
    if (has_collisions_) btDiscreteDynamicsWorld::performDiscreteCollisionDetection();
  }
  void createPredictiveContacts(btScalar step_s) override {
    if (has_collisions_) btDiscreteDynamicsWorld::createPredictiveContacts(step_s);
  }

 private:
  bool has_collisions_;
};

class InWorld {
 public:
  InWorld(const Scene& scene, Collisions collisions)
      : bodies_(scene),
        dispatcher_(&configuration_),
        world_(&dispatcher_, &broadphase_, &solver_, &configuration_, collisions) {
    world_.setGravity(vectorOf(scene.g_W));
    // All bodies to the solver at once: nothing joins them that would have to be sorted.
    if (collisions == Collisions::kOff) world_.getSimulationIslandManager()->setSplitIslands(false);
    for (const auto& body : bodies_.all()) world_.addRigidBody(body.get());
  }
  InWorld(const InWorld&) = delete;
  InWorld& operator=(const InWorld&) = delete;

  void reset() { bodies_.reset(); }
  Motion motionOf(Eigen::Index i) const { return bodies_.motionOf(i); }

  void step(int steps) {
    const auto step_s = static_cast<btScalar>(bodies_.scene().step_s);
    for (int k = 0; k < steps; ++k) {
      if (bodies_.scene().load.has_wrenches)
        for (std::size_t i = 0; i < bodies_.all().size(); ++i) bodies_.push(i);
      world_.stepSimulation(step_s, 0);  // exactly one step, of this length
    }
  }

 private:
  BulletBodies bodies_;  // outlive the world: removing one takes a search through all
  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_;
  btDbvtBroadphase broadphase_;
  btSequentialImpulseConstraintSolver solver_;
  World world_;
};

}  // namespace

std::vector<PeerRow> peerRows() {
  const std::string bits = sizeof(btScalar) == 4 ? " f32" : " f64";
  const std::string engine = "Bullet " ENGINE_VERSION + bits;
  PeerRow stock = {engine, "world", "`stepSimulation` as it is", [](const Scene& scene) {
                     return peerOf(std::make_shared<InWorld>(scene, Collisions::kOn));
                   }};
  if (sizeof(btScalar) == 8) stock.hard_cases = "Bullet";
  return {{engine, "per body", "the integration calls of each body, without a world",
           [](const Scene& scene) { return peerOf(std::make_shared<PerBody>(scene)); }},
          {engine, "world, bare", "`stepSimulation` without its stages of collision",
           [](const Scene& scene) {
             return peerOf(std::make_shared<InWorld>(scene, Collisions::kOff));
           }},
          stock};
}

}  // namespace rigid_body_sim::bench

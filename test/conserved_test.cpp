#include "rigid_body_sim/conserved.hpp"

#include "generic.hpp"

namespace rigid_body_sim {
namespace {

const Vector3d kPoint(-0.8, 1.4, 0.3);
const Vector3d kDirection(0.6, -1.1, 0.4);

/// A body made of particles, in motion: what it conserves must be what its particles do.
struct MovingParticles {
  std::vector<Particle> particles = {{0.7, {0.3, -1.1, 0.4}},
                                     {1.9, {-0.8, 0.2, 1.3}},
                                     {0.4, {1.5, 0.9, -0.6}},
                                     {2.2, {-0.1, -0.7, -1.2}}};
  Vector3d v_WBcm = {0.4, -1.1, 0.6};
  Vector3d w_WB_L = {1.3, 0.7, -0.9};
  MassProperties mass_properties = massPropertiesOfParticles(particles);
  BodyFrame frame = bodyFrame(mass_properties);
  BodyState state = stateOfLink(frame, genericPose(), v_WBcm, w_WB_L);

  Vector3d position(const Particle& particle) const { return genericPose() * particle.p_FQ; }
  Vector3d velocityOf(const Particle& particle) const {
    return v_WBcm + (genericPose().linear() * w_WB_L).cross(position(particle) - state.p_WBcm);
  }
  double size() const { return 100; }  // of the largest sums below, for their rounding
};

TEST(KineticEnergy, IsHalfTheSumOfMomentTimesRateSquared) {
  const BodyState body = {{}, Quaterniond::Identity(), {3, 0, 4}, {2, 6, -12}};
  // 25 / (2 * 5) + (4 / 1 + 36 / 2 + 144 / 3) / 2
  EXPECT_EQ(kineticEnergy(body, 5, {1, 2, 3}), 2.5 + 35);
}

TEST(KineticEnergy, IsThatOfTheParticles) {
  const MovingParticles body;
  double expected = 0;
  for (const Particle& particle : body.particles)
    expected += 0.5 * particle.mass * body.velocityOf(particle).squaredNorm();
  EXPECT_NEAR(kineticEnergy(body.state, body.frame.mass, body.frame.I_BBcm_B), expected,
              body.size() * 8 * kEps);
}

TEST(LinearMomentum, IsThatOfTheParticles) {
  const MovingParticles body;
  Vector3d expected = Vector3d::Zero();
  for (const Particle& particle : body.particles)
    expected += particle.mass * body.velocityOf(particle);
  EXPECT_LE(difference(body.state.P_WB, expected), body.size() * 8 * kEps);
}

TEST(AngularMomentum, AboutAnyPointIsThatOfTheParticles) {
  const MovingParticles body;
  for (const Vector3d& p_WO : {Vector3d(0, 0, 0), kPoint, body.state.p_WBcm}) {
    Vector3d expected = Vector3d::Zero();
    for (const Particle& particle : body.particles)
      expected += particle.mass * (body.position(particle) - p_WO).cross(body.velocityOf(particle));
    EXPECT_LE(difference(angularMomentumAboutPoint(body.state, p_WO), expected),
              body.size() * 8 * kEps);
  }
}

TEST(AngularMomentum, AboutAnAxisIsThePartAlongItForEveryPointOfTheAxis) {
  const BodyState body = MovingParticles().state;
  const Vector3d u = kDirection.normalized();
  const Vector3d expected = angularMomentumAboutPoint(body, kPoint).dot(u) * u;
  const double tolerance = 64 * kEps * 10;
  EXPECT_LE(difference(angularMomentumAboutAxis(body, kPoint, kDirection), expected), tolerance);
  EXPECT_LE(difference(angularMomentumAboutAxis(body, kPoint + 3 * kDirection, -7 * kDirection),
                       expected),
            tolerance);
  EXPECT_GT(difference(angularMomentumAboutAxis(body, {0, 0, 0}, kDirection), expected), 0.1);
}

TEST(AngularMomentum, OfAParticleIsArmCrossMomentum) {
  const BodyState particle = {{2, 0, 0}, Quaterniond::Identity(), {0, 3, 0}, {0, 0, 0}};
  EXPECT_EQ(angularMomentumAboutPoint(particle, {0, 0, 0}), Vector3d(0, 0, 6));
  EXPECT_EQ(angularMomentumAboutPoint(particle, {5, 1, 0}), Vector3d(0, 0, -9));
}

TEST(AngularMomentum, AboutAFixedPointStaysInFreeFlight) {
  Simulator simulator(sceneOf(genericSceneBody("b")));
  const Vector3d about_point = angularMomentumAboutPoint(simulator.state(0), kPoint);
  for (int i = 0; i < 500; ++i) simulator.step();
  // The spin is constant to the bit; the position takes 500 sums of up to 15 m, momentum is 3.5.
  EXPECT_LE(difference(angularMomentumAboutPoint(simulator.state(0), kPoint), about_point),
            500 * 15 * 3.5 * 0.5 * kEps);
}

TEST(AngularMomentum, ChangesByTheMomentOfTheImpulseAboutAnyPoint) {
  // dL = M dt about a point and about an axis, with an impulse J at Q and a free angular impulse.
  const MovingParticles body;
  const Vector3d J_W(1.2, -0.5, 0.9), angular_W(0.3, 0.2, -0.7), p_BcmQ_B(0.4, -0.6, 0.2);
  const Wrench impulse =
      inWorldAboutCom({Axes::kWorld, {J_W, angular_W}, p_BcmQ_B}, body.state.q_WB);
  BodyState after = body.state;
  after.P_WB += impulse.f_F;
  after.L_WBcm_W += impulse.t_Q_F;
  const Vector3d p_WQ = body.state.p_WBcm + body.state.q_WB * p_BcmQ_B;
  const Vector3d moment = momentAboutPoint(p_WQ - kPoint, J_W) + angular_W;
  EXPECT_LE(difference(angularMomentumAboutPoint(after, kPoint) -
                           angularMomentumAboutPoint(body.state, kPoint),
                       moment),
            body.size() * 8 * kEps);
  const Vector3d u = kDirection.normalized();
  EXPECT_LE(difference(angularMomentumAboutAxis(after, kPoint, kDirection) -
                           angularMomentumAboutAxis(body.state, kPoint, kDirection),
                       Vector3d(moment.dot(u) * u)),
            body.size() * 8 * kEps);
}

TEST(AngularMomentum, GrowsByTheTimeIntegralOfTheMomentOfAConstantForce) {
  // A particle under a constant force: M = (p_0 + v t + a t^2 / 2) x F is linear in t but for a x
  // F, which vanishes; its integral is (p_0 T + v T^2 / 2) x F.
  SceneBody particle;
  particle.name = "p";
  particle.is_point_mass = true;
  particle.mass_properties.mass = 0.7;
  particle.X_WL.translation() << 1, -2, 0.5;
  particle.v_WBcm << 0.3, 0.8, -0.4;
  Simulator simulator(sceneOf(particle));
  const Vector3d f_W(0.6, -0.2, 1.1);
  WrenchInput push;
  push.applied.wrench.f_F = f_W;
  simulator.apply(push);
  const Vector3d before = angularMomentumAboutPoint(simulator.state(0), kPoint);
  const int steps = 100;
  for (int i = 0; i < steps; ++i) simulator.step();
  const double T = steps * 0.02;
  const Vector3d p_OA = particle.X_WL.translation() - kPoint;
  const Vector3d integral = (T * p_OA + 0.5 * T * T * particle.v_WBcm).cross(f_W);
  const Vector3d after = angularMomentumAboutPoint(simulator.state(0), kPoint);
  // Two sums a step of momentum and position, each up to 10.
  EXPECT_LE(difference(after - before, integral), 2 * steps * 10 * kEps);
}

}  // namespace
}  // namespace rigid_body_sim

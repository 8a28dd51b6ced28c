#include "core/suitability.hpp"
#include "flown_scenes.hpp"

namespace rigid_body_sim {
namespace {

const Vector3d kTurn(0.21, -0.34, 0.57);  // [rad/s]

std::string textOf(const Vector3d& v) {
  std::ostringstream text;
  text.precision(17);
  text << std::showpoint << "[" << v.x() << ", " << v.y() << ", " << v.z() << "]";
  return text.str();
}

Scene turning(const Vector3d& w_W, const std::string& body = genericBodyNamed("b"),
              const std::string& more = "") {
  return sceneFrom("{bodies: {" + body + "}, effects: {rotating_frame: {angular_velocity: " +
                   textOf(w_W) + "}" + more + "}}");
}

/// The state seen from inertial axes that coincide with W now, and back.
BodyState absolute(BodyState body, double mass, const Vector3d& I, const Vector3d& w_W) {
  body.P_WB += mass * w_W.cross(body.p_WBcm);
  body.L_WBcm_W += body.q_WB * I.cwiseProduct(body.q_WB.conjugate() * w_W);
  return body;
}

/// The inertial state after `time_s` as the world that turned meanwhile sees it.
BodyState seenFrom(BodyState body, double mass, const Vector3d& I, const Vector3d& w_W,
                   double time_s) {
  const Quaterniond back(Eigen::AngleAxisd(-time_s * w_W.norm(), w_W.normalized()));
  body.p_WBcm = back * body.p_WBcm;
  body.P_WB = back * body.P_WB;
  body.L_WBcm_W = back * body.L_WBcm_W;
  body.q_WB = back * body.q_WB;
  return absolute(body, mass, I, -w_W);
}

double distance(const BodyState& a, const BodyState& b) {
  return std::max({angleBetween(a.q_WB, b.q_WB), difference(a.p_WBcm, b.p_WBcm),
                   difference(a.P_WB, b.P_WB), difference(a.L_WBcm_W, b.L_WBcm_W)});
}

/// Free flight of the only body of `scene`, in one exact step of inertial space.
BodyState freeFlight(const Scene& scene, double time_s) {
  const Simulator start(scene);
  const double mass = start.bodies().mass(0);
  const Vector3d I = start.bodies().moments(0);
  Bodies bodies = start.bodies();
  bodies.setState(0, absolute(start.state(0), mass, I, kTurn));
  ActiveEffects none;
  integratorNamed("exact").make({})->step(bodies, none, 0, time_s);
  return seenFrom(bodies.state(0), mass, I, kTurn, time_s);
}

TEST(RotatingFrame, FreeFlightIsExactAtAnyStep) {
  const Scene scene = turning(kTurn);
  const BodyState expected = freeFlight(scene, 100);
  // Rounding: P is some 250 kg m/s, rounded to kEps at each of up to 30000 drifts, each time in
  // another direction; measured: 8e-11.
  for (const int steps : {1, 10, 5000})
    for (const std::string name : {"exact", "exact4", "exact6"}) {
      const double error = distance(flown(scene, name, 100, steps).state(0), expected);
      RecordProperty(name + "_" + std::to_string(steps), std::to_string(error * 1e12) + "e-12");
      EXPECT_LE(error, 3e-10) << name << " " << steps;
    }
}

TEST(RotatingFrame, AttitudeOfAFreeTriaxialBodyIsThatOfTheInertialFlightTurnedBack) {
  const Scene scene = turning(kTurn);
  const double error =
      angleBetween(flown(scene, "exact", 100, 5000).state(0).q_WB, freeFlight(scene, 100).q_WB);
  RecordProperty("error", std::to_string(error * 1e15) + "e-15");
  EXPECT_LE(error, 4e-12);  // measured: 7e-13, from roundings of L that turn it for 100 s
}

TEST(RotatingFrame, ABodyAtRestInInertialSpaceMovesInACircle) {
  Scene scene = turning(kTurn);
  const Vector3d p = bodyFrame(scene.bodies[0]).p_LBcm, p_W = scene.bodies[0].X_WL * p;
  scene.bodies[0].v_WBcm = -kTurn.cross(p_W);
  scene.bodies[0].w_WB_L = -(scene.bodies[0].X_WL.linear().transpose() * kTurn);
  const Quaterniond q_WB = Simulator(scene).state(0).q_WB;
  for (const std::string name : {"semi_implicit", "split2", "exact", "exact6"}) {
    const Simulator end = flown(scene, name, 10, 100);
    const Quaterniond back(Eigen::AngleAxisd(-10 * kTurn.norm(), kTurn.normalized()));
    // A rest that is a rounding off moves; measured: 4e-15 m, and 3e-13 rad with exact6, whose
    // drifts there and back are 26 s long.
    EXPECT_LE(difference(end.state(0).p_WBcm, back * p_W), 1e-13) << name;
    EXPECT_LE(angleBetween(end.state(0).q_WB, back * q_WB), 1e-12) << name;
  }
}

TEST(RotatingFrame, AttitudeOfABodyAtRestInInertialSpaceStaysAUnitQuaternion) {
  // No drift turns it, so that none brings its length back to one.
  Scene scene = turning({0, 0, 0.75}, "b: {mass: 1, inertia: [1, 2, 2]}");
  scene.bodies[0].w_WB_L << 0, 0, -0.75;
  Simulator simulator(scene);
  simulator.advance(1'000'000);
  const Quaterniond q_WB = simulator.state(0).q_WB;
  EXPECT_EQ(simulator.state(0).L_WBcm_W, Vector3d(0, 0, -1.5));
  EXPECT_LE(std::abs(q_WB.norm() - 1), 4 * kEps);
  // The quaternion of a step is rounded by 1e-16 of 0.0075 in its small part.
  const Quaterniond expected(Eigen::AngleAxisd(-0.75 * 0.02 * 1e6, Vector3d::UnitZ()));
  EXPECT_LE(angleBetween(q_WB, expected), 15000 * kEps);
}

TEST(RotatingFrame, ADayAtTheEarthsRateLosesNothingToOneSide) {
  const double rate = 7.292115e-5, day_s = 86400;
  const Vector3d Omega = rate * Vector3d(0.48, -0.6, 0.64), p(4.2e6, -3.1e6, 3.7e6);
  Scene scene = turning(Omega, "b: {point_mass: 2.5}");
  scene.bodies[0].X_WL.translation() = p;
  scene.bodies[0].v_WBcm = -Omega.cross(p);
  Simulator simulator(scene);
  simulator.advance(static_cast<Tick>(day_s / 0.02));
  const Vector3d end = simulator.state(0).p_WBcm;
  const Vector3d expected = Eigen::AngleAxisd(-rate * day_s, Omega.normalized()) * p;
  const double along = (end - expected).norm() / p.norm(), length = end.norm() / p.norm() - 1;
  RecordProperty("along", std::to_string(along * 1e15) + "e-15");
  RecordProperty("length", std::to_string(length * 1e15) + "e-15");
  // Measured: 3.8e-14 along; 3.0e-13 if p_low is lost, 7e-11 if R is rounded to one side.
  EXPECT_LE(along, 1e-13);
  EXPECT_LE(std::abs(length), 1e-13);
}

TEST(RotatingFrame, ForcesAreThoseOfCoriolisAndCentrifugal) {
  const Scene scene = turning(kTurn,
                              "b: {point_mass: 2.5, position: [1.0, -2.0, 0.5], "
                              "linear_velocity: [0.3, 0.7, -1.1]}");
  const Simulator simulator(scene);
  const Wrenches wrenches = simulator.effectWrenches()[0].wrenches;
  const Vector3d p(1, -2, 0.5), v(0.3, 0.7, -1.1);
  // a x (a x p) = a (a.p) - p a^2
  const Vector3d expected =
      -2.5 * (2 * kTurn.cross(v) + kTurn * kTurn.dot(p) - p * kTurn.squaredNorm());
  EXPECT_LE(difference(Vector3d(wrenches.f_W.row(0)), expected), 1e-14);
  EXPECT_TRUE(wrenches.t_Bcm_W.isZero(0));
}

TEST(RotatingFrame, APointMassKeepsItsAxes) {
  const Scene scene = turning(kTurn, "b: {point_mass: 2.5, position: [1.0, -2.0, 0.5]}");
  for (const std::string name : {"exact", "rk4"}) {
    const Simulator end = flown(scene, name, 1, 100);
    EXPECT_TRUE(end.state(0).L_WBcm_W.isZero(0)) << name;
    EXPECT_EQ(end.state(0).q_WB.coeffs(), Quaterniond::Identity().coeffs()) << name;
  }
}

TEST(RotatingFrame, AFallingStoneIsDeflectedToTheEast) {
  // Coriolis to first order, g w t^3/3 (Gauss 1803); the next order is w t of it. W: x east, z up.
  const double w = 1e-5, t = 4;
  const Scene scene =
      turning({0, w, 0}, "b: {point_mass: 1.0}", ", gravity: {acceleration: [0, 0, -9.8]}");
  const double east = flown(scene, "exact4", t, 40).state(0).p_WBcm.x();
  EXPECT_NEAR(east, 9.8 * w * t * t * t / 3, w * t * east);
}

/// The plane of a pendulum of all directions stands still in inertial space (Foucault 1851).
BodyState foucault(const Scene& scene, double stiffness, double time_s) {
  const Simulator start(scene);
  const double mass = start.bodies().mass(0), rate = std::sqrt(stiffness / mass);
  const Vector3d I = start.bodies().moments(0);
  BodyState body = absolute(start.state(0), mass, I, kTurn);
  Bodies bodies = start.bodies();
  bodies.setState(0, body);
  ActiveEffects none;
  integratorNamed("exact").make({})->step(bodies, none, 0, time_s);  // for the attitude
  const double c = std::cos(rate * time_s), s = std::sin(rate * time_s);
  const Vector3d p = body.p_WBcm, P = body.P_WB;
  body = bodies.state(0);
  body.p_WBcm = c * p + s / (mass * rate) * P;
  body.P_WB = c * P - s * mass * rate * p;
  return seenFrom(body, mass, I, kTurn, time_s);
}

TEST(RotatingFrame, FoucaultsPendulumHasEveryMethodsOrder) {
  const Scene scene = turning(kTurn, genericBodyNamed("b"),
                              ", spring: [{body: b, anchor: [0, 0, 0], stiffness: 12.0}]");
  const BodyState expected = foucault(scene, 12, kTime);
  for (const auto& [name, order] : std::vector<std::pair<std::string, int>>{{"semi_implicit", 1},
                                                                            {"split2", 2},
                                                                            {"exact", 2},
                                                                            {"exact4", 4},
                                                                            {"exact6", 6},
                                                                            {"rk4", 4},
                                                                            {"rk8", 8}}) {
    const std::string integrator = name;
    const auto error = [&](int steps) {
      return distance(flown(scene, integrator, kTime, steps).state(0), expected);
    };
    const double slope = slopeOf(error, order >= 6 ? 8 : 64, order >= 6 ? 1e-10 : 1e-9);
    RecordProperty(name, std::to_string(slope));
    EXPECT_NEAR(slope, order, order >= 6 ? 0.5 : 0.15) << name;
  }
  EXPECT_LE(distance(flown(scene, "adaptive", kTime, 2).state(0), expected), 1e-11);
}

TEST(RotatingFrame, ExactMethodsKeepTheirOrderUnderTorques) {
  const Scene scene =
      turning(kTurn, genericBodyNamed("b"),
              ", spring: [{body: b, point: [0.3, 0.5, -0.2], anchor: [1, 2, 0], stiffness: 12.0, "
              "rest_length: 0.5}]");
  const Bodies truth = flown(scene, "adaptive", kTime, 2).bodies();
  for (const auto& [name, order] : std::vector<std::pair<std::string, int>>{
           {"exact", 2}, {"exact4", 4}, {"exact6", 6}, {"rk4", 4}}) {
    const std::string integrator = name;
    const auto error = [&](int steps) {
      return rigid_body_sim::distance(flown(scene, integrator, kTime, steps).bodies(), truth);
    };
    const double slope = slopeOf(error, order == 6 ? 16 : 64, order == 6 ? 1e-10 : 1e-8);
    RecordProperty(name, std::to_string(slope));
    EXPECT_NEAR(slope, order, order == 6 ? 0.5 : 0.15) << name;
  }
  // With the flow these have no caution to give.
  EXPECT_TRUE(flown(scene, "exact6", kTime, 64).scene().warnings.empty());
}

TEST(RotatingFrame, ThatTurnsFarInAStepIsSaidToFalsifyForces) {
  // A steady force of 1 N for a step of x = 0.8 rad, on a mass at rest: by closed form the turning
  // momentum is f sin(x/2) / (x/2) h in size; two half kicks make f cos(x/2) h.
  const auto text = [](double omega, int substeps) {
    return "{substeps: " + std::to_string(substeps) +
           ", effects: {rotating_frame: " + "{angular_velocity: [0, 0, " + std::to_string(omega) +
           "]}}, bodies: {a: {point_mass: 1}}}";
  };
  EXPECT_TRUE(Simulator(sceneFrom(text(20, 1))).scene().warnings.empty());  // 0.4 rad
  Simulator simulator(sceneFrom(text(40, 1)));
  ASSERT_EQ(simulator.scene().warnings.size(), 1u);
  EXPECT_TRUE(contains(simulator.scene().warnings[0],
                       {"'rotating_frame' turns by 0.8 rad a step", "94.6", "with 3 substeps"}));
  EXPECT_TRUE(Simulator(sceneFrom(text(40, 3))).scene().warnings.empty());
  WrenchInput push;
  push.applied = {Axes::kWorld, {{1, 0, 0}, {0, 0, 0}}, {0, 0, 0}};
  push.ticks = 1;
  simulator.apply(push);
  simulator.step();
  const BodyState end = simulator.state(0);
  const Vector3d absolute = end.P_WB + Vector3d(0, 0, 40).cross(end.p_WBcm);
  EXPECT_NEAR(absolute.norm() / 0.02 / (std::sin(0.4) / 0.4), 0.946, 5e-4);
}

TEST(RotatingFrame, JacobisEnergyIsKept) {
  const Scene free = turning(kTurn);
  const double start = totalEnergy(Simulator(free));
  EXPECT_NEAR(totalEnergy(flown(free, "exact", 100, 100)), start, 1e-10);
  EXPECT_NEAR(totalEnergy(flown(free, "rk8", 10, 1000)), start, 1e-10);
  const Scene scene =
      turning(kTurn, genericBodyNamed("b"),
              ", spring: [{body: b, point: [0.3, 0.5, -0.2], anchor: [1, 2, 0], stiffness: 12.0}]");
  const auto error = [&](int steps) {
    return std::abs(totalEnergy(flown(scene, "exact", kTime, steps)) -
                    totalEnergy(Simulator(scene)));
  };
  EXPECT_NEAR(slopeOf(error, 128, 1e-8), 2, 0.2);
}

TEST(RotatingFrame, GradientOfThePotentialIsTheWrenchAtRest) {
  const Scene scene = turning(kTurn);
  expectPotentialGivesWrench(*scene.effects[0], Simulator(scene).bodies(), 1e-10);
}

TEST(RotatingFrame, OtherFlowsSeeVelocitiesRelativeToTheWorld) {
  // Damping's wrenches are of the relative momenta; so must be its flow, which stands around the
  // one of the frame wherever the scene lists it.
  const Scene scene =
      turning(kTurn, genericBodyNamed("b"), ", damping: {linear: 0.8, angular: 0.5}");
  const Bodies truth = flown(scene, "adaptive", kTime, 2).bodies();
  const auto error = [&](int steps) {
    return rigid_body_sim::distance(flown(scene, "exact", kTime, steps).bodies(), truth);
  };
  EXPECT_NEAR(slopeOf(error, 64, 1e-6), 2, 0.1);
}

TEST(RotatingFrame, RestrictedToSomeBodiesIsTheSame) {
  const Scene scene = turning(
      kTurn, genericBodyNamed("a") + ", " + otherBodyNamed("b") + ", " + genericBodyNamed("c"));
  const Simulator simulator(scene);
  const Bodies rows = rowsOf(simulator.bodies(), {2, 1});
  const auto some = scene.effects[0]->restrictedTo({2, 1});
  ASSERT_NE(some, nullptr);
  EXPECT_EQ(some->bodyCount(), 2u);
  Wrenches whole, part;
  whole.setZero(3);
  part.setZero(2);
  scene.effects[0]->addWrenches(Instant(simulator.bodies(), 0), whole);
  some->addWrenches(Instant(rows, 0), part);
  for (int k = 0; k < 2; ++k) {
    EXPECT_EQ(Vector3d(part.f_W.row(k)), Vector3d(whole.f_W.row(2 - k)));
    EXPECT_EQ(Vector3d(part.t_Bcm_W.row(k)), Vector3d(whole.t_Bcm_W.row(2 - k)));
  }
}

TEST(RotatingFrame, FlowRunsBack) {
  const Scene scene = turning(kTurn);
  const Simulator simulator(scene);
  Bodies bodies = simulator.bodies();
  const auto integrator = integratorNamed("exact").make({});
  ActiveEffects effects;
  effects.add(scene.effects[0].get());
  integrator->step(bodies, effects, 0, 0.7);
  EXPECT_GT(distance(bodies.state(0), simulator.state(0)), 0.1);
  integrator->step(bodies, effects, 0.7, -0.7);
  EXPECT_LE(distance(bodies.state(0), simulator.state(0)), 1e-14);
}

TEST(RotatingFrame, TurnsForAllBodiesOrForNone) {
  EXPECT_TRUE(contains(refusal([] {
                         turning(kTurn, genericBodyNamed("a") + ", " +
                                            otherBodyNamed("b", ", rotating_frame: false"));
                       }),
                       {"bodies.b.rotating_frame", "false", "all bodies"}));
}

TEST(RotatingFrame, NeedsTheGyroscopicTerm) {
  const Scene scene = turning(kTurn, genericBodyNamed("b", ", gyroscopic: false"));
  EXPECT_TRUE(
      contains(refusal([&] { Simulator{scene}; }), {"'rotating_frame'", "gyroscopic", "'b'"}));
  const Scene all = turning(kTurn, genericBodyNamed("b"), ", gyroscopic: false");
  EXPECT_TRUE(contains(refusal([&] { Simulator{all}; }), {"'rotating_frame'", "'b'"}));
  Simulator simulator(turning(kTurn));
  EXPECT_TRUE(contains(refusal([&] { simulator.switchEffect("gyroscopic", false); }),
                       {"'rotating_frame'"}));
  simulator.switchEffect("rotating_frame", false);
  EXPECT_NO_THROW(simulator.switchEffect("gyroscopic", false));
}

TEST(RotatingFrame, IsNotForAddedMass) {
  EXPECT_TRUE(contains(
      refusal([] { turning(kTurn, genericBodyNamed("b"), ", added_mass: {linear: [1, 1, 1]}"); }),
      {"bodies.b.added_mass", "rotating_frame"}));
}

TEST(RotatingFrame, TooFastForARungeKuttaStepIsRefusedWithTheLargest) {
  const Scene scene = turning({0, 0, 100});
  EXPECT_NO_THROW(flown(scene, "exact", 1, 10));
  EXPECT_TRUE(contains(refusal([&] { flown(scene, "rk4", 1, 10); }),
                       {"'rotating_frame'", "may swing at 200 rad/s", "0.0141 s", "or exact"}));
}

TEST(RotatingFrame, WithoutTurningIsNotMade) {
  const Scene scene = turning(Vector3d::Zero());
  EXPECT_TRUE(scene.effects.empty());
  EXPECT_EQ(scene.elided.size(), 1u);
}

TEST(RotatingFrame, BadParametersAreRefusedWithPathValueAndUnit) {
  const auto what = [](const std::string& block) {
    return refusal([&] {
      sceneFrom("{bodies: {" + genericBodyNamed("a") + "}, effects: {rotating_frame: " + block +
                "}}");
    });
  };
  EXPECT_TRUE(contains(what("{}"), {"effects.rotating_frame.angular_velocity", "missing"}));
  EXPECT_TRUE(contains(what("{angular_velocity: [1, 2, .inf]}"),
                       {"effects.rotating_frame.angular_velocity", "inf", "rad/s"}));
  EXPECT_TRUE(contains(what("{angular_velocity: [1, 2, 3], rate: 2}"), {"rate", "unknown"}));
}

}  // namespace
}  // namespace rigid_body_sim

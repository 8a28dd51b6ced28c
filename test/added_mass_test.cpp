#include "core/suitability.hpp"
#include "flown_scenes.hpp"

namespace rigid_body_sim {
namespace {

const std::string kLinear = "[3.1, 0.8, 5.2]", kAngular = "[0.4, 0.9, 0.2]";

/// A body of no special shape with another mass along each axis of its root link.
Scene submerged(const std::string& more = "") {
  return sceneFrom("{bodies: {" + genericBodyNamed("b") + "}, effects: {added_mass: {linear: " +
                   kLinear + ", angular: " + kAngular + "}" + more + "}}");
}

/// An ellipsoid-like body with principal axes along its link: mass 2 kg, moments 0.5, 0.8, 0.9 and
/// added mass 1, 3, 6 kg. It starts along link axis x, y or z turned by `turn` about z.
Scene ellipsoid(const Vector3d& v_W, double turn) {
  Scene scene = sceneFrom(
      "{bodies: {b: {mass: 2.0, inertia: [0.5, 0.8, 0.9]}}, effects: "
      "{added_mass: {linear: [1.0, 3.0, 6.0]}}}");
  scene.bodies[0].X_WL.linear() = Eigen::AngleAxisd(turn, Vector3d::UnitZ()).toRotationMatrix();
  scene.bodies[0].v_WBcm = v_W;
  return scene;
}

TEST(AddedMass, ASphereIsAsHeavyAsHalfItsFluidMore) {
  // a = F/(m + rho V/2): here a hundred times the body's own mass, in steps of 0.1 s.
  const double radius = 0.3, density = 100 * 2.7 / (2.0 / 3 * kPi * 0.027);
  std::ostringstream sphere;
  sphere.precision(17);
  sphere << "{radius: " << radius << ", fluid_density: " << density << "}";
  const Scene scene = sceneFrom("{bodies: {" + genericBodyNamed("b") +
                                "}, effects: {added_mass: {sphere: " + sphere.str() +
                                "}, gravity: {acceleration: [1.0, -2.0, -9.0]}}}");
  const Vector3d a = Vector3d(1, -2, -9) / 101;
  for (const IntegratorRow& row : integrators()) {
    if (row.order == 1) continue;  // Euler's parabola is not exact
    const Simulator start(scene), end = flown(scene, row.name, 10, 100);
    const Vector3d p = start.state(0).p_WBcm + 10 * Vector3d(0.4, -1.1, 0.6) + 50 * a;
    EXPECT_LE(difference(end.state(0).p_WBcm, p), 1e-12) << row.name;
    EXPECT_LE(difference(end.bodies().v_WBcm(0), Vector3d(0.4, -1.1, 0.6) + 10 * a), 1e-13);
  }
}

TEST(AddedMass, OfASphereLetsABodyTurnFreely) {
  const Scene free = sceneFrom("{bodies: {" + genericBodyNamed("b") + "}}");
  const Scene scene = sceneFrom("{bodies: {" + genericBodyNamed("b") +
                                "}, effects: {added_mass: {linear: [7.0, 7.0, 7.0]}}}");
  for (const std::string name : {"exact", "exact6", "rk8"}) {
    const Simulator a = flown(scene, name, 10, 500), b = flown(free, name, 10, 500);
    EXPECT_LE(angleBetween(a.state(0).q_WB, b.state(0).q_WB), 1e-12) << name;
    EXPECT_LE(difference(a.state(0).p_WBcm, b.state(0).p_WBcm), 1e-12) << name;
    EXPECT_TRUE(a.scene().warnings.empty());
  }
}

TEST(AddedMass, VelocitiesAreThoseGivenAndShown) {
  const Simulator simulator(submerged());
  EXPECT_LE(difference(simulator.bodies().v_WBcm(0), Vector3d(0.4, -1.1, 0.6)), 1e-14);
  const LinkMotion link = simulator.linkMotion(0);
  EXPECT_LE(difference(link.w_WL_L, Vector3d(1.3, 0.7, -0.9)), 1e-14);
  const Vector3d v_WBcm =
      link.q_WL * velocityOfPoint(link.v_WL_L, link.w_WL_L, Vector3d(0.11, -0.23, 0.37));
  EXPECT_LE(difference(v_WBcm, Vector3d(0.4, -1.1, 0.6)), 1e-14);
  // P = R (m + M_A) R^T v along the link's axes, L likewise.
  const Vector3d v_L = link.q_WL.conjugate() * Vector3d(0.4, -1.1, 0.6);
  const Vector3d P_L = Vector3d(2.7 + 3.1, 2.7 + 0.8, 2.7 + 5.2).cwiseProduct(v_L);
  EXPECT_LE(difference(simulator.state(0).P_WB, link.q_WL * P_L), 1e-14);
  Matrix3d I_L = genericBody().I_BBcm_F;
  I_L.diagonal() += Vector3d(0.4, 0.9, 0.2);
  EXPECT_LE(difference(simulator.state(0).L_WBcm_W, link.q_WL * (I_L * Vector3d(1.3, 0.7, -0.9))),
            1e-14);
}

TEST(AddedMass, OfOneBodyIsNotThatOfTheNext) {
  const Simulator simulator(
      sceneFrom("{bodies: {" + genericBodyNamed("a", ", added_mass: {linear: [1.0, 2.0, 3.0]}") +
                ", " + otherBodyNamed("b") + "}, effects: {added_mass: {}}}"));
  EXPECT_LE(difference(simulator.bodies().v_WBcm(1), Vector3d(-0.3, 0.2, 0.8)), 1e-15);
  EXPECT_EQ(simulator.scene().effects[0]->bodyCount(), 1u);
}

/// Kirchhoff's equations in their own form, in body axes: P' = P x w, L' = L x w + P x v; by the
/// classical Runge-Kutta method, with the attitude from R' = R [w].
struct Kirchhoff {
  Vector3d P, L, p;
  Matrix3d R;

  Kirchhoff rates(const Matrix3d& inverse_mass, const Vector3d& I) const {
    const Vector3d v = inverse_mass * P, w = L.cwiseQuotient(I);
    Matrix3d cross;
    cross << 0, -w.z(), w.y(), w.z(), 0, -w.x(), -w.y(), w.x(), 0;
    return {P.cross(w), L.cross(w) + P.cross(v), R * v, R * cross};
  }
  Kirchhoff plus(double h, const Kirchhoff& k) const {
    return {P + h * k.P, L + h * k.L, p + h * k.p, R + h * k.R};
  }
};

BodyState kirchhoff(const Simulator& start, double time_s, int steps) {
  const BodyState body = start.state(0);
  const Eigen::Matrix<double, 9, 1> row = start.bodies().inverse_mass_B.row(0);
  const Matrix3d A = Eigen::Map<const Matrix3d>(row.data());
  const Vector3d I = start.bodies().moments(0);
  Kirchhoff x = {body.q_WB.conjugate() * body.P_WB, body.q_WB.conjugate() * body.L_WBcm_W,
                 body.p_WBcm, body.q_WB.toRotationMatrix()};
  const double h = time_s / steps;
  for (int i = 0; i < steps; ++i) {
    const Kirchhoff a = x.rates(A, I), b = x.plus(h / 2, a).rates(A, I),
                    c = x.plus(h / 2, b).rates(A, I), d = x.plus(h, c).rates(A, I);
    x = x.plus(h / 6, a).plus(h / 3, b).plus(h / 3, c).plus(h / 6, d);
  }
  return {x.p, Quaterniond(x.R).normalized(), x.R * x.P, x.R * x.L};
}

TEST(AddedMass, FliesByKirchhoffsEquationsWithTheMethodsOrder) {
  const Scene scene = submerged();
  Bodies truth = Simulator(scene).bodies();
  truth.setState(0, kirchhoff(Simulator(scene), kTime, 8192));  // (2.5e-4)^4: rounding
  EXPECT_LE(distance(flown(scene, "adaptive", kTime, 2).bodies(), truth), 2e-11);
  for (const auto& [name, order] : std::vector<std::pair<std::string, int>>{{"semi_implicit", 1},
                                                                            {"split2", 2},
                                                                            {"exact", 2},
                                                                            {"exact4", 2},
                                                                            {"rk4", 4},
                                                                            {"rk8", 8}}) {
    const std::string integrator = name;
    const auto error = [&](int steps) {
      return distance(flown(scene, integrator, kTime, steps).bodies(), truth);
    };
    const double slope = slopeOf(error, order == 8 ? 16 : 64, order == 8 ? 1e-9 : 1e-7);
    RecordProperty(name, std::to_string(slope));
    EXPECT_NEAR(slope, order, order == 8 ? 0.6 : 0.15) << name;
  }
}

TEST(AddedMass, MomentumAndAngularMomentumAboutTheWorldsOriginAreKept) {
  const Scene scene = submerged();
  const auto [P, L] = totalMomenta(Simulator(scene).bodies());
  for (const std::string name : {"semi_implicit", "split2", "exact", "exact4", "exact6"}) {
    const auto [P_end, L_end] = totalMomenta(flown(scene, name, 20, 1000).bodies());
    EXPECT_EQ(P_end, P) << name;
    EXPECT_LE(difference(L_end, L), 1e-11) << name;  // 1000 steps of kEps |p x P|, some 100
  }
}

TEST(AddedMass, EnergyErrorIsOfTheMethodsOrder) {
  const Scene scene = submerged();
  const double start = totalEnergy(Simulator(scene));
  for (const auto& [name, order] :
       std::vector<std::pair<std::string, int>>{{"split2", 2}, {"exact", 2}, {"rk4", 4}}) {
    const std::string integrator = name;
    const auto error = [&](int steps) {
      return std::abs(totalEnergy(flown(scene, integrator, kTime, steps)) - start);
    };
    const double slope = slopeOf(error, 64, order == 2 ? 1e-7 : 1e-10);
    RecordProperty(name, std::to_string(slope));
    EXPECT_NEAR(slope, order, order == 2 ? 0.15 : 1.1) << name;  // rk4's own is often of order 5
  }
}

TEST(AddedMass, EnergyOfExactHasNoTrend) {
  Scene scene = submerged();
  scene.integrator = "exact";
  Simulator simulator(scene);
  const double start = totalEnergy(simulator);
  double early = 0, worst = 0;
  for (int i = 0; i < 100'000; ++i) {
    simulator.step();
    worst = std::max(worst, std::abs(totalEnergy(simulator) - start));
    if (i == 999) early = worst;
  }
  RecordProperty("early", std::to_string(early));
  RecordProperty("worst", std::to_string(worst));
  EXPECT_LE(worst, 2 * early);  // measured: 1.0 times
}

TEST(AddedMass, AHundredTimesTheOwnMassIsStableInStepsOfATenthSecond) {
  for (const std::string name : {"semi_implicit", "split2", "exact"}) {
    const Scene scene = sceneFrom("{bodies: {" + genericBodyNamed("b") +
                                  "}, effects: {added_mass: {linear: [270.0, 250.0, 260.0], "
                                  "angular: [160.0, 200.0, 180.0]}}}");
    const double start = totalEnergy(Simulator(scene));
    const Simulator end = flown(scene, name, 1000, 10'000);
    EXPECT_NEAR(totalEnergy(end), start, 0.1 * start) << name;
  }
}

TEST(AddedMass, MovesOnSteadilyAlongEachPrincipalDirection) {
  for (int k = 0; k < 3; ++k) {
    const Vector3d v = 1.5 * Vector3d::Unit(k);
    for (const std::string name : {"semi_implicit", "split2", "exact", "exact6", "rk4", "rk8"}) {
      const Simulator end = flown(ellipsoid(v, 0), name, 10, 500);
      // Roundings of 15 m, several in each of up to eleven drifts a step; measured: 1.7e-12.
      EXPECT_LE(difference(end.state(0).p_WBcm, 10 * v), 5e-12) << name;
      EXPECT_EQ(angleBetween(end.state(0).q_WB, Quaterniond::Identity()), 0) << name;
    }
  }
}

TEST(AddedMass, TurnsASlenderBodyBroadsideAsTheClosedFormSays) {
  // Along its lightest direction a body is unstable (Munk 1924). Turned by a from it about z, from
  // rest: I w^2 = P^2 (1/M_x - 1/M_y) (sin^2 a - sin^2 a0), until it is broadside and beyond.
  const double a0 = 0.1;
  Scene scene = ellipsoid(Vector3d::UnitX(), a0);
  const Simulator start(scene);
  // The momentum is along none of the axes; a is the angle between it and the body's x.
  const Vector3d P = start.state(0).P_WB;
  const auto angle = [&](const Simulator& now) {
    const Vector3d P_L = now.linkMotion(0).q_WL.conjugate() * P;
    return std::atan2(P_L.y(), P_L.x());
  };
  const double difference = P.squaredNorm() * (1 / 3.0 - 1 / 5.0) / 0.9;
  double most = 0;
  for (int steps = 100; steps <= 1600; steps += 100) {
    const Simulator now = flown(scene, "rk8", 0.01 * steps, steps);
    const double w = now.linkMotion(0).w_WL_L.z(), a = angle(now), s = std::sin(angle(start));
    EXPECT_NEAR(w * w, difference * (std::sin(a) * std::sin(a) - s * s), 1e-11) << steps;
    most = std::max(most, std::abs(a));
  }
  EXPECT_GT(most, kPi / 2);  // past broadside
}

TEST(AddedMass, SwingsAboutBroadsideAsAPendulum) {
  // w^2 = P^2 (1/M_x - 1/M_y)/I for small angles from the heavier direction; what stiffness() says
  // is the worst of all directions.
  const Scene scene = ellipsoid(1.2 * Vector3d::UnitY(), 1e-4);
  const Simulator start(scene);
  const double rate = start.state(0).P_WB.norm() * std::sqrt((1 / 3.0 - 1 / 5.0) / 0.9);
  const double half = kPi / rate;
  Bodies bodies = start.bodies();
  ActiveEffects effects;
  effects.add(scene.effects[0].get());
  const auto integrator = integratorNamed("rk8").make({});
  for (int i = 0; i < 200; ++i) integrator->step(bodies, effects, 0, half / 200);
  const Quaterniond q_WL = linkMotion(start.bodyFrame(0), bodies.state(0)).q_WL;
  // P is 1e-4 (M_y - M_x)/M_y off the world's y: half a swing goes to the other side of it.
  const Vector3d P = start.state(0).P_WB;
  const double centre = std::atan2(-P.x(), P.y());
  EXPECT_NEAR(2 * std::atan2(q_WL.z(), q_WL.w()), 2 * centre - 1e-4, 1e-11);
  const double worst = start.state(0).P_WB.norm() * std::sqrt((1 / 3.0 - 1 / 8.0) / 0.5);
  EXPECT_NEAR(scene.effects[0]->stiffness(Instant(start.bodies(), 0)).oscillation, worst, 1e-13);
}

TEST(AddedMass, WorksWithOtherEffectsAndTheAudit) {
  Scene scene = submerged(
      ", gravity: {acceleration: [0.5, 0.2, -9.0]}, damping: {linear: 0.3, "
      "angular: 0.2}, spring: [{body: b, point: [0.4, 0.1, 0.3], anchor: "
      "[1, 0, 2], stiffness: 8.0, damping: 1.5}]");
  scene.energy_audit = true;
  const Simulator truth = flown(scene, "adaptive", kTime, 2);
  EXPECT_LE(std::abs(truth.energy().unaccounted_J()), 1e-9);
  const auto error = [&](int steps) {
    return distance(flown(scene, "exact", kTime, steps).bodies(), truth.bodies());
  };
  EXPECT_NEAR(slopeOf(error, 64, 1e-6), 2, 0.15);
  const auto unaccounted = [&](int steps) {
    return std::abs(flown(scene, "exact", kTime, steps).energy().unaccounted_J());
  };
  EXPECT_NEAR(slopeOf(unaccounted, 128, 1e-6), 2, 0.3);
}

TEST(AddedMass, GravityPullsTheBodysOwnMass) {
  const Simulator simulator(submerged(", gravity: {acceleration: [0, 0, -9.0]}"));
  EXPECT_EQ(Vector3d(simulator.effectWrenches()[1].wrenches.f_W.row(0)), Vector3d(0, 0, -9 * 2.7));
}

TEST(AddedMass, InTheTensorAloneNeedsNoEffect) {
  const Scene scene = sceneFrom("{bodies: {" + genericBodyNamed("b") +
                                "}, effects: {added_mass: {angular: [0.4, 0.9, 0.2]}}}");
  EXPECT_TRUE(scene.effects.empty());
  ASSERT_EQ(scene.elided.size(), 1u);
  EXPECT_TRUE(contains(scene.elided[0], {"added_mass", "tensors"}));
  Matrix3d I_L = genericBody().I_BBcm_F;
  I_L.diagonal() += Vector3d(0.4, 0.9, 0.2);
  EXPECT_LE(difference(Simulator(scene).bodies().moments(0), principalInertia(I_L).I_BBcm_B),
            1e-15);
  const Scene none =
      sceneFrom("{bodies: {" + genericBodyNamed("b") + "}, effects: {added_mass: {}}}");
  EXPECT_TRUE(none.effects.empty());
  EXPECT_TRUE(contains(none.elided.at(0), {"added_mass: no body has"}));
}

TEST(AddedMass, FarAwayNoWayIsLostInThePositionsLastBit) {
  for (const std::string integrator : {"exact", "rk4", "rk8", "semi_implicit"}) {
    Simulator simulator(sceneFrom(
        "{integrator: " + integrator + ", effects: {added_mass: {linear: [0, 0, 0]}}, " +
        "bodies: {fish: {mass: 1, inertia: [1, 1.3, 2.1], added_mass: {linear: [1, 3, 6]}, "
        "position: [1.0e+9, -1.0e+9, 1.0e+9], linear_velocity: [1.0e-6, -1.0e-6, 1.0e-6]}}}"));
    simulator.advance(1000);
    for (int k = 0; k < 3; ++k)  // 168 times the last bit
      EXPECT_NEAR(std::abs(simulator.state(0).p_WBcm(k)), 1e9 + 2e-5, 0x1p-23) << integrator;
  }
}

TEST(AddedMass, RestrictedToSomeBodiesIsTheSame) {
  const Scene scene = sceneFrom("{bodies: {" + genericBodyNamed("a", ", added_mass: false") + ", " +
                                otherBodyNamed("b") + ", " + genericBodyNamed("c") +
                                "}, effects: {added_mass: {linear: " + kLinear + "}}}");
  const Simulator simulator(scene);
  const auto some = scene.effects[0]->restrictedTo({2, 0});
  ASSERT_NE(some, nullptr);
  EXPECT_EQ(some->bodyCount(), 1u);
  Bodies rows = rowsOf(simulator.bodies(), {2, 0}), whole = simulator.bodies();
  some->beforeDrift(rows, Instant(rows, 0), 0.3);
  scene.effects[0]->beforeDrift(whole, Instant(whole, 0), 0.3);
  EXPECT_FALSE(sameBits(whole.state(2), simulator.state(2)));
  EXPECT_TRUE(sameBits(rows.state(0), whole.state(2)));
  EXPECT_TRUE(sameBits(rows.state(1), simulator.state(0)));
}

TEST(AddedMass, CannotBeSwitchedOff) {
  Simulator simulator(submerged());
  EXPECT_TRUE(contains(refusal([&] { simulator.switchEffect("added_mass", false); }),
                       {"'added_mass'", "momenta"}));
  EXPECT_NO_THROW(simulator.switchEffect("added_mass", true));
}

TEST(AddedMass, BearsOnlyWindThatIsTheSameAsStillWater) {
  const auto start = [](const std::string& linear, const std::string& wind) {
    return Simulator(
        sceneFrom("{bodies: {fish: {mass: 1, inertia: [1, 2, 2.5], linear_velocity: "
                  "[2, 0.5, 0]}}, effects: {added_mass: {linear: " +
                  linear + "}, drag: {air_density: 1000, drag_area: 0.1, wind: " + wind + "}}}"));
  };
  const std::string steady = "[2, 0.5, 0]";
  EXPECT_TRUE(contains(refusal([&] { start("[1, 2, 3]", steady); }),
                       {"effects.drag.wind", "`added_mass`", "'fish'", "equal"}));
  EXPECT_TRUE(contains(refusal([&] { start("[1, 1, 1]", "{gusts: {deviation: 1.0, time: 5}}"); }),
                       {"effects.drag.wind", "`added_mass`", "'fish'", "no gusts"}));
  EXPECT_TRUE(contains(
      refusal([&] {
        start("[1, 1, 1]", "{velocity: [1, 0, 0], shear: {reference_height: 9, exponent: 0.1}}");
      }),
      {"effects.drag.wind", "no shear"}));
  EXPECT_NO_THROW(start("[1, 2, 3]", "[0, 0, 0]"));
  EXPECT_NO_THROW(start("[1, 2, 3]", "{gusts: {deviation: 0, time: 5}}"));
  Simulator with_the_stream = start("[1, 1, 1]", steady);
  const Vector3d P = with_the_stream.state(0).P_WB;
  for (int i = 0; i < 100; ++i) with_the_stream.step();
  EXPECT_EQ(with_the_stream.state(0).P_WB, P);
  EXPECT_EQ(with_the_stream.state(0).L_WBcm_W, Vector3d::Zero());
}

TEST(AddedMass, BadParametersAreRefusedWithPathValueAndUnit) {
  const auto what = [](const std::string& block, const std::string& body = "") {
    return refusal([&] {
      sceneFrom("{bodies: {" + genericBodyNamed("a", body) + ", dot: {point_mass: 1.0" +
                (body.empty() ? "" : ", added_mass: false") + "}}, effects: {added_mass: " + block +
                "}}");
    });
  };
  const std::string at = "effects.added_mass.";
  EXPECT_TRUE(contains(what("{linear: [1, -2, 3]}"), {at + "linear", "-2", "kg"}));
  EXPECT_TRUE(contains(what("{angular: [1, -2, 3]}"), {at + "angular", "-2", "kg m^2"}));
  EXPECT_TRUE(contains(what("{sphere: {radius: -1, fluid_density: 2}}"),
                       {at + "sphere.radius", "-1", "m"}));
  EXPECT_TRUE(contains(what("{sphere: {radius: 1, fluid_density: -2}}"),
                       {at + "sphere.fluid_density", "-2", "kg/m^3"}));
  EXPECT_TRUE(contains(what("{sphere: {radius: 1, fluid_density: 2, x: 1}}"), {at + "sphere.x"}));
  EXPECT_TRUE(contains(what("{sphere: {radius: 1, fluid_density: 2}, linear: [1, 1, 1]}"),
                       {at + "sphere"}));
  EXPECT_TRUE(contains(what("{linear: [1, 2, 3]}"), {"bodies.dot.added_mass", "point mass"}));
  EXPECT_TRUE(contains(what("{}", ", added_mass: {linear: [1, 2, -3]}"),
                       {"bodies.a.added_mass.linear", "-3", "kg"}));
}

}  // namespace
}  // namespace rigid_body_sim

#include <cmath>

#include "conservative.hpp"
#include "rigid_body_sim/conserved.hpp"

namespace rigid_body_sim {
namespace {

constexpr double kMu = 6;  // [m^3/s^2]
const Vector3d kCenter(0.3, -0.2, 0.1);
const Vector3d kPole = Vector3d(1, -2, 2) / 3;

/// Round an attracting centre about as far away as the body is large, so that no term is small.
std::string near(const std::string& more, const std::string& bodies) {
  return "{effects: {central_gravity: {mu: 6, center: [0.3, -0.2, 0.1], " + more + "}}, bodies: {" +
         bodies + "}}";
}

const std::string kOblate = "j2: 0.2, equatorial_radius: 1.5, axis: [2, -4, 4]";

Scene three(const std::string& more) {
  return sceneFrom(
      near(more, "a: " + genericBodyYaml() + ", b: " + genericBodyYaml("central_gravity: {}") +
                     ", c: " + genericBodyYaml("central_gravity: {gravity_gradient: false}")));
}

/// Potential energy per mu and kg of a unit mass at r [m] from an oblate centre, as its definition
/// has it: Legendre's polynomial of the second degree.
double oblatePotential(const Vector3d& r, double j2_R2) {
  const double sine = r.dot(kPole) / r.norm();
  return -1 / r.norm() * (1 - j2_R2 / r.squaredNorm() * std::legendre(2, sine));
}

TEST(CentralGravity, FallsWithTheSquareOfTheDistance) {
  const Scene scene = three("");
  const Bodies bodies = Simulator(scene).bodies();
  const Wrenches wrenches = wrenchesOf(*scene.effects.at(0), bodies);
  const Vector3d r = bodies.state(1).p_WBcm - kCenter;
  EXPECT_LE(
      difference(Vector3d(wrenches.f_W.row(1)), Vector3d(-kMu * 2.7 / std::pow(r.norm(), 3) * r)),
      100 * kEps);
  EXPECT_TRUE(wrenches.t_Bcm_W.isZero(0));
  EXPECT_NEAR(scene.effects.at(0)->potentialEnergy(Instant(bodies, 0)), -3 * kMu * 2.7 / r.norm(),
              1e3 * kEps);
}

TEST(CentralGravity, OblatenessIsTheSecondZonalHarmonic) {
  const Scene scene = three(kOblate);
  const Bodies bodies = Simulator(scene).bodies();
  const Vector3d r = bodies.state(0).p_WBcm - kCenter;
  const double expected = kMu * 2.7 * oblatePotential(r, 0.2 * 1.5 * 1.5);
  EXPECT_NEAR(scene.effects.at(0)->potentialEnergy(Instant(bodies, 0)), 3 * expected, 1e3 * kEps);
}

TEST(CentralGravity, OblateOnePullsHarderAtTheEquatorAndLessAtThePoles) {
  // mu/r^2 (1 + 3/2 J2 (Re/r)^2) and mu/r^2 (1 - 3 J2 (Re/r)^2).
  const auto pullAt = [](const std::string& position) {
    const Scene scene = sceneFrom(
        "{effects: {central_gravity: {mu: 30, j2: 0.2, equatorial_radius: 1.5}}, bodies: {p: "
        "{point_mass: 1, position: " +
        position + "}}}");
    return Vector3d(wrenchesOf(*scene.effects.at(0), Simulator(scene).bodies()).f_W.row(0));
  };
  const double oblate = 0.2 * 1.5 * 1.5 / 4;
  EXPECT_LE(difference(pullAt("[0, 2, 0]"), Vector3d(0, -7.5 * (1 + 1.5 * oblate), 0)), 20 * kEps);
  EXPECT_LE(difference(pullAt("[0, 0, -2]"), Vector3d(0, 0, 7.5 * (1 - 3 * oblate))), 20 * kEps);
}

TEST(CentralGravity, ForceAndTorqueAreTheGradientOfTheEnergy) {
  for (const std::string& more : {std::string(), kOblate, std::string("gravity_gradient: true"),
                                  kOblate + ", gravity_gradient: true"}) {
    SCOPED_TRACE(more);
    const Scene scene = three(more);
    expectWrenchesAreTheGradient(*scene.effects.at(0), Simulator(scene).bodies());
  }
}

TEST(CentralGravity, KeepsEnergy) {
  for (const std::string& more : {std::string(), kOblate, kOblate + ", gravity_gradient: true"}) {
    SCOPED_TRACE(more);
    expectEnergyAuditCloses(three(more));
  }
}

TEST(CentralGravity, KeepsSpinAndOrbitTogether) {
  // Of a round centre: what the torque gives the spin, the force takes from the orbit.
  Scene scene = three("gravity_gradient: true");
  scene.integrator = "rk8";
  scene.step_ns = 5'000'000;
  Simulator simulator(scene);
  const auto momentum = [&] { return angularMomentumAboutPoint(simulator.state(0), kCenter); };
  const Vector3d start = momentum(), spin = simulator.state(0).L_WBcm_W;
  for (int i = 0; i < 400; ++i) simulator.step();
  EXPECT_GT((simulator.state(0).L_WBcm_W - spin).norm(), 0.1);
  EXPECT_LE((momentum() - start).norm(), 400 * 4 * kEps * start.norm());
}

TEST(CentralGravity, OfSomeBodiesIsAsInTheWhole) {
  const Scene scene = three(kOblate + ", gravity_gradient: true");
  expectRestrictedEqualsTheWhole(*scene.effects.at(0), Simulator(scene).bodies());
  EXPECT_EQ(scene.effects.at(0)->bodyCount(), 3u);
}

TEST(CentralGravity, OrbitIsClosedAfterKeplersPeriod) {
  // From the pericentre, at 0.6 of the half axis of 2 m: eccentricity 0.4, in an inclined plane.
  const Vector3d toward = Vector3d(2, -1, 3).normalized();
  const Vector3d ahead = Vector3d(2, -1, 3).cross(Vector3d(0.2, 0.5, 1)).normalized();
  const double speed = std::sqrt(kMu * (2 / 1.2 - 1 / 2.0));
  Scene scene = sceneFrom(
      near("", "p: {point_mass: 3, position: " + yamlOf(Vector3d(kCenter + 1.2 * toward)) +
                   ", linear_velocity: " + yamlOf(Vector3d(speed * ahead)) + "}"));
  const double period = 2 * kPi * std::sqrt(8 / kMu);
  const auto errorAfter = [&](const std::string& integrator, int steps) {
    Bodies bodies = Simulator(scene).bodies();
    const BodyState start = bodies.state(0);
    ActiveEffects effects;
    effects.add(scene.effects.at(0).get());
    const auto method = integratorNamed(integrator).make({});
    for (int k = 0; k < steps; ++k) method->step(bodies, effects, 0, period / steps);
    return (bodies.state(0).p_WBcm - start.p_WBcm).norm();
  };
  EXPECT_LE(errorAfter("rk8", 500), 1e-12);
  EXPECT_NEAR(std::log2(errorAfter("exact", 2000) / errorAfter("exact", 4000)), 2, 0.02);
  EXPECT_NEAR(std::log2(errorAfter("exact4", 400) / errorAfter("exact4", 800)), 4, 0.1);
}

TEST(CentralGravity, NodeOfAnOrbitGoesRoundAsOblatenessMakesIt) {
  // dNode/dt = -3/2 n J2 (Re/a)^2 cos i of a circular orbit (Vallado, Fundamentals of Astrodynamics
  // and Applications, 2013, chapter 9), to the first order in J2: what is left is J2 times as much.
  const double inclination = 0.9, j2_R2 = 1e-5;
  const Vector3d ahead(0, std::cos(inclination), std::sin(inclination));
  Scene scene = sceneFrom(
      "{integrator: rk8, step_s: 0.01, effects: {central_gravity: {mu: 1, j2: 1.0e-5, "
      "equatorial_radius: 1}}, bodies: {p: {point_mass: 1, position: [1, 0, 0], linear_velocity: " +
      yamlOf(ahead) + "}}}");
  Simulator simulator(scene);
  const int ticks = static_cast<int>(std::lround(100 * 2 * kPi / 0.01));
  for (int i = 0; i < ticks; ++i) simulator.step();
  const Vector3d h = angularMomentumAboutPoint(simulator.state(0), Vector3d::Zero());
  const double rate = std::atan2(h(0), -h(1)) / simulator.time_s();
  EXPECT_NEAR(rate / (-1.5 * j2_R2 * std::cos(inclination)), 1, 1e-3);
}

TEST(CentralGravity, TooLongAStepIsRefusedWithTheLargestStableOne) {
  const Scene scene = sceneFrom(
      "{effects: {central_gravity: {mu: 1.0e+6}}, bodies: {p: {point_mass: 1, position: [0, 0, "
      "1]}}}");
  EXPECT_TRUE(contains(refusal([&] { Simulator{scene}; }),
                       {"central_gravity", "1000 rad/s", "largest stable step is 0.0005 s"}));
}

/// [rad/s] by stiffness(), of a point mass at `p_W`.
double rateAt(const std::string& field, const Vector3d& p_W) {
  const Scene scene = sceneFrom("{effects: {central_gravity: {mu: 5, " + field +
                                "}}, bodies: {p: {point_mass: 1, position: " + yamlOf(p_W) + "}}}");
  return scene.effects.at(0)->stiffness(Instant(Simulator(scene).bodies(), 0)).oscillation;
}

TEST(CentralGravity, StiffnessBoundsTheGradientWithOblateness) {
  const double h = 1e-4;
  Sampler sample(5);
  for (int k = 0; k < 200; ++k) {
    const Vector3d p_W = 2 * sample.attitude().toRotationMatrix().col(0);
    for (const double j2 : {0.3, -0.3}) {
      const std::string field = "j2: " + std::to_string(j2) + ", equatorial_radius: 2";
      const Scene scene =
          sceneFrom("{effects: {central_gravity: {mu: 5, " + field +
                    "}}, bodies: {p: {point_mass: 1, position: " + yamlOf(p_W) + "}}}");
      const auto forceAt = [&](const Vector3d& p) {
        Bodies moved = Simulator(scene).bodies();
        moved.p_WBcm.row(0) = p;
        return Vector3d(wrenchesOf(*scene.effects.at(0), moved).f_W.row(0));
      };
      Matrix3d K;  // of a unit mass
      for (int j = 0; j < 3; ++j)
        K.col(j) =
            (forceAt(p_W - h * Vector3d::Unit(j)) - forceAt(p_W + h * Vector3d::Unit(j))) / (2 * h);
      const double swing = principalInertia(K).I_BBcm_B(2);  // its largest eigenvalue
      EXPECT_LE(swing, std::pow(rateAt(field, p_W), 2) * (1 + 1e-6)) << p_W.transpose();
    }
  }
  const double central = rateAt("j2: 0", {0, 0, 2}),
               both = rateAt("j2: 0.3, equatorial_radius: 2", {0, 0, 2});
  EXPECT_NEAR(both * both, central * central * (1 + 12 * 0.3), 1e-14);
}

TEST(CentralGravity, StiffnessOfALongBodyIsThatOfItsPitch) {
  // 3 mu/r^3 (I_j - I_k)/I_i, largest for pitch about the middle axis here.
  const Scene scene = sceneFrom(
      "{effects: {central_gravity: {mu: 5, gravity_gradient: true}}, bodies: {rod: {mass: 1, "
      "inertia: [0.1, 1, 1.05], position: [0, 2, 0]}}}");
  const double rate =
      scene.effects.at(0)->stiffness(Instant(Simulator(scene).bodies(), 0)).oscillation;
  EXPECT_NEAR(rate, std::sqrt(3 * 5.0 / 8 * (1.05 - 0.1) / 1), 4 * kEps);
}

TEST(CentralGravity, OblatenessInTheWrongUnitIsRefused) {
  const auto start = [](const std::string& radius, const std::string& bodies) {
    return sceneFrom(
        "{effects: {central_gravity: {mu: 3.986004418e+14, j2: 0.00108262982, equatorial_radius: " +
        radius + "}}, bodies: {" + bodies + "}}");
  };
  const std::string bodies =
      "rock: {point_mass: 1, central_gravity: false}, sat: {point_mass: 1, position: [7.0e+6, 0, "
      "0]}";
  EXPECT_NO_THROW(start("6378137", bodies));
  EXPECT_NO_THROW(start("6378137", "pole: {point_mass: 1, position: [0, 0, 6356752]}"));
  EXPECT_TRUE(contains(
      refusal([&] { start("6378137000", bodies); }),
      {"central_gravity.center", "'sat'", "7e+06 m", "equatorial_radius", "2696", "units"}));
  EXPECT_NO_THROW(start("6378137", "rock: {point_mass: 1, central_gravity: false}"));
}

TEST(CentralGravity, BodyThatStartsAtItsCentreIsRefusedWithTheCentre) {
  const std::string why = refusal([] {
    sceneFrom(
        "{effects: {central_gravity: {mu: 1, center: [1, 2, 4]}}, bodies: {b: {mass: 1, inertia: "
        "[1, 1, 1], com: [0, 0, 1], position: [1, 2, 3]}}}");
  });
  EXPECT_TRUE(contains(why, {"effects.central_gravity.center", "body 'b' starts 0 m from there"}));
}

TEST(CentralGravity, BodyThatComesToTheCentreIsFrozenAndTheOthersFlyOn) {
  // The pull is lost in the rounding of its velocity, so that a tick brings it to zero exactly.
  Simulator simulator(sceneFrom(
      "{effects: {central_gravity: {mu: 1.0e-24, j2: 0.1, equatorial_radius: 0.02}}, bodies: {at: "
      "{point_mass: 1, position: [0.02, 0, 0], linear_velocity: [-1, 0, 0]}, off: {point_mass: 1, "
      "position: [0, 0, 2]}}}"));
  simulator.step();
  ASSERT_EQ(simulator.frozenBodies().size(), 1u);
  EXPECT_EQ(simulator.frozenBodies()[0].body, 0);
  EXPECT_TRUE(isFinite(simulator.state(0)));
  EXPECT_LT(simulator.state(1).P_WB(2), 0);
}

TEST(CentralGravity, WithoutAMuOrABodyIsNotThere) {
  EXPECT_EQ(
      sceneFrom("{effects: {central_gravity: {mu: 0}}, bodies: {p: {point_mass: 1}}}").elided.at(0),
      "central_gravity: all its parameters are zero");
  EXPECT_EQ(sceneFrom("{effects: {central_gravity: {mu: 1}}, bodies: {p: {point_mass: 1, "
                      "central_gravity: false}}}")
                .elided.at(0),
            "central_gravity: it acts on no body");
}

TEST(CentralGravity, RefusesWhatIsNoField) {
  const auto said = [](const std::string& block) {
    return refusal([&] {
      sceneFrom("{effects: {central_gravity: {" + block +
                "}}, bodies: {a: {point_mass: 1, position: [0, 0, 9]}}}");
    });
  };
  const std::string path = "effects.central_gravity.";
  EXPECT_TRUE(contains(said(""), {path + "mu", "missing", "[m^3/s^2]"}));
  EXPECT_TRUE(contains(said("mu: -1"), {path + "mu", "-1", ">= 0 [m^3/s^2]"}));
  EXPECT_TRUE(contains(said("mu: 1, center: 3"), {path + "center", "3", "[m]"}));
  EXPECT_TRUE(contains(said("mu: 1, j2: 0.1"), {path + "equatorial_radius", "missing", "[m]"}));
  EXPECT_TRUE(
      contains(said("mu: 1, equatorial_radius: 0"), {path + "equatorial_radius", "0", "> 0 [m]"}));
  EXPECT_TRUE(contains(said("mu: 1, j2: .nan"), {path + "j2", "finite"}));
  EXPECT_TRUE(contains(said("mu: 1, axis: [0, 0, 0]"), {path + "axis", "[0, 0, 0]"}));
  EXPECT_TRUE(contains(said("mu: 1, gravity_gradient: 1"), {path + "gravity_gradient", "1"}));
  EXPECT_TRUE(contains(said("mu: 1, radius: 1"), {"radius"}));
}

}  // namespace
}  // namespace rigid_body_sim

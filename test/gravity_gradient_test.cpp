// The gravity gradient of `central_gravity`: against a body of particles each of which is pulled by
// itself, and against the librations of satellites.
#include <cmath>

#include "conservative.hpp"
#include "effects/makers.hpp"

namespace rigid_body_sim {
namespace {

constexpr double kMu = 3.986004418e14;  // [m^3/s^2], WGS-84

/// Particles in no special place, about their centre of mass.
std::vector<Particle> stones() {
  std::vector<Particle> stones = {{1.2, {0.5, -0.3, 0.2}},
                                  {0.7, {-0.4, 0.6, 0.1}},
                                  {0.9, {0.2, 0.1, -0.7}},
                                  {1.6, {-0.3, -0.2, 0.4}}};
  const Vector3d com = massPropertiesOfParticles(stones).p_FBcm;
  for (Particle& stone : stones) stone.p_FQ -= com;
  return stones;
}

/// The same as a scene's body, far from the centre.
Scene stonesAt(double distance) {
  std::string particles;
  for (const Particle& stone : stones())
    particles += (particles.empty() ? "" : ", ") + std::string("{mass: ") +
                 std::to_string(stone.mass) + ", position: " + yamlOf(stone.p_FQ) + "}";
  return sceneFrom(
      "{effects: {central_gravity: {mu: 30, gravity_gradient: true}}, bodies: {stones: {particles: "
      "[" +
      particles + "], orientation: " + yamlOf(genericAttitude()) +
      ", position: " + yamlOf(Vector3d(distance * Vector3d(2, -1, 3).normalized())) + "}}}");
}

TEST(GravityGradient, IsWhatTheParticlesOfABodyFeelButForTheNextOrder) {
  // MacCullagh's formula leaves out the third moments: of the force r^-5, of the torque r^-4.
  const auto errorAt = [](double distance) {
    const Scene scene = stonesAt(distance);
    const Bodies bodies = Simulator(scene).bodies();
    const Wrenches wrenches = wrenchesOf(*scene.effects.at(0), bodies);
    Vector3d f = wrenches.f_W.row(0), t = wrenches.t_Bcm_W.row(0);
    for (const Particle& stone : stones()) {
      const Vector3d arm = genericAttitude() * stone.p_FQ;
      const Vector3d r = Vector3d(bodies.p_WBcm.row(0)) + arm;
      const Vector3d pull = -30 * stone.mass / std::pow(r.norm(), 3) * r;
      f -= pull;
      t -= arm.cross(pull);
    }
    return std::make_pair(f.norm(), t.norm());
  };
  const auto near = errorAt(100), far = errorAt(200);
  EXPECT_NEAR(std::log2(near.first / far.first), 5, 0.05);
  EXPECT_NEAR(std::log2(near.second / far.second), 4, 0.05);
}

TEST(GravityGradient, OfASphereIsNothingToTheBit) {
  const std::string bodies =
      "}}, bodies: {b: {mass: 2, inertia: [0.3, 0.3, 0.3], position: [1, 2, 3]}}}";
  const std::string field = "{effects: {central_gravity: {mu: 30, gravity_gradient: ";
  const Scene with = sceneFrom(field + "true" + bodies),
              without = sceneFrom(field + "false" + bodies);
  const Bodies start = Simulator(with).bodies();
  const Wrenches a = wrenchesOf(*with.effects.at(0), start);
  EXPECT_TRUE(sameBits(a.f_W, wrenchesOf(*without.effects.at(0), start).f_W));
  EXPECT_TRUE(a.t_Bcm_W.isZero(0));
}

/// A satellite of the principal moments `I_L` about the local vertical, the way it flies and the
/// normal of the orbit (x, y, z of its link) in a circular orbit in the world's plane x-y, tilted
/// from there by `tilt`, and turning with the orbit.
Simulator satellite(double n, const Vector3d& I_L, const Quaterniond& tilt) {
  const double a = std::cbrt(kMu / (n * n));
  const Vector3d w_WB_L = tilt.conjugate() * Vector3d(0, 0, n);
  return Simulator(sceneFrom(
      "{step_s: 1.0, integrator: exact4, effects: {central_gravity: {mu: 3.986004418e+14, "
      "gravity_gradient: true}}, bodies: {sat: {mass: 1000, inertia: " +
      yamlOf(I_L) + ", position: " + yamlOf(Vector3d(a, 0, 0)) +
      ", linear_velocity: " + yamlOf(Vector3d(0, n * a, 0)) + ", orientation: " + yamlOf(tilt) +
      ", angular_velocity: " + yamlOf(w_WB_L) + "}}}"));
}

/// Period [s] of what `angle` says of the simulated satellite, from where it crosses zero upwards;
/// the mean of `count`. Infinite if it does not in 10 hours.
template <class F>
double measuredPeriod(Simulator simulator, const F& angle, int count) {
  std::vector<double> crossings;
  double before = angle(simulator);
  while (static_cast<int>(crossings.size()) <= count) {
    const double start_s = simulator.time_s();
    if (start_s > 36000) return kInf;
    simulator.step();
    const double after = angle(simulator);
    if (before < 0 && after >= 0) crossings.push_back(start_s - before / (after - before));
    before = after;
  }
  return (crossings.back() - crossings.front()) / count;
}

/// Angle from the local vertical to the link's x axis, in the plane of the orbit [rad].
double pitch(const Simulator& simulator) {
  const Vector3d up = simulator.state(0).p_WBcm.normalized();
  const Vector3d x = simulator.linkMotion(0).q_WL * Vector3d::UnitX();
  return std::atan2(up.cross(x)(2), up.dot(x));
}

/// Angle of the link's axis out of the plane of the orbit [rad].
template <int axis>
double outOfPlane(const Simulator& simulator) {
  return std::asin((simulator.linkMotion(0).q_WL * Vector3d::Unit(axis))(2));
}

/// NASA's JEOD, SIM_dyncomp RUN_10A: a cylinder of 1000 kg, 12 m and 1 m in radius, that stands
/// upright in a circular orbit. It states analytic periods, 3257.94 s in the plane and 2821.46 s
/// out of it. Both belong to an orbit of 5526.56 s, 377.96 km above 6378137 m.
const Vector3d kCylinder(500, 12250, 12250);

double rateOfOrbit() { return 2 * kPi / 3257.94 / std::sqrt(3 * (12250.0 - 500) / 12250); }

TEST(GravityGradient, CylinderLibratesInThePlaneOfItsOrbit) {
  // w^2 = 3 n^2 (I_y - I_x)/I_z for small angles (Hughes, Spacecraft Attitude Dynamics, 1986,
  // chapter 9); of any size: twice the angle is a pendulum, 4 K(sin)/w. JEOD flies 5 degrees.
  // Measured: 3257.94001 s for the small one, 3264.15351 s for 5 degrees, within 4e-10 of the
  // formula; the crossings are found on chords of 1 s.
  for (const double angle : {1e-4, 5 * kPi / 180, 0.6}) {
    const Quaterniond tilt(Eigen::AngleAxisd(angle, Vector3d::UnitZ()));
    const double expected = 3257.94 / (kPi / 2) * boost::math::ellint_1(std::sin(angle));
    const double period = measuredPeriod(satellite(rateOfOrbit(), kCylinder, tilt), pitch, 4);
    RecordProperty("period_s", std::to_string(period));
    EXPECT_NEAR(period / expected, 1, 1e-7) << period << " s";
  }
}

TEST(GravityGradient, CylinderLibratesOutOfThePlaneAsItsSpinAboutItselfStaysTheSame) {
  // w^2 = n^2 (1 + 3 k), k = (I_z - I_x)/I_y (Hughes 1986, chapter 9: roll and yaw of two equal
  // moments): 2806.57 s. JEOD's 2821.46 s is w^2 = 4 k n^2, which lets the cylinder turn with the
  // orbit about its own axis though nothing can turn it so: half a percent too long.
  const Quaterniond tilt(Eigen::AngleAxisd(1e-4, Vector3d::UnitY()));
  const double n = rateOfOrbit(), k = (12250.0 - 500) / 12250;
  EXPECT_NEAR(2 * kPi / (n * std::sqrt(4 * k)), 2821.46, 0.005);
  const double expected = 2 * kPi / (n * std::sqrt(1 + 3 * k));
  const double period = measuredPeriod(satellite(n, kCylinder, tilt), outOfPlane<0>, 4);
  RecordProperty("period_s", std::to_string(period));
  EXPECT_NEAR(period / expected, 1, 1e-7) << period << " s";
}

TEST(GravityGradient, FlatPlateRollsTwiceAnOrbitAndYawsOnce) {
  // Of a plate in the plane of the orbit I_z = I_x + I_y, which uncouples roll from yaw:
  // w = 2 n and n (Hughes 1986, chapter 9), whatever its shape.
  const double n = 1e-3;
  const Vector3d I(4000, 9000, 13000);
  const auto tilted = [&](const Vector3d& axis) {
    return satellite(n, I, Quaterniond(Eigen::AngleAxisd(1e-4, axis)));
  };
  const double roll = measuredPeriod(tilted(Vector3d::UnitY()), outOfPlane<0>, 4);
  const double yaw = measuredPeriod(tilted(Vector3d::UnitX()), outOfPlane<1>, 2);
  EXPECT_NEAR(roll / (kPi / n), 1, 1e-7) << roll << " s";
  EXPECT_NEAR(yaw / (2 * kPi / n), 1, 1e-7) << yaw << " s";
}

TEST(GravityGradient, FasterThanTheOrbitIsRefusedByTheSwingItMakes) {
  // A rod swings at the root of 3 times the orbit's rate.
  const Scene scene = sceneFrom(
      "{effects: {central_gravity: {mu: 1.0e+6, gravity_gradient: true}}, bodies: {rod: {mass: 1, "
      "inertia: [1.0e-9, 1, 1], position: [0, 0, 1]}}}");
  EXPECT_TRUE(
      contains(refusal([&] { Simulator{scene}; }),
               {"central_gravity", "1732.05 rad/s", "largest stable step is 0.000288675 s"}));
}

TEST(GravityGradient, OfAPointMassIsNothingAndMayNotBeAskedFor) {
  const std::string field =
      "{effects: {central_gravity: {mu: 1, gravity_gradient: true}}, bodies: ";
  const Scene scene = sceneFrom(field + "{p: {point_mass: 1, position: [0, 0, 3]}}}");
  EXPECT_TRUE(wrenchesOf(*scene.effects.at(0), Simulator(scene).bodies()).t_Bcm_W.isZero(0));
  EXPECT_TRUE(contains(
      refusal([&] {
        sceneFrom(field + "{p: {point_mass: 1, central_gravity: {gravity_gradient: true}}}}");
      }),
      {"p.central_gravity.gravity_gradient", "true", "point mass"}));
}

/// What the maker says to a body with added mass.
EffectList madeWithAddedMass(const std::string& scene, const std::string& body) {
  std::vector<SceneBody> bodies = {genericSceneBody("fish")};
  bodies[0].added_mass_L.linear_F << 0, 0.3, 0;
  const auto read = [](const std::string& yaml, const std::string& path) {
    return Parameters(readYaml(yaml, "test.yaml"), path);
  };
  EffectBlock block{"central_gravity",
                    read(scene, "effects.central_gravity"),
                    {},
                    {{0, read(body, "bodies.fish.central_gravity")}},
                    bodies};
  return makeCentralGravity(block);
}

TEST(GravityGradient, OfABodyWithAddedMassIsRefusedWhereItWasAskedFor) {
  EXPECT_TRUE(contains(refusal([] { madeWithAddedMass("{mu: 1, gravity_gradient: true}", "{}"); }),
                       {"effects.central_gravity.gravity_gradient", "'fish'", "added mass"}));
  EXPECT_TRUE(contains(refusal([] { madeWithAddedMass("{mu: 1}", "{gravity_gradient: true}"); }),
                       {"bodies.fish.central_gravity.gravity_gradient", "'fish'", "added mass"}));
  EXPECT_EQ(
      madeWithAddedMass("{mu: 1, gravity_gradient: true}", "{gravity_gradient: false}").size(), 1u);
}

}  // namespace
}  // namespace rigid_body_sim

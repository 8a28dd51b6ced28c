#include "conservative.hpp"

namespace rigid_body_sim {
namespace {

const Vector3d kGravity(0.3, -0.4, -9.7);

std::string inWater(const std::string& more, const std::string& bodies) {
  return "{effects: {buoyancy: {fluid_density: 1025, acceleration: " + yamlOf(kGravity) + ", " +
         more + "}}, bodies: {" + bodies + "}}";
}

Scene threeFloats() {
  return sceneFrom(inWater(
      "volume: 0.0031",
      "a: " + genericBodyYaml("buoyancy: {center: [0.4, 0.2, -0.1]}") +
          ", b: " + genericBodyYaml() +
          ", c: " + genericBodyYaml("buoyancy: {center: [-0.3, 0.1, 0.6], volume: 0.002}")));
}

TEST(Buoyancy, IsTheFluidsWeightUpsideDownAtTheCentreOfBuoyancy) {
  const Scene scene = threeFloats();
  const Wrenches wrenches = wrenchesOf(*scene.effects.at(0), Simulator(scene).bodies());
  const Vector3d com(0.11, -0.23, 0.37);
  const Vector3d centers[] = {{0.4, 0.2, -0.1}, com, {-0.3, 0.1, 0.6}};
  const double volumes[] = {0.0031, 0.0031, 0.002};
  for (int i = 0; i < 3; ++i) {
    const Vector3d f = -1025 * volumes[i] * kGravity;
    const Vector3d t = (genericAttitude() * (centers[i] - com)).cross(f);
    EXPECT_LE(difference(Vector3d(wrenches.f_W.row(i)), f), 40 * kEps);
    EXPECT_LE(difference(Vector3d(wrenches.t_Bcm_W.row(i)), t), 200 * kEps);
  }
  EXPECT_TRUE(wrenches.t_Bcm_W.row(1).isZero(0));
}

TEST(Buoyancy, EnergyIsTheFluidsThatHasToComeDown) {
  const Scene scene =
      sceneFrom(inWater("volume: 0.0031, center: [0.4, 0.2, -0.1]", "a: " + genericBodyYaml()));
  // The root link is at the position given, so that the centre of buoyancy is seen from there.
  const Vector3d p_WQ = Vector3d(1.7, -0.9, 2.3) + genericAttitude() * Vector3d(0.4, 0.2, -0.1);
  const Bodies bodies = Simulator(scene).bodies();
  EXPECT_NEAR(scene.effects.at(0)->potentialEnergy(Instant(bodies, 0)),
              1025 * 0.0031 * kGravity.dot(p_WQ), 400 * kEps);
}

TEST(Buoyancy, WrenchIsTheGradientOfItsEnergy) {
  const Scene scene = threeFloats();
  expectWrenchesAreTheGradient(*scene.effects.at(0), Simulator(scene).bodies());
}

TEST(Buoyancy, KeepsEnergy) { expectEnergyAuditCloses(threeFloats()); }

TEST(Buoyancy, OfSomeBodiesIsAsInTheWhole) {
  const Scene scene = threeFloats();
  expectRestrictedEqualsTheWhole(*scene.effects.at(0), Simulator(scene).bodies());
}

TEST(Buoyancy, NeutralHangsStillToTheBit) {
  const Scene scene = sceneFrom(
      "{effects: {gravity: {acceleration: [0.3, -0.4, -9.7]}, buoyancy: {fluid_density: 1000, "
      "volume: 0.002, acceleration: [0.3, -0.4, -9.7]}}, bodies: {fish: {mass: 2, inertia: [0.1, "
      "0.2, 0.25], com: [0.1, 0.2, 0.3], position: [1, 2, 3]}}}");
  Simulator simulator(scene);
  const BodyState start = simulator.state(0);
  for (int i = 0; i < 1000; ++i) simulator.step();
  EXPECT_TRUE(sameBits(simulator.state(0), start));
}

TEST(Buoyancy, LightBodyRisesByWhatItIsLighter) {
  Simulator simulator(
      sceneFrom("{effects: {gravity: {acceleration: [0, 0, -9.8]}, buoyancy: {fluid_density: 1000, "
                "acceleration: [0, 0, -9.8]}}, bodies: {cork: {point_mass: 0.5, buoyancy: {volume: "
                "0.002}}}}"));
  for (int i = 0; i < 50; ++i) simulator.step();
  // (rho V/m - 1) g t^2/2; a parabola is exact, 50 steps of rounding.
  EXPECT_NEAR(simulator.state(0).p_WBcm(2), 0.5 * 3 * 9.8, 50 * kEps * 15);
}

/// A neutral body whose centre of buoyancy is 0.3 m from its centre of mass, on its first principal
/// axis; turned by `angle` about the third one.
struct Buoy {
  Scene scene;
  Vector3d axis_W;
};

Buoy buoy(double angle) {
  const Quaterniond q_LB(Eigen::AngleAxisd(0.7, Vector3d(2, -1, 3).normalized()));
  const Matrix3d R = q_LB.toRotationMatrix();
  const Matrix3d I_L = R * Vector3d(0.2, 0.4, 0.5).asDiagonal() * R.transpose();
  const Vector3d com_L(0.1, -0.2, 0.3);
  const Vector3d axis_W = genericAttitude() * R.col(2);
  const Quaterniond q_WL = Quaterniond(Eigen::AngleAxisd(angle, axis_W)) * genericAttitude();
  const std::string g = yamlOf(Vector3d(-9.8 * (genericAttitude() * R.col(0))));
  return {sceneFrom("{effects: {gravity: {acceleration: " + g +
                    "}, buoyancy: {fluid_density: 1000, acceleration: " + g +
                    "}}, bodies: {buoy: {mass: 2, com: " + yamlOf(com_L) +
                    ", inertia: " + yamlOf(I_L) + ", orientation: " + yamlOf(q_WL) +
                    ", buoyancy: {volume: 0.002, "
                    "center: " +
                    yamlOf(Vector3d(com_L + 0.3 * R.col(0))) + "}}}}"),
          axis_W};
}

TEST(Buoyancy, RightsABodyLikeAPendulumAtAnyAmplitude) {
  for (const double angle : {0.01, 0.5, 2.0, 2.9}) {
    SCOPED_TRACE(angle);
    const Buoy one = buoy(angle);
    expectPendulum(one.scene, one.axis_W, angle, std::sqrt(2 * 9.8 * 0.3 / 0.5));
  }
}

TEST(Buoyancy, TooLongAStepIsRefusedWithTheLargestStableOne) {
  const Bodies bodies = Simulator(buoy(0.1).scene).bodies();
  EXPECT_NEAR(buoy(0.1).scene.effects.at(1)->stiffness(Instant(bodies, 0)).oscillation,
              std::sqrt(2 * 9.8 * 0.3 / 0.4), 1e-13);
  const Scene scene = sceneFrom(
      "{effects: {buoyancy: {fluid_density: 1.0e+6, volume: 1, center: [0, 0, 1], acceleration: "
      "[0, 0, -10]}}, bodies: {b: {mass: 1, inertia: [0.1, 0.1, 0.1]}}}");
  EXPECT_TRUE(contains(refusal([&] { Simulator{scene}; }),
                       {"buoyancy", "10000 rad/s", "largest stable step is 5e-05 s"}));
}

TEST(Buoyancy, ActsAtThePointOfAPointMassWhichMayNotAskForAnother) {
  const Scene scene = sceneFrom(inWater("volume: 0.001, center: [0, 0, 1]", "p: {point_mass: 1}"));
  const Wrenches wrenches = wrenchesOf(*scene.effects.at(0), Simulator(scene).bodies());
  EXPECT_LE(difference(Vector3d(wrenches.f_W.row(0)), Vector3d(-1.025 * kGravity)), 8 * kEps);
  EXPECT_TRUE(wrenches.t_Bcm_W.isZero(0));
  EXPECT_TRUE(contains(refusal([] {
                         sceneFrom(inWater("volume: 0.001",
                                           "p: {point_mass: 1, buoyancy: {center: [0, 0, 1]}}"));
                       }),
                       {"p.buoyancy.center", "point mass"}));
}

TEST(Buoyancy, WithoutVolumeFluidOrGravityIsNotThere) {
  for (const auto& [block, why] : std::vector<std::pair<std::string, std::string>>{
           {"fluid_density: 0, volume: 1, acceleration: [0, 0, -9.8]", "the fluid_density is zero"},
           {"fluid_density: 1000, acceleration: [0, 0, -9.8]", "no body has a volume"},
           {"fluid_density: 1000, volume: 1, acceleration: [0, 0, 0]",
            "the acceleration is zero"}}) {
    const Scene scene =
        sceneFrom("{effects: {buoyancy: {" + block + "}}, bodies: {a: {point_mass: 1}}}");
    EXPECT_TRUE(scene.effects.empty());
    EXPECT_EQ(scene.elided.at(0), "buoyancy: " + why);
  }
}

TEST(Buoyancy, RefusesWhatIsNoFluidOrVolume) {
  const auto said = [](const std::string& block) {
    return refusal(
        [&] { sceneFrom("{effects: {buoyancy: {" + block + "}}, bodies: {a: {point_mass: 1}}}"); });
  };
  EXPECT_TRUE(contains(said("acceleration: [0, 0, -9.8]"),
                       {"effects.buoyancy.fluid_density", "missing", "[kg/m^3]"}));
  EXPECT_TRUE(contains(said("fluid_density: 1000"),
                       {"effects.buoyancy.acceleration", "missing", "[m/s^2]"}));
  EXPECT_TRUE(contains(said("fluid_density: -1, acceleration: [0, 0, -9.8]"),
                       {"effects.buoyancy.fluid_density", "-1", ">= 0 [kg/m^3]"}));
  EXPECT_TRUE(contains(said("fluid_density: 1, acceleration: [0, 0, -9.8], volume: -2"),
                       {"effects.buoyancy.volume", "-2", ">= 0 [m^3]"}));
}

}  // namespace
}  // namespace rigid_body_sim

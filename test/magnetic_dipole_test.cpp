#include "conservative.hpp"

namespace rigid_body_sim {
namespace {

std::string withField(const std::string& more, const std::string& bodies) {
  return "{effects: {magnetic_dipole: {field: [1.1, -0.4, 2.3], " + more + "}}, bodies: {" +
         bodies + "}}";
}

Scene threeMagnets() {
  return sceneFrom(
      withField("dipole: [0.7, 1.9, -0.5]",
                "a: " + genericBodyYaml() +
                    ", b: " + genericBodyYaml("magnetic_dipole: {dipole: [2, -1, 0.3]}") +
                    ", c: " + genericBodyYaml("magnetic_dipole: {dipole: [-0.2, 0.6, 0.9]}")));
}

TEST(MagneticDipole, IsTurnedByTheFieldAndNotPulled) {
  const Scene scene = threeMagnets();
  const Wrenches wrenches = wrenchesOf(*scene.effects.at(0), Simulator(scene).bodies());
  const Vector3d B(1.1, -0.4, 2.3);
  const Vector3d dipoles[] = {{0.7, 1.9, -0.5}, {2, -1, 0.3}, {-0.2, 0.6, 0.9}};
  for (int i = 0; i < 3; ++i) {
    // The dipole is given in the root link's axes: no principal axes here.
    const Vector3d expected = (genericAttitude() * dipoles[i]).cross(B);
    EXPECT_LE(difference(Vector3d(wrenches.t_Bcm_W.row(i)), expected), 40 * kEps);
  }
  EXPECT_TRUE(wrenches.f_W.isZero(0));
}

TEST(MagneticDipole, EnergyIsMinusTheDipoleAlongTheField) {
  const Scene scene = sceneFrom(withField("dipole: [0.7, 1.9, -0.5]", "a: " + genericBodyYaml()));
  const double expected =
      -(genericAttitude() * Vector3d(0.7, 1.9, -0.5)).dot(Vector3d(1.1, -0.4, 2.3));
  const Bodies bodies = Simulator(scene).bodies();
  EXPECT_NEAR(scene.effects.at(0)->potentialEnergy(Instant(bodies, 0)), expected, 40 * kEps);
}

TEST(MagneticDipole, TorqueIsTheGradientOfItsEnergy) {
  const Scene scene = threeMagnets();
  expectWrenchesAreTheGradient(*scene.effects.at(0), Simulator(scene).bodies());
}

TEST(MagneticDipole, KeepsEnergy) { expectEnergyAuditCloses(threeMagnets()); }

TEST(MagneticDipole, OfSomeBodiesIsAsInTheWhole) {
  const Scene scene = threeMagnets();
  expectRestrictedEqualsTheWhole(*scene.effects.at(0), Simulator(scene).bodies());
  EXPECT_EQ(scene.effects.at(0)->bodyCount(), 3u);
}

/// A compass needle turned by `angle` about its principal axis of 0.5 kg m^2, with 3 A m^2 in
/// 0.8 T. The principal axes are oblique in the root link, and that in the world.
struct Needle {
  Scene scene;
  Vector3d axis_W;
};

Needle needle(double angle) {
  const Quaterniond q_LB(Eigen::AngleAxisd(0.7, Vector3d(2, -1, 3).normalized()));
  const Matrix3d R = q_LB.toRotationMatrix();
  const Matrix3d I_L = R * Vector3d(0.2, 0.4, 0.5).asDiagonal() * R.transpose();
  const Vector3d m_L = 3 * R.col(0);
  const Vector3d axis_W = genericAttitude() * R.col(2);
  const Quaterniond q_WL = Quaterniond(Eigen::AngleAxisd(angle, axis_W)) * genericAttitude();
  const Vector3d field_W = 0.8 * (genericAttitude() * R.col(0));
  return {sceneFrom("{effects: {magnetic_dipole: {field: " + yamlOf(field_W) + ", dipole: " +
                    yamlOf(m_L) + "}}, bodies: {needle: {mass: 1, inertia: " + yamlOf(I_L) +
                    ", orientation: " + yamlOf(q_WL) + "}}}"),
          axis_W};
}

TEST(MagneticDipole, NeedleSwingsLikeAPendulumAtAnyAmplitude) {
  for (const double angle : {0.01, 0.5, 2.0, 2.9}) {
    SCOPED_TRACE(angle);
    const Needle one = needle(angle);
    expectPendulum(one.scene, one.axis_W, angle, std::sqrt(3 * 0.8 / 0.5));
  }
}

TEST(MagneticDipole, TooLongAStepIsRefusedWithTheLargestStableOne) {
  // Drawn along x, the needle turns about y and z: the fastest is sqrt(m B/I2).
  const Needle one = needle(0.1);
  const Bodies bodies = Simulator(one.scene).bodies();
  const double fastest = one.scene.effects.at(0)->stiffness(Instant(bodies, 0)).oscillation;
  EXPECT_NEAR(fastest, std::sqrt(3 * 0.8 / 0.4), 1e-14);
  Scene scene = sceneFrom(
      "{effects: {magnetic_dipole: {field: [1.0e+12, 0, 0], dipole: [0, 0, 1]}}, bodies: {b: "
      "{mass: "
      "1, inertia: [1, 1, 1]}}}");
  EXPECT_TRUE(contains(refusal([&] { Simulator{scene}; }),
                       {"magnetic_dipole", "1e+06 rad/s", "largest stable step is 5e-07 s"}));
}

TEST(MagneticDipole, AtTheLargestStableStepStaysBounded) {
  // 0.9 of it, for 10,000 steps: energies up to the well's depth of m B = 2.4 J and its start.
  Scene scene = needle(0.3).scene;
  scene.step_ns = static_cast<std::int64_t>(0.9e9 * 0.5 / std::sqrt(3 * 0.8 / 0.4));
  Simulator simulator(scene);
  for (int i = 0; i < 10000; ++i) simulator.step();
  EXPECT_TRUE(simulator.frozenBodies().empty());
  EXPECT_LT(simulator.energy().kinetic_J, 2.4);
}

TEST(MagneticDipole, OfABodyWithoutOneIsNotThere) {
  const std::string ball = "{sphere: {radius: 1, density: 1}";
  const Scene scene = sceneFrom(
      withField("", "a: " + ball + "}, b: " + ball + ", magnetic_dipole: {dipole: [0, 0, 1]}}"));
  EXPECT_EQ(scene.effects.at(0)->bodyCount(), 1u);
  for (const char* nothing : {"dipole: [0, 0, 0]", ""}) {
    const Scene none = sceneFrom(withField(nothing, "a: " + ball + "}"));
    EXPECT_TRUE(none.effects.empty());
    EXPECT_EQ(none.elided.at(0),
              "magnetic_dipole: no body has a dipole, but for point masses, which take no torque");
  }
}

TEST(MagneticDipole, DoesNotActOnAPointMassWhichMayNotAskForIt) {
  const Scene scene =
      sceneFrom(withField("dipole: [0, 0, 1]", "a: " + genericBodyYaml() + ", p: {point_mass: 1}"));
  EXPECT_EQ(scene.effects.at(0)->bodyCount(), 1u);
  EXPECT_TRUE(contains(refusal([] {
                         sceneFrom(withField(
                             "", "p: {point_mass: 1, magnetic_dipole: {dipole: [0, 0, 1]}}"));
                       }),
                       {"p.magnetic_dipole.dipole", "point mass"}));
}

TEST(MagneticDipole, RefusesWhatIsNoFieldOrDipole) {
  const auto said = [](const std::string& block) {
    return refusal([&] {
      sceneFrom("{effects: {magnetic_dipole: {" + block + "}}, bodies: {a: {point_mass: 1}}}");
    });
  };
  EXPECT_TRUE(contains(said(""), {"effects.magnetic_dipole.field", "missing", "[T]"}));
  EXPECT_TRUE(contains(said("field: [0, .inf, 0]"), {"effects.magnetic_dipole.field", "[T]"}));
  EXPECT_TRUE(contains(said("field: [0, 1, 0], dipole: 3"),
                       {"effects.magnetic_dipole.dipole", "3", "[A m^2]"}));
  EXPECT_TRUE(contains(said("field: [0, 1, 0], moment: [1, 0, 0]"), {"moment", "dipole"}));
}

}  // namespace
}  // namespace rigid_body_sim

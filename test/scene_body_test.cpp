#include "core/scene_body.hpp"

#include <sstream>

#include "generic.hpp"

namespace rigid_body_sim {
namespace {

Parameters blockOf(const std::string& yaml) {
  return Parameters(readYaml("{" + yaml + "}", "test"), "bodies.b");
}

/// The body of a block of which every key must have been read.
SceneBody bodyFrom(const std::string& yaml) {
  const Parameters block = blockOf(yaml);
  SceneBody body = bodyFromNumbers(block, "b");
  readInitialMotion(block, body);
  block.refuseUnknown();
  return body;
}

std::string refusalOf(const std::string& yaml) {
  return refusal([&] { bodyFrom(yaml); });
}

void expectTensor(const MassProperties& body, const Vector3d& moments) {
  EXPECT_LE(difference(body.I_BBcm_F, Matrix3d(moments.asDiagonal())), 4 * kEps * moments.norm());
}

// ---- Ways to say what a body is

TEST(BodyFromNumbers, OfABoxIsInClosedForm) {
  // m (b^2 + c^2) / 12 about each axis.
  const SceneBody body = bodyFrom("box: {size: [1, 2, 3], density: 4}");
  EXPECT_EQ(body.name, "b");
  EXPECT_FALSE(body.is_point_mass);
  EXPECT_EQ(body.mass_properties.mass, 24);
  expectTensor(body.mass_properties, {26, 20, 10});
}

TEST(BodyFromNumbers, OfASphereIsInClosedForm) {
  // 4/3 pi r^3 rho, 2/5 m r^2.
  const SceneBody body = bodyFrom("sphere: {radius: 0.5, density: 3}");
  EXPECT_NEAR(body.mass_properties.mass, kPi / 2, 4 * kEps);
  expectTensor(body.mass_properties, Vector3d::Constant(kPi / 20));
}

TEST(BodyFromNumbers, OfACylinderIsInClosedFormAlongZ) {
  // pi r^2 l rho; m (3 r^2 + l^2) / 12 across, m r^2 / 2 along.
  const SceneBody body = bodyFrom("cylinder: {radius: 0.5, length: 2, density: 8}");
  EXPECT_NEAR(body.mass_properties.mass, 4 * kPi, 16 * kEps);
  expectTensor(body.mass_properties, Vector3d(4 * 4.75 / 12, 4 * 4.75 / 12, 0.5) * kPi);
}

TEST(BodyFromNumbers, OfParticlesIsTheirSum) {
  // A regular cross about (1, 0, 0): two of 1 kg at +-1 on each axis give 4 about each.
  const SceneBody body = bodyFrom(
      "particles: [{mass: 1, position: [2, 0, 0]}, {mass: 1, position: [0, 0, 0]}, "
      "{mass: 1, position: [1, 1, 0]}, {mass: 1, position: [1, -1, 0]}, "
      "{mass: 1, position: [1, 0, 1]}, {mass: 1, position: [1, 0, -1]}]");
  EXPECT_EQ(body.mass_properties.mass, 6);
  EXPECT_LE(difference(body.mass_properties.p_FBcm, Vector3d(1, 0, 0)), 4 * kEps);
  expectTensor(body.mass_properties, {4, 4, 4});
}

TEST(BodyFromNumbers, OfMassAndTensorHasThem) {
  const SceneBody diagonal = bodyFrom("mass: 2, inertia: [1, 2, 2.5]");
  EXPECT_EQ(diagonal.mass_properties.mass, 2);
  EXPECT_EQ(diagonal.mass_properties.p_FBcm, Vector3d(0, 0, 0));
  EXPECT_EQ(diagonal.mass_properties.I_BBcm_F, Matrix3d(Vector3d(1, 2, 2.5).asDiagonal()));
  const SceneBody full =
      bodyFrom("mass: 2.7, com: [0.11, -0.23, 0.37], inertia: [1.6, -0.3, 0.2, 2.1, 0.4, 1.8]");
  EXPECT_EQ(full.mass_properties.p_FBcm, genericBody().p_FBcm);
  EXPECT_EQ(full.mass_properties.I_BBcm_F, genericBody().I_BBcm_F);
}

TEST(BodyFromNumbers, OfAPointMassHasNoRotation) {
  const SceneBody body = bodyFrom("point_mass: 0.7, linear_velocity: [4, 5, 6]");
  EXPECT_TRUE(body.is_point_mass);
  EXPECT_EQ(body.mass_properties.mass, 0.7);
  EXPECT_TRUE(body.mass_properties.I_BBcm_F.isZero(0));
  EXPECT_EQ(body.v_WBcm, Vector3d(4, 5, 6));
  EXPECT_TRUE(contains(refusalOf("point_mass: 1, angular_velocity: [0, 0, 0]"),
                       {"bodies.b.angular_velocity", "point mass"}));
}

TEST(BodyFromNumbers, RefusesWhatIsNoBodyNamingTheKey) {
  struct Row {
    const char* yaml;
    std::vector<std::string> parts;
  };
  const std::vector<Row> rows = {
      {"", {"bodies.b", "there is no mass, box"}},
      {"mass: 1", {"bodies.b.inertia"}},
      {"mass: 1, inertia: [1, 1]", {"bodies.b.inertia"}},
      {"mass: 0, inertia: [1, 1, 1]", {"bodies.b.mass"}},
      {"mass: 1, inertia: [1, 1, 3]", {"bodies.b.inertia", "triangle inequality"}},
      {"mass: 1, inertia: [1, 1, -1]", {"bodies.b.inertia", "must be positive"}},
      {"mass: 1, inertia: [1, 1, 1], box: {size: [1, 1, 1], density: 1}",
       {"bodies.b.box", "already has 'mass'"}},
      {"point_mass: 1, sphere: {radius: 1, density: 1}",
       {"bodies.b.point_mass", "already has 'sphere'"}},
      {"point_mass: 0", {"bodies.b.point_mass"}},
      {"point_mass: 1, inertia: [1, 1, 1]", {"inertia"}},
      {"box: {size: [1, 0, 1], density: 1}", {"bodies.b.box.size"}},
      {"box: {size: [1, 1, 1]}", {"bodies.b.box.density"}},
      {"box: {size: [1, 1, 1], density: 1, radius: 1}", {"bodies.b.box.radius"}},
      {"sphere: {radius: -1, density: 1}", {"bodies.b.sphere.radius"}},
      {"sphere: {radius: 1, density: 1, length: 1}", {"bodies.b.sphere.length"}},
      {"cylinder: {radius: 1, density: 1}", {"bodies.b.cylinder.length"}},
      {"particles: [{mass: 1, position: [0, 0, 0]}]", {"bodies.b.particles", "positive"}},
      {"particles: [{mass: 1, position: [0, 0, 0], size: 1}]", {"bodies.b.particles", "size"}},
      {"particles: [{mass: 0, position: [0, 0, 0]}]", {"bodies.b.particles", "mass"}}};
  for (const Row& row : rows) EXPECT_TRUE(contains(refusalOf(row.yaml), row.parts)) << row.yaml;
}

TEST(BodyFromNumbers, RefusesANameThatIsNoFrame) {
  EXPECT_TRUE(contains(refusal([] { bodyFromNumbers(blockOf("point_mass: 1"), "a b"); }),
                       {"body 'a b'", "name must"}));
}

// ---- How it starts

/// An orientation along a generic quaternion, of this length.
std::string orientation(double length) {
  const Eigen::Vector4d xyzw = length * genericAttitude().coeffs();
  std::ostringstream text;
  text.precision(17);
  text << "point_mass: 1, orientation: [" << xyzw(0) << ", " << xyzw(1) << ", " << xyzw(2) << ", "
       << xyzw(3) << "]";
  return text.str();
}

TEST(InitialMotion, OrientationWithinAPercentIsNormalised) {
  for (const double length : {1.0, 1.009, 0.991}) {
    const Matrix3d R = bodyFrom(orientation(length)).X_WL.linear();
    EXPECT_LE(difference(R, genericAttitude().toRotationMatrix()), 8 * kEps) << length;
  }
}

TEST(InitialMotion, OrientationMoreThanAPercentOffIsRefused) {
  for (const double length : {1.011, 0.989, 2.0, 0.0})
    EXPECT_TRUE(contains(refusalOf(orientation(length)),
                         {"bodies.b.orientation", "unit quaternion x, y, z, w"}))
        << length;
}

TEST(InitialMotion, IsReadAndKeepsThePoseThatIsThere) {
  const Parameters block = blockOf("linear_velocity: [4, 5, 6], angular_velocity: [7, 8, 9]");
  SceneBody body;
  body.X_WL = genericPose();
  readInitialMotion(block, body);
  EXPECT_EQ(body.X_WL.matrix(), genericPose().matrix());
  EXPECT_EQ(body.v_WBcm, Vector3d(4, 5, 6));
  EXPECT_EQ(body.w_WB_L, Vector3d(7, 8, 9));
  readInitialMotion(blockOf("position: [1, 2, 3]"), body);
  EXPECT_EQ(body.X_WL.translation(), Vector3d(1, 2, 3));
  EXPECT_EQ(body.X_WL.linear(), genericPose().linear());
  EXPECT_EQ(body.v_WBcm, Vector3d(0, 0, 0));
}

// ---- Summary

std::string summaryOf(const std::string& yaml) { return summary(bodyFrom(yaml)); }

TEST(SummaryOfABody, ShowsThePrincipalMomentsOfAFullTensor) {
  // Moments 1, 2 and 2.5, the first two turned by 45 degrees about z: the diagonal
  // is 1.5, 1.5, 2.5.
  const std::string text = summaryOf("mass: 2, inertia: [1.5, 0.5, 0, 1.5, 0, 2.5]");
  EXPECT_TRUE(contains(text, {"b", "(1, 2, 2.5)"}));
  EXPECT_EQ(text.find("1.5"), std::string::npos) << text;
}

TEST(SummaryOfABody, ShowsAscendingMomentsMassAndCentre) {
  EXPECT_TRUE(contains(summaryOf("mass: 2, com: [0.1, 0.2, -0.3], inertia: [2.5, 1, 2]"),
                       {"2 kg", "(0.1, 0.2, -0.3) m", "(1, 2, 2.5) kg m^2"}));
}

TEST(SummaryOfABody, OfAPointMassShowsNoMoments) {
  const std::string text = summaryOf("point_mass: 0.7");
  EXPECT_TRUE(contains(text, {"0.7 kg", "point mass"}));
  EXPECT_EQ(text.find("moments"), std::string::npos) << text;
}

}  // namespace
}  // namespace rigid_body_sim

#include "rigid_body_sim/urdf.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <sstream>

namespace rigid_body_sim {
namespace {

constexpr double kEps = std::numeric_limits<double>::epsilon();

/// Rounding of a lump: some twenty products and sums an element, each of kEps / 2 of the largest.
constexpr double kLumpTolerance = 32 * kEps;

std::string numbers(const Vector3d& v) {
  std::ostringstream text;
  text.precision(17);
  text << v.x() << ' ' << v.y() << ' ' << v.z();
  return text.str();
}

std::string inertial(double mass, const Matrix3d& I, const Vector3d& xyz = Vector3d::Zero(),
                     const Vector3d& rpy = Vector3d::Zero()) {
  std::ostringstream text;
  text.precision(17);
  text << "<inertial><origin xyz='" << numbers(xyz) << "' rpy='" << numbers(rpy)
       << "'/><mass value='" << mass << "'/><inertia ixx='" << I(0, 0) << "' ixy='" << I(0, 1)
       << "' ixz='" << I(0, 2) << "' iyy='" << I(1, 1) << "' iyz='" << I(1, 2) << "' izz='"
       << I(2, 2) << "'/></inertial>";
  return text.str();
}

std::string link(const std::string& name, const std::string& inside = "") {
  return "<link name='" + name + "'>" + inside + "</link>";
}

std::string joint(const std::string& type, const std::string& parent, const std::string& child,
                  const Vector3d& xyz = Vector3d::Zero(), const Vector3d& rpy = Vector3d::Zero()) {
  return "<joint name='" + parent + "_" + child + "' type='" + type + "'><origin xyz='" +
         numbers(xyz) + "' rpy='" + numbers(rpy) + "'/><parent link='" + parent +
         "'/><child link='" + child + "'/></joint>";
}

UrdfModel read(const std::string& inside, MovableJoints movable = MovableJoints::kRefuse) {
  return readUrdf("<robot name='model'>" + inside + "</robot>", "test.urdf", movable);
}

/// URDF's roll, pitch, yaw: about the fixed x, then y, then z axis.
Matrix3d rotation(const Vector3d& rpy) {
  return (Eigen::AngleAxisd(rpy.z(), Vector3d::UnitZ()) *
          Eigen::AngleAxisd(rpy.y(), Vector3d::UnitY()) *
          Eigen::AngleAxisd(rpy.x(), Vector3d::UnitX()))
      .toRotationMatrix();
}

Isometry3d pose(const Vector3d& xyz, const Vector3d& rpy) {
  Isometry3d X = Isometry3d::Identity();
  X.linear() = rotation(rpy);
  X.translation() = xyz;
  return X;
}

void expectNear(const Isometry3d& a, const Isometry3d& b) {
  const double scale = 1 + b.translation().norm();
  EXPECT_LE((a.matrix() - b.matrix()).cwiseAbs().maxCoeff(), kLumpTolerance * scale);
}

void expectNear(const MassProperties& a, const MassProperties& b) {
  EXPECT_NEAR(a.mass, b.mass, kLumpTolerance * b.mass);
  EXPECT_LE((a.p_FBcm - b.p_FBcm).norm(), kLumpTolerance * (1 + b.p_FBcm.norm()));
  EXPECT_LE((a.I_BBcm_F - b.I_BBcm_F).norm(), kLumpTolerance * b.I_BBcm_F.norm());
}

const Vector3d kXyz(0.31, -0.72, 1.13);
const Vector3d kRpy(0.4, -0.9, 2.3);
const Vector3d kOtherXyz(-0.2, 0.05, 0.6);
const Vector3d kOtherRpy(-1.1, 0.35, 0.8);

Matrix3d genericTensor() {
  Matrix3d I;
  I << 0.11, 0.012, -0.007, 0.012, 0.13, 0.021, -0.007, 0.021, 0.17;
  return I;
}

const std::string kSphere = inertial(2, 0.1 * Matrix3d::Identity());

TEST(Urdf, OneLinkIsReadAsWritten) {
  const UrdfModel model = read(link("base", inertial(3.5, genericTensor(), kXyz)));
  EXPECT_EQ(model.name, "model");
  ASSERT_EQ(model.bodies.size(), 1u);
  EXPECT_EQ(model.bodies[0].name, "base");
  EXPECT_TRUE(model.bodies[0].frames.empty());
  EXPECT_TRUE(model.bodies[0].X_ML.isApprox(Isometry3d::Identity(), 0));
  EXPECT_TRUE(model.warnings.empty());
  expectNear(model.bodies[0].mass_properties, {3.5, kXyz, genericTensor()});
}

TEST(Urdf, IxyIsTheTensorElementNotTheProductOfInertia) {
  // Two particles of 1 kg at +-(1, 1, 0) and two of 0.1 kg at +-(0, 0, 1): tensor_xy = -sum m x y.
  const Matrix3d I = massPropertiesOfParticles(
                         {{1, {1, 1, 0}}, {1, {-1, -1, 0}}, {0.1, {0, 0, 1}}, {0.1, {0, 0, -1}}})
                         .I_BBcm_F;
  const UrdfModel model = read(
      link("base",
           "<inertial><mass value='2.2'/><inertia ixx='2.2' ixy='-2' ixz='0' iyy='2.2' iyz='0' "
           "izz='4'/></inertial>"));
  expectNear(model.bodies[0].mass_properties, {2.2, Vector3d::Zero(), I});
}

TEST(Urdf, InertialRpyRotatesTheTensor) {
  const Matrix3d R = rotation(kRpy);
  const UrdfModel by_rpy = read(link("base", inertial(3.5, genericTensor(), kXyz, kRpy)));
  const Matrix3d rotated = R * genericTensor() * R.transpose();
  const UrdfModel rotated_before = read(link("base", inertial(3.5, rotated, kXyz)));
  expectNear(by_rpy.bodies[0].mass_properties, rotated_before.bodies[0].mass_properties);
  EXPECT_GT((rotated - genericTensor()).norm(), 0.1 * genericTensor().norm());
}

TEST(Urdf, QuarterTurnOfYawSwapsXAndY) {
  const Matrix3d I = Vector3d(1, 2, 2.5).asDiagonal();
  const UrdfModel model =
      read(link("base", inertial(1, I, Vector3d::Zero(), {0, 0, 1.5707963267948966})));
  expectNear(model.bodies[0].mass_properties,
             {1, Vector3d::Zero(), Vector3d(2, 1, 2.5).asDiagonal()});
}

TEST(Urdf, TwoBallsOnARodMatchTheClosedForm) {
  // 1 kg at x = 0 and 3 kg at x = 2: CoM at 1.5, and m1 m2 / (m1 + m2) d^2 = 3 across the rod.
  const Matrix3d ball = 0.4 * Matrix3d::Identity();
  const UrdfModel model = read(link("a", inertial(1, ball)) + link("b", inertial(3, ball)) +
                               joint("fixed", "a", "b", {2, 0, 0}, kRpy));
  ASSERT_EQ(model.bodies.size(), 1u);
  expectNear(model.bodies[0].mass_properties,
             {4, {1.5, 0, 0}, Vector3d(0.8, 3.8, 3.8).asDiagonal()});
}

TEST(Urdf, BoxCutIntoRotatedPiecesIsTheWholeBox) {
  // A 2 x 3 x 5 box of density 7, cut at x = 0.4 and the larger piece again at z = -1; every link
  // frame has its own place and attitude, every tensor its own axes.
  const auto piece = [](const Vector3d& low, const Vector3d& high) {
    MassProperties box = solidBox(high - low, 7);
    box.p_FBcm = 0.5 * (low + high);
    return box;
  };
  const MassProperties parts[] = {piece({-1, -1.5, -2.5}, {0.4, 1.5, -1}),
                                  piece({-1, -1.5, -1}, {0.4, 1.5, 2.5}),
                                  piece({0.4, -1.5, -2.5}, {1, 1.5, 2.5})};
  const auto inertialIn = [](const Isometry3d& X_LF, const MassProperties& part,
                             const Vector3d& rpy) {
    const MassProperties local = expressedIn(X_LF.inverse(), part);
    const Matrix3d R = rotation(rpy);
    return inertial(local.mass, R.transpose() * local.I_BBcm_F * R, local.p_FBcm, rpy);
  };
  const Isometry3d X_LB = pose(kXyz, kRpy);
  const Isometry3d X_LC = X_LB * pose(kOtherXyz, kOtherRpy);
  const UrdfModel model =
      read(link("a", inertialIn(Isometry3d::Identity(), parts[0], kOtherRpy)) +
           link("b", inertialIn(X_LB, parts[1], kRpy)) +
           link("c", inertialIn(X_LC, parts[2], -kOtherRpy)) +
           joint("fixed", "a", "b", kXyz, kRpy) + joint("fixed", "b", "c", kOtherXyz, kOtherRpy));
  ASSERT_EQ(model.bodies.size(), 1u);
  expectNear(model.bodies[0].mass_properties, solidBox({2, 3, 5}, 7));
  ASSERT_EQ(model.bodies[0].frames.size(), 2u);
  EXPECT_EQ(model.bodies[0].frames[1].name, "c");
  expectNear(model.bodies[0].frames[1].X_LF, X_LC);
  EXPECT_TRUE(model.warnings.empty());
}

TEST(Urdf, TensorOfALumpIsExactlySymmetric) {
  const UrdfModel model = read(link("a", inertial(1, genericTensor(), kXyz, kRpy)) +
                               link("b", inertial(2, genericTensor(), kOtherXyz, kOtherRpy)) +
                               joint("fixed", "a", "b", kXyz, kRpy));
  const Matrix3d I = model.bodies[0].mass_properties.I_BBcm_F;
  EXPECT_TRUE(I.isApprox(I.transpose(), 0));
}

TEST(Urdf, FloatingJointStartsABody) {
  const UrdfModel model = read(link("a", kSphere) + link("b", kSphere) + link("c", kSphere) +
                               link("d", kSphere) + joint("fixed", "a", "b", kXyz, kRpy) +
                               joint("floating", "b", "c", kOtherXyz, kOtherRpy) +
                               joint("floating", "c", "d", kXyz, kOtherRpy));
  ASSERT_EQ(model.bodies.size(), 3u);
  EXPECT_EQ(model.bodies[0].name, "a");
  EXPECT_EQ(model.bodies[0].mass_properties.mass, 4);
  EXPECT_EQ(model.bodies[1].name, "c");
  EXPECT_EQ(model.bodies[1].mass_properties.mass, 2);
  EXPECT_TRUE(model.bodies[1].frames.empty());
  const Isometry3d X_MC = pose(kXyz, kRpy) * pose(kOtherXyz, kOtherRpy);
  expectNear(model.bodies[1].X_ML, X_MC);
  EXPECT_EQ(model.bodies[2].name, "d");
  expectNear(model.bodies[2].X_ML, X_MC * pose(kXyz, kOtherRpy));
}

TEST(Urdf, MasslessWorldRootIsAFrame) {
  const UrdfModel model = read(link("world") + link("a", kSphere) + link("b", kSphere) +
                               joint("floating", "world", "a", kXyz, kRpy) +
                               joint("fixed", "world", "b", kOtherXyz, kOtherRpy));
  ASSERT_EQ(model.bodies.size(), 2u);
  EXPECT_EQ(model.bodies[0].name, "a");
  expectNear(model.bodies[0].X_ML, pose(kXyz, kRpy));
  EXPECT_EQ(model.bodies[1].name, "b");
  expectNear(model.bodies[1].X_ML, pose(kOtherXyz, kOtherRpy));
  ASSERT_EQ(model.warnings.size(), 1u);  // a fixed joint that does not hold
  EXPECT_NE(model.warnings[0].find("joint 'world_b'"), std::string::npos) << model.warnings[0];
}

TEST(Urdf, LockedJointOnAMasslessWorldIsTwoWarnings) {
  const std::string text =
      link("world") + link("a", kSphere) + joint("continuous", "world", "a", kXyz, kRpy);
  EXPECT_THROW(read(text), std::invalid_argument);
  const UrdfModel model = read(text, MovableJoints::kLock);
  ASSERT_EQ(model.bodies.size(), 1u);
  expectNear(model.bodies[0].X_ML, pose(kXyz, kRpy));
  ASSERT_EQ(model.warnings.size(), 2u);
  EXPECT_EQ(model.warnings[0], "joint 'world_a': is continuous, locked at zero");
  EXPECT_NE(model.warnings[1].find("holds nothing"), std::string::npos) << model.warnings[1];
}

TEST(Urdf, WorldRootWithMassIsABody) {
  const UrdfModel model =
      read(link("world", kSphere) + link("a", kSphere) + joint("fixed", "world", "a", kXyz));
  ASSERT_EQ(model.bodies.size(), 1u);
  EXPECT_EQ(model.bodies[0].name, "world");
  EXPECT_EQ(model.bodies[0].mass_properties.mass, 4);
}

TEST(Urdf, LockedJointsLumpAtZeroWithAWarning) {
  const std::string text = link("a", kSphere) + link("b", kSphere) + link("c", kSphere) +
                           joint("continuous", "a", "b", kXyz, kRpy) +
                           joint("planar", "b", "c", kOtherXyz, kOtherRpy);
  const std::string fixed = link("a", kSphere) + link("b", kSphere) + link("c", kSphere) +
                            joint("fixed", "a", "b", kXyz, kRpy) +
                            joint("fixed", "b", "c", kOtherXyz, kOtherRpy);
  EXPECT_THROW(read(text), std::invalid_argument);
  const UrdfModel locked = read(text, MovableJoints::kLock);
  ASSERT_EQ(locked.bodies.size(), 1u);
  expectNear(locked.bodies[0].mass_properties, read(fixed).bodies[0].mass_properties);
  ASSERT_EQ(locked.warnings.size(), 2u);
  EXPECT_EQ(locked.warnings[0], "joint 'a_b': is continuous, locked at zero");
  EXPECT_EQ(locked.warnings[1], "joint 'b_c': is planar, locked at zero");
}

TEST(Urdf, LinksWithoutInertialAreFramesOnly) {
  const UrdfModel model =
      read(link("a") + link("b", kSphere) + joint("fixed", "a", "b", kXyz, kRpy));
  ASSERT_EQ(model.bodies.size(), 1u);
  EXPECT_EQ(model.bodies[0].name, "a");
  expectNear(model.bodies[0].mass_properties, {2, kXyz, Matrix3d(0.1 * Matrix3d::Identity())});
  EXPECT_TRUE(model.warnings.empty());
}

TEST(Urdf, AbsentOriginsAreTheIdentity) {
  const UrdfModel model = read(
      "<link name='a'><inertial><mass value='1'/><inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' "
      "izz='1'/></inertial></link><link name='b'/><joint name='j' type='fixed'><parent "
      "link='a'/><child link='b'/></joint><link name='c'/><joint name='k' "
      "type='fixed'><origin/><parent link='a'/><child link='c'/></joint>");
  EXPECT_TRUE(model.bodies[0].mass_properties.p_FBcm.isZero(0));
  for (const FixedFrame& frame : model.bodies[0].frames)
    EXPECT_TRUE(frame.X_LF.isApprox(Isometry3d::Identity(), 0));
}

TEST(Urdf, UnphysicalLeafOfAGoodLumpIsAWarning) {
  const Matrix3d broken = Vector3d(1e-3, 1e-3, 5e-3).asDiagonal();
  const UrdfModel model =
      read(link("a", kSphere) + link("leaf", inertial(0.1, broken)) +
           link("point", inertial(0.2, Matrix3d::Zero())) + link("ghost", inertial(0, broken)) +
           joint("fixed", "a", "leaf", kXyz) + joint("fixed", "a", "point", kXyz) +
           joint("fixed", "a", "ghost", kXyz));
  ASSERT_EQ(model.warnings.size(), 3u);
  const std::string all = model.warnings[0] + model.warnings[1] + model.warnings[2];
  for (const char* part : {"link 'leaf': ", "triangle inequality", "0.005",
                           "link 'point': ", "point mass of 0.2 kg", "link 'ghost': mass is 0"})
    EXPECT_NE(all.find(part), std::string::npos) << part << " in " << all;
}

TEST(Urdf, WhatTheParserComplainsOfIsAWarning) {
  const UrdfModel model =
      read(link("a", kSphere + "<visual><geometry><sphere radius='big'/></geometry></visual>"));
  ASSERT_FALSE(model.warnings.empty());
  EXPECT_NE(model.warnings.back().find("Link [a]"), std::string::npos) << model.warnings.back();
}

TEST(Urdf, PrintfFormatsInAttributesAreHarmless) {
  // The parser hands its message, with the value inside, to printf as the format.
  const UrdfModel model = read(
      link("a", kSphere + "<visual><geometry><sphere radius='%s%s%s%s%n%n%n&#37;s'/></geometry>"
                          "</visual>"));
  EXPECT_FALSE(model.warnings.empty());
}

TEST(Urdf, HarmlessXmlIsRead) {
  const std::string text =
      "\xEF\xBB\xBF<?xml version=\"1.0\" encoding='utf-8' ?>\r\n<?xml-model href='x'?>\n"
      "<!-- -- > <robot> & \xC3\xA9 -->\n<robot\n name = 'r&#233;&amp;d' >text &lt; ]"
      "<gazebo><![CDATA[<link name='no'/>]]> a &#x41; b</gazebo><gazebo/>"
      "<transmission name='t'><joint name='none'/></transmission>"
      "<link name='a'><inertial><origin xyz=' 1  2 3 ' rpy='-0 +.5 1.e-1'/>"
      "<mass value='+1.5E+0'/><inertia ixx='1' ixy='-0.0' ixz='1e-320' iyy='1' iyz='0' izz='1'/>"
      "</inertial><visual><geometry><mesh filename='a>b.stl'/></geometry></visual></link></robot>"
      "<!-- end -->\n";
  const UrdfModel model = readUrdf(text, "test.urdf");
  ASSERT_EQ(model.bodies.size(), 1u);
  EXPECT_EQ(model.bodies[0].mass_properties.mass, 1.5);
  expectNear(model.bodies[0].mass_properties, {1.5, {1, 2, 3}, Matrix3d::Identity()});
}

TEST(Urdf, EveryLengthOfUtf8IsRead) {
  // The first and last character of each range of RFC 3629, section 4.
  for (const char* character :
       {"\xC2\x80", "\xDF\xBF", "\xE0\xA0\x80", "\xE0\xBF\xBF", "\xE1\x80\x80", "\xEC\xBF\xBF",
        "\xED\x80\x80", "\xED\x9F\xBF", "\xEE\x80\x80", "\xEF\xBF\xBD", "\xF0\x90\x80\x80",
        "\xF0\xBF\xBF\xBF", "\xF1\x80\x80\x80", "\xF3\xBF\xBF\xBF", "\xF4\x80\x80\x80",
        "\xF4\x8F\xBF\xBF"})
    EXPECT_EQ(read("<!-- " + std::string(character) + " -->" + link("a", kSphere)).bodies.size(),
              1u);
}

TEST(Urdf, ChainOfTenThousandLinksIsOneBody) {
  constexpr int kLinks = 10000;
  const auto name = [](int i) { return "l" + std::to_string(10000 + i); };
  std::string text = link(name(0), kSphere);
  for (int i = 1; i < kLinks; ++i)
    text += link(name(i)) + joint("fixed", name(i - 1), name(i), {0, 0, 1});
  const UrdfModel model = read(text);
  ASSERT_EQ(model.bodies.size(), 1u);
  ASSERT_EQ(model.bodies[0].frames.size(), kLinks - 1u);
  EXPECT_EQ(model.bodies[0].frames.back().X_LF.translation(), Vector3d(0, 0, kLinks - 1));
}

TEST(Urdf, LimitsThemselvesAreAllowed) {
  std::string nested = kSphere;
  for (int i = 0; i < 62; ++i) nested += "<e>";  // inside robot and link: 64 levels
  for (int i = 0; i < 62; ++i) nested += "</e>";
  std::string attributes;
  for (int i = 0; i < 256; ++i) attributes += " a" + std::to_string(i) + "=''";
  EXPECT_EQ(read(link("a", nested) + "<gazebo" + attributes + "/>").bodies.size(), 1u);
  EXPECT_EQ(read(link("a" + std::string(254, '-'), kSphere)).bodies.size(), 1u);
}

TEST(Urdf, ReportTellsAllThatWasRead) {
  const UrdfModel model = read(
      link("base", inertial(1.25, genericTensor(), kXyz)) + link("tip") + link("free", kSphere) +
          joint("continuous", "base", "tip", {0.5, 0, 0.25}) + joint("floating", "tip", "free"),
      MovableJoints::kLock);
  const std::string report = importReport(model);
  for (const char* part :
       {"model 'model': bodies 2, warnings 1\n", "body 'base'", "body 'free'", "mass [kg]", "1.25",
        "CoM [m]", "-0.72", "inertia [kg m^2]", "0.021", "principal moments [kg m^2]",
        "principal axes", "quaternion xyzw", "lumped link 'tip'", "0.25",
        "joint 'base_tip': is continuous, locked at zero"})
    EXPECT_NE(report.find(part), std::string::npos) << part << " in\n" << report;
  EXPECT_EQ(report.back(), '\n');
}

TEST(Urdf, NamesThatCanBeTopicsPass) {
  for (const char* name : {"a", "Body_1", "left/arm-2", "x9"})
    EXPECT_NO_THROW(requireName(name, "body")) << name;
  for (const char* name :
       {"", "1a", "_a", "/a", "a/", "a//b", "..", "a..b", "a.b", "a b", "a\n", "\xC3\xA9", "~a"})
    EXPECT_THROW(requireName(name, "body"), std::invalid_argument) << name;
  EXPECT_NO_THROW(requireName(std::string(255, 'a'), "body"));
  EXPECT_THROW(requireName(std::string(256, 'a'), "body"), std::invalid_argument);
}

}  // namespace
}  // namespace rigid_body_sim

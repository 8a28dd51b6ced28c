#include "rigid_body_sim/scene.hpp"

#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "generic.hpp"

namespace rigid_body_sim {
namespace {

SceneBody bodyFrom(const std::string& block) {
  return sceneFrom("bodies: {b: {" + block + "}}").bodies.at(0);
}

TEST(Scene, OfOneBodyHasTheDefaultsOfTheRest) {
  const Scene scene = sceneFrom("bodies: {b: {sphere: {radius: 0.5, density: 3}}}");
  EXPECT_EQ(scene.step_ns, 20'000'000);
  EXPECT_EQ(scene.step_s(), 0.02);
  EXPECT_EQ(scene.integrator, "exact");
  EXPECT_EQ(scene.gyroscopic, Gyroscopic::kOn);
  EXPECT_TRUE(scene.effects.empty());
  EXPECT_EQ(scene.import_report, "");
  ASSERT_EQ(scene.bodies.size(), 1u);
  EXPECT_EQ(scene.bodies[0].name, "b");
  EXPECT_EQ(scene.bodies[0].X_WL.matrix(), Isometry3d::Identity().matrix());
  EXPECT_EQ(scene.bodies[0].v_WBcm, Vector3d::Zero());
  EXPECT_EQ(scene.bodies[0].w_WB_L, Vector3d::Zero());
}

TEST(Scene, StepIsWholeNanosecondsAndItsSecondsTheNumberThatWasWritten) {
  for (const char* step : {"0.02", "0.005", "0.003", "0.007", "0.0041", "0.0082", "1.0e-6", "1",
                           "0.000123457", "0.1"}) {
    const Scene scene =
        sceneFrom(std::string("{step_s: ") + step + ", bodies: {b: {point_mass: 1}}}");
    EXPECT_EQ(scene.step_s(), std::strtod(step, nullptr)) << step;
  }
}

TEST(Scene, TakesTheIntegratorByNameAndTheGyroscopicSwitch) {
  for (const IntegratorRow& row : integrators()) {
    const Scene scene = sceneFrom("{integrator: " + row.name +
                                  ", effects: {gyroscopic: false}, bodies: {b: {point_mass: 1}}}");
    EXPECT_EQ(scene.integrator, row.name);
    EXPECT_EQ(scene.gyroscopic, Gyroscopic::kOff);
  }
}

TEST(SceneBody, OfNumbersHasThoseNumbers) {
  const SceneBody body = bodyFrom("mass: 2, com: [0.1, 0.2, -0.3], inertia: [1, 2, 2.5]");
  EXPECT_EQ(body.mass_properties.mass, 2);
  EXPECT_EQ(body.mass_properties.p_FBcm, Vector3d(0.1, 0.2, -0.3));
  EXPECT_EQ(body.mass_properties.I_BBcm_F, Matrix3d(Vector3d(1, 2, 2.5).asDiagonal()));
}

TEST(SceneBody, OfSixTensorElementsHasTheOrderOfUrdf) {
  Matrix3d I;  // ixx ixy ixz iyy iyz izz
  I << 1.6, -0.3, 0.2, -0.3, 2.1, 0.4, 0.2, 0.4, 1.8;
  EXPECT_EQ(bodyFrom("mass: 1, inertia: [1.6, -0.3, 0.2, 2.1, 0.4, 1.8]").mass_properties.I_BBcm_F,
            I);
}

TEST(SceneBody, OfAShapeHasItsMassProperties) {
  const auto expectSame = [](const MassProperties& a, const MassProperties& b) {
    EXPECT_EQ(a.mass, b.mass);
    EXPECT_EQ(a.p_FBcm, b.p_FBcm);
    EXPECT_EQ(a.I_BBcm_F, b.I_BBcm_F);
  };
  expectSame(bodyFrom("box: {size: [1, 2, 3], density: 4}").mass_properties,
             solidBox({1, 2, 3}, 4));
  expectSame(bodyFrom("sphere: {radius: 0.5, density: 4}").mass_properties, solidSphere(0.5, 4));
  expectSame(bodyFrom("cylinder: {radius: 0.5, length: 2, density: 4}").mass_properties,
             solidCylinder(0.5, 2, 4));
  expectSame(bodyFrom("particles: [{mass: 1, position: [0, 0, 1]}, {mass: 2, position: [1, 0, 0]}, "
                      "{mass: 3, position: [0, 1, 0]}]")
                 .mass_properties,
             massPropertiesOfParticles({{1, {0, 0, 1}}, {2, {1, 0, 0}}, {3, {0, 1, 0}}}));
}

TEST(SceneBody, OfAPointMassHasOnlyAMass) {
  const SceneBody body =
      bodyFrom("point_mass: 0.7, position: [1, 2, 3], linear_velocity: [4, 5, 6]");
  EXPECT_TRUE(body.is_point_mass);
  EXPECT_EQ(body.mass_properties.mass, 0.7);
  EXPECT_EQ(body.X_WL.translation(), Vector3d(1, 2, 3));
  EXPECT_EQ(body.v_WBcm, Vector3d(4, 5, 6));
}

TEST(SceneBody, StartsWithThePoseAndVelocitiesItIsGiven) {
  const SceneBody body = bodyFrom(
      "mass: 1, inertia: [1, 1, 1], position: [1, 2, 3], linear_velocity: [4, 5, 6], "
      "angular_velocity: [7, 8, 9], orientation: [0, 0, 0.6, 0.8]");
  EXPECT_EQ(body.X_WL.translation(), Vector3d(1, 2, 3));
  EXPECT_EQ(body.v_WBcm, Vector3d(4, 5, 6));
  EXPECT_EQ(body.w_WB_L, Vector3d(7, 8, 9));
  // x, y, z, w: a turn about z with cosine 1 - 2 0.36 and sine 2 0.6 0.8.
  EXPECT_LE(difference(body.X_WL.linear() * Vector3d::UnitX(), Vector3d(0.28, 0.96, 0)), 4 * kEps);
}

TEST(SceneBody, OrientationThatIsRoundedIsNormalised) {
  const SceneBody body = bodyFrom("point_mass: 1, orientation: [0.5, 0.5, 0.5, 0.504]");
  EXPECT_LE(difference(body.X_WL.linear() * body.X_WL.linear().transpose(), Matrix3d::Identity()),
            8 * kEps);
}

TEST(SceneEffects, GravityActsOnAllBodiesThatDoNotSayFalse) {
  const Scene scene = sceneFrom(
      "{effects: {gravity: {acceleration: [0, 0, -9.8]}},"
      " bodies: {a: {point_mass: 1}, b: {point_mass: 2, gravity: false}, c: {point_mass: 3, "
      "gravity: true}}}");
  ASSERT_EQ(scene.effects.size(), 1u);
  EXPECT_EQ(scene.effects[0]->name(), "gravity");
  EXPECT_EQ(scene.effects[0]->bodyCount(), 2u);
  Simulator simulator(scene);
  simulator.step();
  EXPECT_NE(simulator.state(0).P_WB, Vector3d::Zero());
  EXPECT_EQ(simulator.state(1).P_WB, Vector3d::Zero());
  EXPECT_NE(simulator.state(2).P_WB, Vector3d::Zero());
}

TEST(SceneEffects, ThatDoNothingAreDropped) {
  EXPECT_TRUE(
      sceneFrom("{effects: {gravity: {acceleration: [0, 0, 0]}}, bodies: {a: {point_mass: 1}}}")
          .effects.empty());
  EXPECT_TRUE(
      sceneFrom("{effects: {gravity: {acceleration: [0, 0, -9.8]}}, bodies: {a: {point_mass: 1, "
                "gravity: false}}}")
          .effects.empty());
  EXPECT_TRUE(sceneFrom("{effects: {}, bodies: {a: {point_mass: 1}}}").effects.empty());
  EXPECT_TRUE(sceneFrom("{effects: {damping: {linear: 1}}, bodies: {a: {point_mass: 1, "
                        "damping: false}}}")
                  .effects.empty());
  EXPECT_TRUE(contains(refusal([] {
                         sceneFrom(
                             "{effects: {damping: {linaer: 1}}, bodies: {a: {point_mass: 1, "
                             "damping: false}}}");
                       }),
                       {"effects.damping.linaer: unknown key", "'linear'"}));
}

TEST(SceneEffects, MayBeDeclinedWhereTheSceneHasNone) {
  EXPECT_TRUE(sceneFrom("bodies: {a: {point_mass: 1, gravity: false}}").effects.empty());
}

TEST(SceneSummary, SaysInOneLineWhatIsSimulated) {
  EXPECT_EQ(summary(sceneFrom("{step_s: 0.005, effects: {gravity: {acceleration: [0, 0, -9.8]}, "
                              "gyroscopic: false}, bodies: {a: {point_mass: 1}, b: {point_mass: 2, "
                              "gravity: false}}}")),
            "2 bodies; effects: gravity (1 body), gyroscopic off; integrator: exact, step 0.005 s");
}

TEST(SceneAccuracy, NamesAMisspeltKeyBeforeOneThatIsMissing) {
  const std::string ball = "bodies: {b: {point_mass: 1}}";
  EXPECT_TRUE(contains(
      refusal([&] { sceneFrom("{accuracy: {atitude_rad: 1.0e-6, over_s: 60}, " + ball + "}"); }),
      {"accuracy.atitude_rad", "did you mean 'attitude_rad'"}));
  EXPECT_TRUE(contains(
      refusal([&] { sceneFrom("{accuracy: {position_m: 1.0e-6, ower_s: 60}, " + ball + "}"); }),
      {"accuracy.ower_s", "did you mean 'over_s'"}));
}

struct BadScene {
  const char* yaml;
  std::vector<std::string> parts;
};

TEST(Scene, ThatIsWrongIsRefusedWithPathValueAndWhatIsAllowed) {
  const std::string ball = "bodies: {b: {point_mass: 1}}";
  const std::vector<BadScene> rows = {
      {"", {"bodies: ", "no body"}},
      {"bodies: {}", {"bodies: ", "no body"}},
      {"bodies: 5", {"bodies: 5 is not a map"}},
      {"{step_s: 0, BALL}", {"step_s: 0 ", "from 1e-06 to 1 [s]"}},
      {"{step_s: -0.02, BALL}", {"step_s: -0.02 ", "[s]"}},
      {"{step_s: 10, BALL}", {"step_s: 10 ", "from 1e-06 to 1 [s]"}},
      {"{step_s: .nan, BALL}", {"step_s: nan "}},
      {"{step_s: '0.02', BALL}", {"step_s: '0.02' ", "leave the quotes out"}},
      {"{step_s: true, BALL}", {"step_s: true "}},
      {"{step_s: 0.0000012345, BALL}", {"step_s: ", "whole number of nanoseconds"}},
      {"{step_s: 0.00410000000000001, BALL}", {"step_s: ", "whole number of nanoseconds"}},
      {"{step_s: 0.00819999999999999, BALL}", {"step_s: ", "whole number of nanoseconds"}},
      {"{stepp_s: 0.02, BALL}", {"stepp_s: unknown key", "'step_s'"}},
      {"{integrator: rk44, BALL}", {"integrator: 'rk44' ", "split2"}},
      {"{integrator: 5, BALL}", {"integrator: 5 ", "string"}},
      {"{joints: bend, BALL}", {"joints: 'bend' ", "refuse or lock"}},
      {"{urdf: a.urdf, BALL}", {"urdf: 'a.urdf' is not a list"}},
      {"{urdf: [/no/such.urdf], BALL}", {"/no/such.urdf"}},
      {"{urdf_parameter: robot_description, BALL}", {"urdf_parameter: ", "no parameter server"}},
      {"{effects: {gravty: {}}, BALL}", {"effects.gravty: unknown key", "'gravity'"}},
      {"{effects: {gravity: -9.8}, BALL}", {"effects.gravity: -9.8 is not a map"}},
      {"{effects: {gravity: {}}, BALL}", {"effects.gravity.acceleration: is missing", "[m/s^2]"}},
      {"{effects: {gravity: {accel: [0, 0, -9.8]}}, BALL}",
       {"effects.gravity.acceleration: is missing", "there is 'accel' instead"}},
      {"{effects: {drag: {air_desity: 1.2}}, BALL}",
       {"effects.drag.air_density: is missing", "there is 'air_desity' instead"}},
      {"{effects: {spring: [{body: b, anchor: [0, 0, 0], stifness: 1}]}, BALL}",
       {"effects.spring[0].stiffness: is missing", "there is 'stifness' instead"}},
      {"{effects: {gravity: false}, BALL}", {"effects.gravity: ", "left out", "~switch_effect"}},
      {"{effects: {spring: true}, BALL}", {"effects.spring: ", "left out"}},
      {"{effects: {gravity: {acceleration: [0, -9.8]}}, BALL}",
       {"effects.gravity.acceleration: [0, -9.8]", "3 numbers [m/s^2]"}},
      {"{effects: {gravity: {acceleration: [0, 0, .inf]}}, BALL}",
       {"effects.gravity.acceleration[2]: inf", "[m/s^2]"}},
      {"{effects: {gravity: {acceleration: [0, 0, 0], mu: 1}}, BALL}",
       {"effects.gravity.mu: unknown key"}},
      {"{effects: {gyroscopic: 1}, BALL}", {"effects.gyroscopic: 1 is not true or false"}},
      {"bodies: {b: 5}", {"bodies.b: 5 is not a map"}},
      {"bodies: {b: {}}", {"bodies.b: ", "no URDF", "point_mass"}},
      {"bodies: {b-: {}}", {"bodies.b-: "}},
      {"bodies: {1b: {point_mass: 1}}", {"1b"}},
      {"bodies: {a.b: {point_mass: 1}}", {"a.b"}},
      {"bodies: {b: {mass: 1}}", {"bodies.b.inertia: is missing", "3 or 6 numbers [kg m^2]"}},
      {"bodies: {b: {mass: 0, inertia: [1, 1, 1]}}", {"bodies.b.mass: 0 ", "> 0 [kg]"}},
      {"bodies: {b: {mass: 1, inertia: [1, 1]}}", {"bodies.b.inertia: [1, 1]"}},
      {"bodies: {b: {mass: 1, inertia: [1, 1, 3]}}", {"bodies.b.inertia: ", "triangle inequality"}},
      {"bodies: {b: {mass: 1, inertia: [1, 1, 0]}}", {"bodies.b.inertia: ", "must be positive"}},
      {"bodies: {b: {mass: 1, inertia: [1, 1, 1], com: [1, 2]}}", {"bodies.b.com: ", "[m]"}},
      {"bodies: {b: {mass: 1, inertia: [1, 1, 1], sphere: {}}}",
       {"bodies.b.sphere: ", "already has 'mass'"}},
      {"bodies: {b: {box: {size: [1, 2, 0], density: 1}}}",
       {"bodies.b.box.size[2]: 0 ", "> 0 [m]"}},
      {"bodies: {b: {box: {size: [1, 2, 3]}}}", {"bodies.b.box.density: is missing", "[kg/m^3]"}},
      {"bodies: {b: {sphere: {radius: 1, density: 1, length: 1}}}",
       {"bodies.b.sphere.length: unknown key"}},
      {"bodies: {b: {sphere: 1}}", {"bodies.b.sphere: 1 is not a map"}},
      {"bodies: {b: {cylinder: {radius: -1, length: 1, density: 1}}}",
       {"bodies.b.cylinder.radius: -1 ", "[m]"}},
      {"bodies: {b: {box: {size: [1.0e+200, 1.0e+200, 1.0e+200], density: 1}}}",
       {"bodies.b.box: mass is inf"}},
      {"bodies: {b: {particles: []}}", {"no particle"}},
      {"bodies: {b: {particles: [{mass: 1}]}}", {"bodies.b.particles[0].position: is missing"}},
      {"bodies: {b: {particles: [{mass: 1, position: [0, 0, 0]}, {mass: 1, position: [0, 1, 2]}]}}",
       {"bodies.b.particles: ", "must be positive"}},
      {"bodies: {b: {point_mass: 0}}", {"bodies.b.point_mass: 0 ", "[kg]"}},
      {"bodies: {b: {point_mass: 1, angular_velocity: [0, 0, 1]}}",
       {"bodies.b.angular_velocity: ", "no rotation"}},
      {"bodies: {b: {point_mass: 1, position: [0, 0]}}", {"bodies.b.position: [0, 0]", "[m]"}},
      {"bodies: {b: {point_mass: 1, velocity: [0, 0, 0]}}", {"bodies.b.velocity: unknown key"}},
      {"bodies: {b: {point_mass: 1, orientation: [0, 0, 0]}}",
       {"bodies.b.orientation: ", "4 numbers [x, y, z, w]"}},
      {"bodies: {b: {point_mass: 1, orientation: [0, 0, 0, 0]}}",
       {"bodies.b.orientation: ", "unit quaternion", "length 0"}},
      {"bodies: {b: {point_mass: 1, orientation: [1, 0, 0, 1]}}",
       {"bodies.b.orientation: ", "length 1.41"}},
      {"bodies: {b: {point_mass: 1, gravity: 0}}", {"bodies.b.gravity: 0 is not true or false"}},
      {"bodies: {b: {point_mass: 1, gravity: true}}",
       {"bodies.b.gravity: ", "list it under `effects`"}},
  };
  for (const BadScene& row : rows) {
    std::string yaml = row.yaml;
    if (const auto at = yaml.find("BALL"); at != std::string::npos) yaml.replace(at, 4, ball);
    EXPECT_TRUE(contains(refusal([&] { sceneFrom(yaml); }), row.parts)) << yaml;
  }
}

/// A folder that is removed with all it holds.
class SceneFile : public testing::Test {
 protected:
  SceneFile()
      : folder_(std::filesystem::temp_directory_path() /
                (std::string("scene_file_") + std::to_string(getpid()))) {
    std::filesystem::create_directories(folder_ / "bodies");
  }
  ~SceneFile() override { std::filesystem::remove_all(folder_); }

  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
    return (folder_ / name).string();
  }

  std::filesystem::path folder_;
};

const char kUrdf[] =
    "<robot name='r'><link name='brick'><inertial><origin xyz='0.1 0.2 0.3'/><mass value='2'/>"
    "<inertia ixx='1' iyy='2' izz='2.5' ixy='0' ixz='0' iyz='0'/></inertial></link></robot>";

TEST_F(SceneFile, FindsUrdfsFromItsOwnFolder) {
  write("bodies/brick.urdf", kUrdf);
  const Scene scene = readSceneFile(
      write("s.yaml",
            "{urdf: [bodies/brick.urdf], bodies: {brick: {position: [1, 2, 3], gravity: false},"
            " another: {point_mass: 1}}}"));
  ASSERT_EQ(scene.bodies.size(), 2u);
  EXPECT_EQ(scene.bodies[0].name, "brick");
  EXPECT_EQ(scene.bodies[0].mass_properties.mass, 2);
  EXPECT_EQ(scene.bodies[0].mass_properties.p_FBcm, Vector3d(0.1, 0.2, 0.3));
  EXPECT_EQ(scene.bodies[0].X_WL.translation(), Vector3d(1, 2, 3));
  EXPECT_EQ(scene.bodies[1].name, "another");
  EXPECT_TRUE(contains(scene.import_report, {"brick"}));
}

TEST_F(SceneFile, KeepsPosesFramesAndWarningsOfAUrdf) {
  const std::string inertial =
      "<inertial><mass value='2'/><inertia ixx='1' iyy='2' izz='2.5' "
      "ixy='0' ixz='0' iyz='0'/></inertial>";
  const auto joint = [](const std::string& name, const std::string& type, const std::string& parent,
                        const std::string& child, const std::string& origin) {
    return "<joint name='" + name + "' type='" + type + "'><parent link='" + parent +
           "'/><child link='" + child + "'/><origin " + origin +
           "/><axis xyz='0 0 1'/><limit effort='1' velocity='1' lower='-1' upper='1'/></joint>";
  };
  write("bodies/two.urdf",
        "<robot name='two'><link name='base'>" + inertial + "</link><link name='lid'>" + inertial +
            "</link><link name='camera'/><link name='drone'>" + inertial + "</link>" +
            joint("hinge", "revolute", "base", "lid", "xyz='0.1 0.2 0.3' rpy='0 0 0.5'") +
            joint("mount", "fixed", "lid", "camera", "xyz='1 0 0'") +
            joint("free", "floating", "lid", "drone", "xyz='4 5 6' rpy='0.3 0 0'") + "</robot>");
  const Scene scene = readSceneFile(
      write("s.yaml",
            "{urdf: [bodies/two.urdf], joints: lock, bodies: {drone: {linear_velocity: [1, 2, "
            "3]}}}"));
  Isometry3d X_base_lid = Isometry3d::Identity(), X_lid_drone = Isometry3d::Identity();
  X_base_lid.translation() << 0.1, 0.2, 0.3;
  X_base_lid.rotate(Eigen::AngleAxisd(0.5, Vector3d::UnitZ()));
  X_lid_drone.translation() << 4, 5, 6;
  X_lid_drone.rotate(Eigen::AngleAxisd(0.3, Vector3d::UnitX()));

  ASSERT_EQ(scene.bodies.size(), 2u);
  const SceneBody &base = scene.bodies[0], &drone = scene.bodies[1];
  EXPECT_EQ(base.name, "base");
  EXPECT_EQ(base.mass_properties.mass, 4);
  EXPECT_EQ(base.X_WL.matrix(), Isometry3d::Identity().matrix());
  ASSERT_EQ(base.frames.size(), 2u);
  EXPECT_EQ(base.frames[0].name, "lid");
  EXPECT_LE(difference(base.frames[0].X_LF.matrix(), X_base_lid.matrix()), 4 * kEps);
  EXPECT_EQ(base.frames[1].name, "camera");
  EXPECT_LE(difference(base.frames[1].X_LF.translation(), X_base_lid * Vector3d(1, 0, 0)),
            4 * kEps);
  EXPECT_EQ(drone.name, "drone");
  EXPECT_TRUE(drone.frames.empty());
  EXPECT_LE(difference(drone.X_WL.matrix(), (X_base_lid * X_lid_drone).matrix()), 16 * kEps);
  EXPECT_EQ(drone.v_WBcm, Vector3d(1, 2, 3));
  ASSERT_EQ(scene.warnings.size(), 1u);
  EXPECT_TRUE(contains(scene.warnings[0], {"hinge"}));
  EXPECT_TRUE(contains(scene.import_report, {"hinge", "drone", "camera"}));
}

TEST_F(SceneFile, MayNameAUrdfByItsWholePath) {
  const std::string urdf = write("bodies/brick.urdf", kUrdf);
  EXPECT_EQ(readSceneFile(write("s.yaml", "urdf: [" + urdf + "]")).bodies.size(), 1u);
}

TEST_F(SceneFile, RefusesMassForABodyThatAUrdfGives) {
  write("bodies/brick.urdf", kUrdf);
  const std::string path =
      write("s.yaml", "{urdf: [bodies/brick.urdf], bodies: {brick: {mass: 1}}}");
  EXPECT_TRUE(
      contains(refusal([&] { readSceneFile(path); }), {path, "bodies.brick.mass", "unknown"}));
}

TEST_F(SceneFile, IsNamedInEveryError) {
  for (const char* text :
       {"", "a: [", "{bodies: {b: {point_mass: 0}}}",
        "{bodies: {b: {point_mass: 1}}, unknown_thing: 1}", "urdf: [none.urdf]"}) {
    const std::string path = write("s.yaml", text);
    EXPECT_EQ(refusal([&] { readSceneFile(path); }).rfind(folder_.string(), 0), 0u) << text;
  }
  EXPECT_TRUE(contains(refusal([] { readSceneFile("/no/scene.yaml"); }), {"/no/scene.yaml"}));
}

TEST(SceneUrdfParameter, IsReadThroughTheFunctionThatIsGiven) {
  SceneSources sources;
  sources.urdf_parameter = [](const std::string& name) {
    EXPECT_EQ(name, "robot_description");
    return std::string(kUrdf);
  };
  const Parameters parameters(readYaml("urdf_parameter: robot_description", "t"), "");
  const Scene scene = readScene(parameters, sources);
  ASSERT_EQ(scene.bodies.size(), 1u);
  EXPECT_EQ(scene.bodies[0].name, "brick");
}

}  // namespace
}  // namespace rigid_body_sim

// The keys of a scene that say how it is stepped: by a method, or as accurately as wanted.
#include "generic.hpp"

namespace rigid_body_sim {
namespace {

TEST(SceneMethod, TakesSubstepsAndTheToleranceOfTheAdaptiveMethod) {
  const std::string bodies = ", bodies: {b: {point_mass: 1}}}";
  EXPECT_EQ(sceneFrom("{substeps: 1" + bodies).substeps, 1);
  EXPECT_EQ(sceneFrom("{integrator: rk4, substeps: 10000" + bodies).substeps, 10'000);
  EXPECT_EQ(sceneFrom("{integrator: adaptive, tolerance: 1.0e-9" + bodies).tolerance, 1e-9);
  for (const char* bad : {"0", "-1", "10001", "2.0", "2.5", "two", "true", "[2]"})
    EXPECT_TRUE(contains(refusal([&] { sceneFrom("{substeps: " + std::string(bad) + bodies); }),
                         {"substeps: ", "whole number from 1 to 10000"}))
        << bad;
  for (const char* bad : {"0", "1.0e-16", "0.1", ".nan", "tight"})
    EXPECT_TRUE(contains(refusal([&] {
                           sceneFrom("{integrator: adaptive, tolerance: " + std::string(bad) +
                                     bodies);
                         }),
                         {"tolerance: "}))
        << bad;
  EXPECT_TRUE(contains(refusal([&] { sceneFrom("{integrator: rk8, tolerance: 1.0e-9" + bodies); }),
                       {"tolerance: ", "'rk8'", "adaptive"}));
  EXPECT_TRUE(contains(summary(sceneFrom("{integrator: rk4, substeps: 3" + bodies)),
                       {"integrator: rk4 x 3, step 0.02 s"}));
}

TEST(SceneMethod, TakesAnAccuracyInsteadOfAMethod) {
  const std::string bodies = ", bodies: {b: {point_mass: 1}}}";
  const Scene scene = sceneFrom(
      "{accuracy: {attitude_rad: 1.0e-6, position_m: 0.5, over_s: 60, replan: true}" + bodies);
  ASSERT_TRUE(scene.accuracy);
  EXPECT_EQ(scene.accuracy->attitude_rad, 1e-6);
  EXPECT_EQ(scene.accuracy->position_m, 0.5);
  EXPECT_EQ(scene.accuracy->over_s, 60);
  EXPECT_TRUE(scene.accuracy->replan);
  const Scene one = sceneFrom("{accuracy: {position_m: 2, over_s: 0.5}" + bodies);
  EXPECT_EQ(one.accuracy->attitude_rad, kInf);
  EXPECT_FALSE(one.accuracy->replan);
  EXPECT_FALSE(sceneFrom("{substeps: 1" + bodies).accuracy);
  EXPECT_TRUE(contains(summary(scene), {"what keeps 1e-06 rad and 0.5 m over 60 s"}));
  const Scene turning = sceneFrom(
      "{accuracy: {attitude_rad: 1.0e-6, over_s: 0.5}, bodies: {b: {mass: 1, inertia: [1, 2, 2.5], "
      "angular_velocity: [1, 2, 3]}}}");
  EXPECT_TRUE(contains(summary(Simulator(turning).scene()),
                       {"integrators: exact (1 body) to keep 1e-06 rad over 0.5 s"}));
}

TEST(SceneMethod, RefusesAnAccuracyThatIsIncompleteOrNotAlone) {
  const std::string bodies = ", bodies: {b: {point_mass: 1}}}";
  const std::string whole = "{accuracy: {attitude_rad: 1.0e-6, over_s: 60}, ";
  struct Row {
    std::string scene;
    std::vector<std::string> says;
  };
  for (const Row& row : std::vector<Row>{
           {"{accuracy: {over_s: 60}", {"accuracy: ", "attitude_rad, position_m or both"}},
           {"{accuracy: {attitude_rad: 1.0e-6}", {"accuracy.over_s: ", "missing"}},
           {"{accuracy: {attitude_rad: 0, over_s: 60}", {"accuracy.attitude_rad: 0", "rad"}},
           {"{accuracy: {position_m: -1, over_s: 60}", {"accuracy.position_m: -1", "m"}},
           {"{accuracy: {position_m: 1, over_s: 0}", {"accuracy.over_s: 0", "s"}},
           {"{accuracy: {position_m: 1, over_s: 60, replan: 1}", {"accuracy.replan: 1"}},
           {"{accuracy: {position_m: 1, over: 60, over_s: 1}", {"accuracy.over: ", "'over_s'"}},
           {"{accuracy: 1.0e-6", {"accuracy: ", "map"}},
           {whole + "integrator: exact", {"integrator: ", "`accuracy` chooses"}},
           {whole + "substeps: 2", {"substeps: ", "`accuracy` chooses"}},
           {whole + "tolerance: 1.0e-9", {"tolerance: ", "`accuracy` chooses"}}})
    EXPECT_TRUE(contains(refusal([&] { sceneFrom(row.scene + bodies); }), row.says)) << row.scene;
}

}  // namespace
}  // namespace rigid_body_sim

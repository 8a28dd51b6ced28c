// What scene files may say of drag.
#include "generic.hpp"

namespace rigid_body_sim {
namespace {

std::string with(const std::string& drag, const std::string& body = "point_mass: 1") {
  return "{effects: {drag: " + drag + "}, bodies: {b: {" + body + "}}}";
}

TEST(DragInScenes, ActsOnBodiesWithAnAreaOnly) {
  const Scene scene = sceneFrom(
      "{effects: {drag: {air_density: 1.2}}, bodies: {a: {point_mass: 1}, b: {point_mass: 1, drag: "
      "{drag_area: 0.3}}, c: {sphere: {radius: 1, density: 1}, drag: {rotational_drag: 0.1}}}}");
  ASSERT_EQ(scene.effects.size(), 1u);
  EXPECT_EQ(scene.effects[0]->name(), "drag");
  EXPECT_EQ(scene.effects[0]->bodyCount(), 2u);
  EXPECT_TRUE(contains(summary(scene), {"drag (2 bodies)"}));
}

TEST(DragInScenes, TakesABodysOwnAreaBeforeTheScenes) {
  const Scene scene = sceneFrom(
      "{effects: {drag: {air_density: 2, drag_area: 0.1}}, bodies: {a: {point_mass: 1, "
      "linear_velocity: [1, 0, 0]}, b: {point_mass: 1, linear_velocity: [1, 0, 0], drag: "
      "{drag_area: 0.3}}}}");
  const Wrenches wrenches = Simulator(scene).effectWrenches().at(0).wrenches;
  EXPECT_NEAR(wrenches.f_W(0, 0), -0.1, 1e-16);
  EXPECT_NEAR(wrenches.f_W(1, 0), -0.3, 1e-16);
}

TEST(DragInScenes, IsNotMadeWhereItDoesNothing) {
  const auto why = [](const std::string& text) {
    const Scene scene = sceneFrom(text);
    EXPECT_TRUE(scene.effects.empty());
    return scene.elided.empty() ? "" : scene.elided[0];
  };
  EXPECT_EQ(why(with("{air_density: 0, drag_area: 1}")), "drag: the air_density is zero");
  EXPECT_EQ(why(with("{air_density: 0, drag_area: 1, wind: {velocity: [1, 0, 0], shear: "
                     "{reference_height: 10, exponent: 0.1}}}")),
            "drag: the air_density is zero");
  EXPECT_EQ(why(with("{air_density: 1.2}")), "drag: no body has a drag_area or a rotational_drag");
  EXPECT_EQ(why(with("{atmosphere: us_standard_1976, drag_area: 0}")),
            "drag: no body has a drag_area or a rotational_drag");
  EXPECT_EQ(why(with("{air_density: 1.2, drag_area: 1}", "point_mass: 1, drag: false")),
            "drag: it acts on no body");
}

TEST(DragInScenes, OfSpinIsNotForPointMasses) {
  const Scene scene = sceneFrom(with("{air_density: 1.2, rotational_drag: 0.5}"));
  EXPECT_TRUE(scene.effects.empty());
  EXPECT_TRUE(contains(refusal([] {
                         sceneFrom(with("{air_density: 1.2}",
                                        "point_mass: 1, drag: {rotational_drag: 0.5}"));
                       }),
                       {"bodies.b.drag.rotational_drag: a point mass does not turn"}));
  EXPECT_NO_THROW(
      sceneFrom(with("{air_density: 1.2}", "point_mass: 1, drag: {rotational_drag: 0}")));
}

TEST(DragInScenes, RefusesWhatIsNotAllowedAndSaysWhere) {
  const std::vector<std::pair<std::string, std::vector<std::string>>> cases = {
      {with("{drag_area: 1}"),
       {"effects.drag.air_density: is missing", "[kg/m^3]", "us_standard_1976"}},
      {with("{air_density: -1, drag_area: 1}"), {"effects.drag.air_density: -1 ", "[kg/m^3]"}},
      {with("{air_density: .inf, drag_area: 1}"), {"effects.drag.air_density: inf ", "[kg/m^3]"}},
      {with("{air_density: 1, atmosphere: us_standard_1976}"),
       {"effects.drag.air_density: ", "`atmosphere`"}},
      {with("{atmosphere: us_standard_1967}"),
       {"effects.drag.atmosphere: 'us_standard_1967' is not known", "us_standard_1976"}},
      {with("{atmosphere: 1976}"), {"effects.drag.atmosphere: 1976 is not"}},
      {with("{air_density: 1, drag_area: -0.5}"), {"effects.drag.drag_area: -0.5 ", "[m^2]"}},
      {with("{air_density: 1, rotational_drag: x}"),
       {"effects.drag.rotational_drag: 'x'", "[m^5]"}},
      {with("{air_density: 1}", "point_mass: 1, drag: {drag_area: -2}"),
       {"bodies.b.drag.drag_area: -2 ", "[m^2]"}},
      {with("{air_density: 1}", "point_mass: 1, drag: {area: 2}"),
       {"bodies.b.drag.area: unknown key"}},
      {with("{air_density: 1, cd: 2}"), {"effects.drag.cd: unknown key"}},
      {with("{air_density: 1, wind: [1, 2]}"), {"effects.drag.wind: [1, 2]", "[m/s]"}},
      {with("{air_density: 1, sea_level: {center: [0, 0, 0], radius: 1}}"),
       {"effects.drag.sea_level: ", "depends on altitude"}},
      {with("{atmosphere: us_standard_1976, sea_level: {center: [0, 0, 0], radius: 0}}"),
       {"effects.drag.sea_level.radius: 0 ", "> 0 [m]"}},
      {with("{atmosphere: us_standard_1976, sea_level: {radius: 5}}"),
       {"effects.drag.sea_level.center: is missing", "[m]"}},
      {with("{atmosphere: us_standard_1976, sea_level: {center: [0, 0, 0], radius: 5, r: 1}}"),
       {"effects.drag.sea_level.r: unknown key"}},
      {"{bodies: {b: {point_mass: 1, drag: {drag_area: 1}}}}",
       {"bodies.b.drag: ", "list it under `effects`"}}};
  for (const auto& [yaml, parts] : cases)
    EXPECT_TRUE(contains(refusal([&, text = yaml] { sceneFrom(text); }), parts)) << yaml;
}

}  // namespace
}  // namespace rigid_body_sim

#include "rigid_body_sim/parameters.hpp"

#include <cmath>

#include "generic.hpp"

namespace rigid_body_sim {
namespace {

Parameters parametersOf(const std::string& yaml) { return {readYaml(yaml, "test.yaml"), ""}; }

/// What `get` says to the parameters in `yaml`.
template <class Get>
std::string said(const std::string& yaml, const Get& get) {
  return refusal([&] { get(parametersOf(yaml)); });
}

const Allowed kStep = {1e-6, 1, "s"};

TEST(Number, IsAnIntegerOrAFloat) {
  const Parameters parameters = parametersOf("{a: 3, b: 2.5, c: -1.5e-3}");
  EXPECT_EQ(parameters.number("a", finite("m")), 3);
  EXPECT_EQ(parameters.number("b", finite("m")), 2.5);
  EXPECT_EQ(parameters.number("c", finite("m")), -1.5e-3);
}

TEST(Number, OfAnotherTypeIsRefusedWithPathValueRangeAndUnit) {
  const auto get = [](const Parameters& p) { p.number("step_s", kStep); };
  EXPECT_EQ(said("step_s: true", get), "step_s: true is not a number from 1e-06 to 1 [s]");
  EXPECT_EQ(said("step_s: [0.1]", get), "step_s: [0.1] is not a number from 1e-06 to 1 [s]");
  EXPECT_EQ(said("step_s: {a: 1}", get), "step_s: {a: 1} is not a number from 1e-06 to 1 [s]");
  EXPECT_EQ(said("step_s: fast", get), "step_s: 'fast' is not a number from 1e-06 to 1 [s]");
  EXPECT_EQ(said("step_s:", get), "step_s: nothing is not a number from 1e-06 to 1 [s]");
}

TEST(Number, OutOfRangeIsRefusedWithPathValueRangeAndUnit) {
  const auto get = [](const Parameters& p) { p.number("step_s", kStep); };
  for (const char* value : {"0", "1.5", "-0.02", ".inf", "-.inf", ".nan"})
    EXPECT_TRUE(contains(said(std::string("step_s: ") + value, get),
                         {"step_s: ", " is not a number from 1e-06 to 1 [s]"}));
  EXPECT_EQ(parametersOf("step_s: 1").number("step_s", kStep), 1);  // the ends are in
  EXPECT_EQ(parametersOf("step_s: 1.0e-6").number("step_s", kStep), 1e-6);
}

TEST(Number, MayHaveToBePositiveOrNotNegativeOrFinite) {
  EXPECT_EQ(said("m: 0", [](const Parameters& p) { p.number("m", positive("kg")); }),
            "m: 0 is not a finite number > 0 [kg]");
  EXPECT_EQ(said("m: -1", [](const Parameters& p) { p.number("m", notNegative("kg")); }),
            "m: -1 is not a finite number >= 0 [kg]");
  EXPECT_EQ(said("m: 1",
                 [](const Parameters& p) {
                   p.number("m", {-kInf, 0, "kg"});
                 }),
            "m: 1 is not a finite number <= 0 [kg]");
  EXPECT_EQ(parametersOf("m: 0").number("m", notNegative("kg")), 0);
  EXPECT_EQ(said("m: .inf", [](const Parameters& p) { p.number("m", finite("kg")); }),
            "m: inf is not a finite number [kg]");
}

TEST(Number, InAStringComesWithTheHintHowToWriteIt) {
  const auto get = [](const Parameters& p) { p.number("a", finite("m")); };
  EXPECT_TRUE(contains(said("a: 1e-6", get), {"'1e-6'", "to YAML", "write 1.0e-6"}));
  EXPECT_TRUE(contains(said("a: 1e6", get), {"write 1.0e+6"}));
  EXPECT_TRUE(contains(said("a: 1.5e6", get), {"write 1.5e+6"}));
  EXPECT_TRUE(contains(said("a: -.5", get), {"write -0.5"}));
  EXPECT_TRUE(contains(said("a: '0.5'", get), {"leave the quotes out"}));
  EXPECT_TRUE(contains(said("a: '1.0e-6'", get), {"leave the quotes out"}));
  for (const char* no_number : {"a: fast", "a: '1,5'", "a: ''", "a: nan", "a: 0x10"})
    EXPECT_EQ(said(no_number, get).find(';'), std::string::npos) << no_number;
}

TEST(Number, ThatTheHintWritesIsOne) {
  for (const char* wanted : {"1.0e-6", "1.0e+6", "1.5e+6", "-0.5"})
    EXPECT_TRUE(std::isfinite(parametersOf(std::string("a: ") + wanted).number("a", finite("m"))));
}

TEST(Getters, GiveTheDefaultForAnAbsentKeyOnly) {
  const Parameters parameters = parametersOf("{present: 1}");
  EXPECT_EQ(parameters.number("absent", finite("m"), 7.0), 7);
  EXPECT_EQ(parameters.number("present", finite("m"), 7.0), 1);
  EXPECT_EQ(parameters.boolean("absent", true), true);
  EXPECT_EQ(parameters.text("absent", "x"), "x");
  EXPECT_EQ(parameters.vector3("absent", finite("m"), Vector3d(1, 2, 3)), Vector3d(1, 2, 3));
  EXPECT_TRUE(parameters.texts("absent").empty());
}

TEST(Getters, WithoutDefaultRequireTheKey) {
  EXPECT_EQ(said("", [](const Parameters& p) { p.number("mass", positive("kg")); }),
            "mass: is missing; it must be a finite number > 0 [kg]");
  EXPECT_TRUE(contains(said("", [](const Parameters& p) { p.boolean("b"); }), {"b: is missing"}));
  EXPECT_TRUE(contains(said("", [](const Parameters& p) { p.text("t"); }), {"t: is missing"}));
  EXPECT_EQ(said("", [](const Parameters& p) { p.vector3("v", finite("m")); }),
            "v: is missing; it must be a list of 3 numbers [m]");
  EXPECT_TRUE(contains(said("", [](const Parameters& p) { p.children("list"); }),
                       {"list", "not a list of maps"}));
}

TEST(Getters, NameWhatIsThereInsteadOfAMissingKey) {
  const auto mass = [](const Parameters& p) { p.number("mass", positive("kg")); };
  const std::string missing = "mass: is missing; it must be a finite number > 0 [kg]; ";
  EXPECT_EQ(said("{mas: 1, com: 2}", mass), missing + "there is 'mas' instead");
  EXPECT_EQ(said("{weight: 1, g: 2}", mass), missing + "there are 'g', 'weight' instead");
  EXPECT_EQ(said("{weight: 1, com: 2}",
                 [&](const Parameters& p) {
                   p.has("com");
                   mass(p);
                 }),
            missing + "there is 'weight' instead");
  EXPECT_EQ(said("{u: 1, v: 2, w: 3, x: 4, y: 5, z: 6}", mass) + "; ", missing);
}

TEST(Boolean, IsTrueOrFalseAndNothingElse) {
  EXPECT_TRUE(parametersOf("b: yes").boolean("b"));
  for (const char* value : {"1", "0.0", "'true'", "maybe", "[true]"})
    EXPECT_TRUE(contains(
        said(std::string("b: ") + value, [](const Parameters& p) { p.boolean("b", true); }),
        {"b: ", "is not true or false"}));
}

TEST(Text, IsAStringThatIsNotEmpty) {
  EXPECT_EQ(parametersOf("t: split2").text("t"), "split2");
  EXPECT_EQ(parametersOf("t: '5'").text("t"), "5");
  for (const char* value : {"5", "true", "''", "[a]", "{a: b}", "~"})
    EXPECT_TRUE(
        contains(said(std::string("t: ") + value, [](const Parameters& p) { p.text("t", "x"); }),
                 {"t: ", "is not a (non-empty) string"}));
}

TEST(Texts, AreAListOfStrings) {
  EXPECT_EQ(parametersOf("t: [a, b]").texts("t"), (std::vector<std::string>{"a", "b"}));
  EXPECT_TRUE(contains(said("t: a", [](const Parameters& p) { p.texts("t"); }),
                       {"'a' is not a list of strings"}));
  EXPECT_TRUE(contains(said("t: [a, 5]", [](const Parameters& p) { p.texts("t"); }),
                       {"5 in the list is not a string"}));
}

TEST(Numbers, AreAsManyAsAsked) {
  const auto get = [](const Parameters& p) { return p.numbers("i", {3, 6}, finite("kg m^2")); };
  EXPECT_EQ(get(parametersOf("i: [1, 2.5, 3]")), (std::vector<double>{1, 2.5, 3}));
  EXPECT_EQ(get(parametersOf("i: [1, 2, 3, 4, 5, 6]")).size(), 6u);
  for (const char* value : {"[1, 2]", "[]", "[1, 2, 3, 4]", "5", "{a: 1}"})
    EXPECT_TRUE(contains(said(std::string("i: ") + value, get),
                         {"i: ", "is not a list of 3 or 6 numbers [kg m^2]"}));
}

TEST(Numbers, NameTheElementThatIsWrong) {
  const auto get = [](const Parameters& p) { p.vector3("size", positive("m")); };
  EXPECT_EQ(said("size: [1, 0, 3]", get), "size[1]: 0 is not a finite number > 0 [m]");
  EXPECT_TRUE(contains(said("size: [1, 2, 3e-2]", get), {"size[2]", "write 3.0e-2"}));
  EXPECT_TRUE(contains(said("size: [1, [2], 3]", get), {"size[1]: [2] is not"}));
}

TEST(Children, CarryTheirPathIntoMessages) {
  const Parameters top = parametersOf("bodies: {ball: {mass: -1}}");
  const Parameters ball = top.child("bodies").child("ball");
  EXPECT_TRUE(
      contains(refusal([&] { ball.number("mass", positive("kg")); }), {"bodies.ball.mass: -1"}));
  const Parameters list = parametersOf("b: {particles: [{mass: 1}, {mass: no}]}").child("b");
  const std::vector<Parameters> particles = list.children("particles");
  ASSERT_EQ(particles.size(), 2u);
  EXPECT_EQ(particles[0].number("mass", positive("kg")), 1);
  EXPECT_TRUE(contains(refusal([&] { particles[1].number("mass", positive("kg")); }),
                       {"b.particles[1].mass: false"}));
}

TEST(Children, AreMaps) {
  EXPECT_EQ(said("bodies: 5", [](const Parameters& p) { p.child("bodies"); }),
            "bodies: 5 is not a map of keys");
  EXPECT_EQ(said("l: [{}, 5]", [](const Parameters& p) { p.children("l"); }),
            "l[1]: 5 is not a map of keys");
  EXPECT_TRUE(contains(said("l: {a: 1}", [](const Parameters& p) { p.children("l"); }),
                       {"is not a list of maps"}));
  EXPECT_EQ(refusal([] { parametersOf("[1, 2]"); }), "parameters: [1, 2] is not a map of keys");
  EXPECT_TRUE(parametersOf("{}").child("absent").keys().empty());
  EXPECT_TRUE(parametersOf("").keys().empty());
}

TEST(Keys, AreThereOrNotAndSorted) {
  const Parameters parameters = parametersOf("{b: 1, a: {c: 2}}");
  EXPECT_FALSE(parameters.isBoolean("b"));
  EXPECT_FALSE(parameters.isBoolean("c"));
  EXPECT_TRUE(parametersOf("b: no").isBoolean("b"));
  EXPECT_EQ(parameters.keys(), (std::vector<std::string>{"a", "b"}));
  EXPECT_TRUE(parameters.has("a"));
  EXPECT_FALSE(parameters.has("c"));
  EXPECT_TRUE(parameters.isMap("a"));
  EXPECT_FALSE(parameters.isMap("b"));
  EXPECT_FALSE(parameters.isMap("c"));
}

TEST(RefuseUnknown, AcceptsKeysThatWereAskedFor) {
  const Parameters parameters = parametersOf("{a: 1, b: x, c: [1]}");
  parameters.number("a", finite("m"));
  parameters.has("b");
  parameters.ignore("c");
  EXPECT_NO_THROW(parameters.refuseUnknown());
}

TEST(RefuseUnknown, NamesTheNearestKeyThatWasAskedFor) {
  const Parameters block = parametersOf("bodies: {ball: {positoin: [0, 0, 0]}}");
  const Parameters ball = block.child("bodies").child("ball");
  ball.vector3("position", finite("m"), Vector3d::Zero());
  ball.number("mass", positive("kg"), 1.0);
  EXPECT_EQ(refusal([&] { ball.refuseUnknown(); }),
            "bodies.ball.positoin: unknown key; did you mean 'position'?");
}

TEST(RefuseUnknown, NamesAllKeysIfNoneIsNear) {
  const Parameters parameters = parametersOf("xyzzy_plugh: 1");
  parameters.number("mass", positive("kg"), 1.0);
  parameters.text("integrator", "split2");
  EXPECT_EQ(refusal([&] { parameters.refuseUnknown(); }),
            "xyzzy_plugh: unknown key; there are integrator, mass");
}

TEST(NearestWord, IsTheOneWithTheFewestEdits) {
  EXPECT_EQ(nearestWord("gravty", {"gravity", "gyroscopic"}), "gravity");
  EXPECT_EQ(nearestWord("girocsopic", {"gravity", "gyroscopic"}), "gyroscopic");
  EXPECT_EQ(nearestWord("", {"gravity"}), "");
  EXPECT_EQ(nearestWord("q", {"gravity"}), "");
}

TEST(ToText, IsOneShortLine) {
  EXPECT_EQ(toText(readYaml("{a: [1, 2.5, x], b: true, c: ~}", "t")),
            "{a: [1, 2.5, 'x'], b: true, c: nothing}");
  const std::string text = toText(Value{std::string(1000, 'x') + "\n"});
  EXPECT_EQ(text.size(), 60u);
  EXPECT_EQ(toText(Value{std::string("two\nlines\x1b")}), "'two lines '");
}

TEST(ReadYaml, GivesScalarsTheTypesOfPyYaml) {
  // Read by PyYAML 6.0, which is what rosparam uses.
  const std::vector<std::pair<const char*, Value>> rows = {
      {"yes", {true}},
      {"On", {true}},
      {"TRUE", {true}},
      {"off", {false}},
      {"No", {false}},
      {"y", {std::string("y")}},
      {"tRue", {std::string("tRue")}},
      {"0", {std::int64_t{0}}},
      {"-3", {std::int64_t{-3}}},
      {"+3", {std::int64_t{3}}},
      {"5.", {5.0}},
      {".5", {0.5}},
      {"-0.0", {-0.0}},
      {"1.5", {1.5}},
      {"1.0e+6", {1e6}},
      {"1.0E+6", {1e6}},
      {"1.e+5", {1e5}},
      {".5e+3", {500.0}},
      {"-1.5e-3", {-1.5e-3}},
      {".inf", {kInf}},
      {"-.INF", {-kInf}},
      {"+.inf", {kInf}},
      {"1e-6", {std::string("1e-6")}},
      {"1e5", {std::string("1e5")}},
      {"1.0e6", {std::string("1.0e6")}},
      {"-.5", {std::string("-.5")}},
      {"+.5", {std::string("+.5")}},
      {"08", {std::string("08")}},
      {"-.nan", {std::string("-.nan")}},
      {"'5'", {std::string("5")}},
      {"\"true\"", {std::string("true")}},
      {"~", {}},
      {"null", {}},
      {"Null", {}},
  };
  for (const auto& [text, expected] : rows) {
    const Value value = readYaml(text, "t");
    EXPECT_EQ(value.data.index(), expected.data.index()) << text;
    EXPECT_EQ(toText(value), toText(expected)) << text;
  }
  EXPECT_TRUE(std::isnan(std::get<double>(readYaml(".nan", "t").data)));
}

TEST(ReadYaml, LeavesNumbersWithASecondMeaningStrings) {
  // Octal, hexadecimal, base 60, underscores, beyond 64 bits.
  for (const char* text : {"010", "0x10", "1:30", "1_000", "99999999999999999999"})
    EXPECT_TRUE(std::holds_alternative<std::string>(readYaml(text, "t").data)) << text;
}

TEST(ReadYaml, RefusesAKeyThatStandsTwice) {
  EXPECT_TRUE(contains(refusal([] { readYaml("a: 1\nb: {c: 1, c: 2}", "scene.yaml"); }),
                       {"scene.yaml", "key 'c' stands twice"}));
}

TEST(ReadYaml, NamesSourceAndLineOfAnError) {
  EXPECT_TRUE(
      contains(refusal([] { readYaml("a: 1\nb: [1, 2\nc: 3", "scene.yaml"); }), {"scene.yaml:"}));
  EXPECT_TRUE(
      contains(refusal([] { readYaml("a: 1\nb: @\n", "scene.yaml"); }), {"scene.yaml:2: "}));
}

TEST(ReadYaml, RefusesBottomlessNesting) {
  EXPECT_TRUE(contains(refusal([] { readYaml(std::string(40, '[') + std::string(40, ']'), "t"); }),
                       {"t: nested more than 32 levels deep"}));
}

TEST(ReadTextFile, NamesAFileThatCannotBeRead) {
  EXPECT_EQ(refusal([] { readTextFile("/no/such/file.yaml"); }),
            "/no/such/file.yaml: cannot be read");
}

}  // namespace
}  // namespace rigid_body_sim

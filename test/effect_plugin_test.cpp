// Names that lead to no plug-in. Plug-ins that are there: test/effect_package_test.py.
#include "core/effect_plugin.hpp"

#include "generic.hpp"

namespace rigid_body_sim {
namespace {

const std::vector<std::string> kNoNames = {"",
                                           ".",
                                           "..",
                                           "a/b",
                                           "/a",
                                           "../a",
                                           "a.so",
                                           "a b",
                                           "A",
                                           "ä",
                                           "a-b",
                                           "$ORIGIN",
                                           "a\n",
                                           std::string("a\0", 2),
                                           std::string("\0a", 2),
                                           std::string(65, 'a')};

std::string refusalOf(const std::string& effect) {
  const Value nothing{Value::Map{}};
  const Value body{Value::Map{{"point_mass", Value{1.0}}}};
  const Value scene{Value::Map{{"effects", Value{Value::Map{{effect, nothing}}}},
                               {"bodies", Value{Value::Map{{"ball", body}}}}}};
  try {
    readScene(Parameters(scene, ""), {});
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return {};
}

TEST(EffectPlugin, IsLookedForUnderItsNameOnly) {
  EXPECT_EQ(effectPluginLibrary("rate_damping2"), "librigid_body_sim_effect_rate_damping2.so");
  EXPECT_EQ(effectPluginLibrary(std::string(64, 'a')).size(),
            64 + sizeof("librigid_body_sim_effect_.so") - 1);
}

TEST(EffectPlugin, IsNotLookedForUnderANameThatCouldBeAPath) {
  for (const std::string& name : kNoNames) {
    EXPECT_EQ(effectPluginLibrary(name), "") << name;
    EXPECT_EQ(effectPlugin(name), nullptr) << name;
  }
}

TEST(EffectPlugin, NamesThatNoneCanHaveAreUnknownKeysOfAScene) {
  for (const std::string& name : kNoNames) {
    EXPECT_TRUE(contains(refusalOf(name), {"effects.", ": unknown key; "})) << name;
  }
  EXPECT_TRUE(contains(refusalOf("../a"), {"effects.../a: unknown key; "}));
  EXPECT_TRUE(contains(refusalOf({"a\0", 2}), {"effects.a\\x00: unknown key; "}));
  EXPECT_TRUE(contains(refusalOf("gravity\n"), {"effects.gravity\\x0a: unknown key; "}));
}

TEST(EffectPlugin, CannotHaveTheNameOfTheInputs) {
  EXPECT_TRUE(contains(refusalOf("applied"), {"effects.applied", "wrenches from topics"}));
}

TEST(EffectPlugin, ThatIsNotThereIsNull) { EXPECT_EQ(effectPlugin("not_there"), nullptr); }

TEST(EffectPlugin, ThatIsNotThereIsRefusedWithTheNameOfItsLibrary) {
  EXPECT_EQ(refusalOf("not_there"),
            "effects.not_there: unknown key; there is no built-in effect of this name, and no "
            "library librigid_body_sim_effect_not_there.so on the dynamic linker's path "
            "(LD_LIBRARY_PATH)");
}

TEST(EffectPlugin, ThatIsNotThereMayBeASlipOfTheKeyboard) {
  const std::string start = "effects.gravty: unknown key; did you mean 'gravity'? Otherwise: there";
  EXPECT_EQ(refusalOf("gravty").substr(0, start.size()), start);
}

}  // namespace
}  // namespace rigid_body_sim

// The files that a user copies from: they load, and they name everything that there is.

#include <dirent.h>

#include <algorithm>
#include <regex>

#include "effects/registry.hpp"
#include "generic.hpp"
#include "node/names.hpp"
#include "node/options.hpp"

namespace rigid_body_sim {
namespace {

const std::string kPackage = PACKAGE_DIR "/";

/// The files of a folder that end so, sorted; at least one.
std::vector<std::string> filesIn(const std::string& folder, const std::string& ending) {
  std::vector<std::string> files;
  DIR* directory = opendir((kPackage + folder).c_str());
  if (!directory) throw std::runtime_error("no folder " + folder);
  while (const dirent* entry = readdir(directory)) {
    const std::string name = entry->d_name;
    if (name.size() > ending.size() && name.substr(name.size() - ending.size()) == ending)
      files.push_back(folder + "/" + name);
  }
  closedir(directory);
  std::sort(files.begin(), files.end());
  if (files.empty()) throw std::runtime_error("nothing in " + folder + " ends in " + ending);
  return files;
}

std::vector<std::string> matchesOf(const std::string& pattern, const std::string& text) {
  const std::regex regex(pattern);
  std::vector<std::string> matches;
  for (std::sregex_iterator match(text.begin(), text.end(), regex), end; match != end; ++match)
    matches.push_back(match->str(match->size() > 1 ? 1 : 0));
  return matches;
}

bool hasWord(const std::string& text, const std::string& word) {
  return std::regex_search(text, std::regex("(^|[^A-Za-z0-9_])" + word + "($|[^A-Za-z0-9_])"));
}

std::string readme() { return readTextFile(kPackage + "README.md"); }
std::string defaults() { return readTextFile(kPackage + "config/default.yaml"); }

/// The first cells of the rows of all tables in README.md, without backticks.
std::string firstCells() {
  std::string cells;
  for (const std::string& cell : matchesOf("\\n\\|([^|]*)\\|", readme())) cells += cell + "\n";
  cells.erase(std::remove(cells.begin(), cells.end(), '`'), cells.end());
  return cells;
}

// ---- Scenes and bodies

TEST(SceneFiles, AllLoad) {
  for (const std::string& file : filesIn("config", ".yaml")) {
    if (file == "config/default.yaml") continue;
    SCOPED_TRACE(file);
    EXPECT_NO_THROW(Simulator(readSceneFile(kPackage + file)));
  }
}

TEST(SceneFiles, GiveNoWarnings) {
  for (const std::string& file : filesIn("config", ".yaml")) {
    if (file == "config/default.yaml") continue;
    EXPECT_TRUE(readSceneFile(kPackage + file).warnings.empty()) << file;
  }
}

TEST(BodyFiles, AllLoadWithoutAWarning) {
  for (const std::string& file : filesIn("config/bodies", ".urdf")) {
    const UrdfModel model = readUrdfFile(kPackage + file);
    EXPECT_FALSE(model.bodies.empty()) << file;
    EXPECT_TRUE(model.warnings.empty()) << file << ": " << model.warnings.front();
  }
}

// ---- config/default.yaml

TEST(DefaultYaml, LoadsAsTheNodeReadsItsParameters) {
  const Parameters parameters(readYaml(defaults(), "default.yaml"), "");
  const NodeOptions options = readNodeOptions(parameters, false, 0);
  const Scene scene = readScene(parameters, {options.scene_folder, {}});
  EXPECT_NO_THROW(parameters.refuseUnknown());
  EXPECT_NO_THROW(Simulator{scene});
}

TEST(DefaultYaml, HoldsTheDefaultsOfTheNode) {
  // With the clock that start_time_s = 1 belongs to.
  std::string text = defaults();
  text.replace(text.find("publish_clock: false"), 20, "publish_clock: true ");
  const NodeOptions written =
      readNodeOptions(Parameters(readYaml(text, "default.yaml"), ""), false, 0);
  const NodeOptions real =
      readNodeOptions(Parameters(readYaml("publish_clock: true", ""), ""), false, 0);
  EXPECT_EQ(written.scene_folder, real.scene_folder);
  EXPECT_EQ(written.world_frame, real.world_frame);
  EXPECT_EQ(written.publish_link_frames, real.publish_link_frames);
  EXPECT_EQ(written.publish_every.tf, real.publish_every.tf);
  EXPECT_EQ(written.publish_every.states, real.publish_every.states);
  EXPECT_EQ(written.publish_every.effect_wrenches, real.publish_every.effect_wrenches);
  EXPECT_EQ(written.publish_every.twist, real.publish_every.twist);
  EXPECT_EQ(written.publish_every.odom, real.publish_every.odom);
  EXPECT_EQ(written.publish_every.applied_wrench, real.publish_every.applied_wrench);
  EXPECT_EQ(written.body_inputs, real.body_inputs);
  EXPECT_EQ(written.paused, real.paused);
  EXPECT_EQ(written.real_time_factor, real.real_time_factor);
  EXPECT_EQ(written.wrench_timeout_s, real.wrench_timeout_s);
  EXPECT_EQ(written.stale_after_s, real.stale_after_s);
  EXPECT_EQ(written.start_time_ns, real.start_time_ns);
  EXPECT_EQ(written.limits.force, real.limits.force);
  EXPECT_EQ(written.limits.torque, real.limits.torque);
  EXPECT_EQ(written.limits.linear_impulse, real.limits.linear_impulse);
  EXPECT_EQ(written.limits.angular_impulse, real.limits.angular_impulse);
  EXPECT_EQ(written.limits.speed, real.limits.speed);
  EXPECT_EQ(written.limits.angular_speed, real.limits.angular_speed);
}

TEST(DefaultYaml, HoldsTheDefaultsOfTheScene) {
  const Scene written =
      readScene(Parameters(readYaml(defaults(), "default.yaml"), ""), SceneSources());
  const Scene real = readScene(
      Parameters(readYaml("bodies: {example: {mass: 2, inertia: [0.1, 0.2, 0.25]}}", ""), ""),
      SceneSources());
  EXPECT_EQ(written.step_ns, real.step_ns);
  EXPECT_EQ(written.integrator, real.integrator);
  EXPECT_EQ(written.substeps, real.substeps);
  EXPECT_EQ(written.tolerance, real.tolerance);
  EXPECT_EQ(written.accuracy.has_value(), real.accuracy.has_value());
  EXPECT_EQ(written.gyroscopic, real.gyroscopic);
  const SceneBody& body = written.bodies.front();
  EXPECT_EQ(body.X_WL.matrix(), real.bodies.front().X_WL.matrix());
  EXPECT_EQ(body.v_WBcm, real.bodies.front().v_WBcm);
  EXPECT_EQ(body.w_WB_L, real.bodies.front().w_WB_L);
  EXPECT_EQ(body.mass_properties.p_FBcm, real.bodies.front().mass_properties.p_FBcm);
}

// ---- Nothing is left out

void readAll(const Parameters& parameters) {
  readNodeOptions(parameters, true, 0);
  readScene(parameters, {"", [](const std::string&) { return std::string(); }});
  parameters.refuseUnknown();
}

/// The keys that may stand where `yaml` has a question mark: a key like no other is refused there
/// with all that there are.
std::vector<std::string> keysAt(std::string yaml) {
  yaml.replace(yaml.find('?'), 1, "QQQQQQQQQQQQQQQQQQQQ: 1");
  const std::string what = refusal([&] { readAll(Parameters(readYaml(yaml, "test"), "")); });
  const std::string there_are = "unknown key; there are ";
  EXPECT_TRUE(contains(what, {there_are}));
  return matchesOf("[a-z_]+", what.substr(what.find(there_are) + there_are.size()));
}

std::vector<std::string> topLevelKeys() { return keysAt("{bodies: {ball: {point_mass: 1}}, ?}"); }

TEST(DefaultYaml, NamesEveryKeyThatIsRead) {
  std::vector<std::string> keys = topLevelKeys();
  EXPECT_GE(keys.size(), 16u);
  for (const std::string where :
       {"limits: {?}", "publish_every: {?}", "{bodies: {ball: {point_mass: 1}}, effects: {?}}",
        "{bodies: {ball: {point_mass: 1}}, accuracy: {position_m: 1, over_s: 1, ?}}",
        "bodies: {ball: {mass: 1, inertia: [1, 1, 1], ?}}",
        "bodies: {ball: {box: {size: [1, 1, 1], density: 1, ?}}}",
        "bodies: {ball: {sphere: {radius: 1, density: 1, ?}}}",
        "bodies: {ball: {cylinder: {radius: 1, length: 1, density: 1, ?}}}",
        "bodies: {ball: {particles: [{mass: 1, position: [0, 0, 0], ?}]}}"}) {
    const std::vector<std::string> more = keysAt(where);
    keys.insert(keys.end(), more.begin(), more.end());
  }
  for (const std::string& key : keys) EXPECT_TRUE(hasWord(defaults(), key + ":")) << key;
}

TEST(DefaultYaml, NamesEveryIntegratorAndEffect) {
  for (const IntegratorRow& row : integrators()) EXPECT_TRUE(hasWord(defaults(), row.name));
  for (const EffectRow& row : effectRegistry()) EXPECT_TRUE(hasWord(defaults(), row.name + ":"));
}

TEST(Readme, HasEveryParameterInItsTables) {
  for (const std::string& key : topLevelKeys()) EXPECT_TRUE(hasWord(firstCells(), key)) << key;
}

TEST(Readme, NamesEveryIntegratorAndEffect) {
  for (const IntegratorRow& row : integrators())
    EXPECT_TRUE(hasWord(readme(), row.name)) << row.name;
  for (const EffectRow& row : effectRegistry())
    EXPECT_TRUE(hasWord(readme(), row.name)) << row.name;
}

TEST(Readme, HasEveryTopicAndServiceInItsTables) {
  // From the header, so that a new name is not forgotten here.
  const std::string header = readTextFile(kPackage + "src/node/names.hpp");
  const std::vector<std::string> lines = matchesOf("constexpr char k[^\\n]*", header);
  EXPECT_GE(lines.size(), 13u);
  for (const std::string& line : lines) {
    const std::string name = matchesOf("\"([^\"]*)\"", line).at(0);
    std::string cell = name;
    if (line.find("a body's") != std::string::npos) cell = "<body>/" + name;
    if (line.find("private") != std::string::npos) cell = "~" + name;
    EXPECT_TRUE(contains(firstCells(), {" " + cell + " \n"}));
  }
}

// ---- Launch files

TEST(LaunchFiles, DescribeEachOfTheirArguments) {
  for (const std::string& file : filesIn("launch", ".launch")) {
    const std::string text =
        std::regex_replace(readTextFile(kPackage + file), std::regex("<!--[^]*?-->"), "");
    // An argument of the file has a default or none; a `value` is one that is passed on.
    for (const std::string& tag : matchesOf("<arg\\s[^>]*>", text)) {
      if (hasWord(tag, "value")) continue;
      EXPECT_TRUE(std::regex_search(tag, std::regex("\\sdoc=\"[^\"]+\""))) << file << ": " << tag;
    }
  }
}

TEST(LaunchFiles, KeepAnEarlierSceneOfTheSameMasterOut) {
  // Without it the parameters of both scenes are read, and both are simulated.
  const std::string launch = readTextFile(kPackage + "launch/simulate.launch");
  const auto nodes = matchesOf("<node\\s[^>]*rigid_body_sim_node[^>]*>", launch);
  ASSERT_EQ(nodes.size(), 1u);
  EXPECT_TRUE(contains(nodes[0], {"clear_params=\"true\""}));
}
TEST(LaunchFiles, NameOnlyFilesThatAreThere) {
  for (const std::string& file : filesIn("launch", ".launch"))
    for (const std::string& path :
         matchesOf("\\$\\(find rigid_body_sim\\)/([^\"$]*)\"", readTextFile(kPackage + file)))
      EXPECT_NO_THROW(readTextFile(kPackage + path)) << file << ": " << path;
}

TEST(DemoRviz, ShowsTheBodiesThatTheLaunchFileDescribes) {
  const std::string rviz = readTextFile(kPackage + "config/demo.rviz");
  const std::string launch = readTextFile(kPackage + "launch/demo.launch");
  const std::vector<std::string> shown = matchesOf("Robot Description: (\\S+)", rviz);
  EXPECT_GE(shown.size(), 4u);
  for (const std::string& parameter : shown)
    EXPECT_TRUE(contains(launch, {"<param name=\"" + parameter + "\""}));
  for (const SceneBody& body : readSceneFile(kPackage + "config/demo.yaml").bodies)
    EXPECT_TRUE(contains(rviz, {body.name + "/robot_description"}));
}

TEST(DemoRviz, HasTheWorldAsFixedFrame) {
  EXPECT_TRUE(contains(readTextFile(kPackage + "config/demo.rviz"), {"Fixed Frame: world"}));
}

}  // namespace
}  // namespace rigid_body_sim

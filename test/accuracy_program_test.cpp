// accuracy_report and plot_accuracy as their user has them.
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "generic.hpp"
#include "tools/child_process.hpp"

namespace rigid_body_sim {
namespace {

namespace fs = std::filesystem;

const std::string kReport = PROGRAM_DIR "/accuracy_report";
const std::string kPlot = PROGRAM_DIR "/plot_accuracy";

struct Ended {
  int code;
  std::string said;
};

Ended run(const std::vector<std::string>& command, double timeout_s = 60) {
  ChildProcess child(command);
  const int code = child.exitCode(timeout_s);
  return {code, child.said()};
}

/// A folder of its own, gone afterwards.
class AccuracyProgram : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = testing::TempDir() + testing::UnitTest::GetInstance()->current_test_info()->name();
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::string scene(const std::string& yaml) const {
    const std::string path = folder_ + "/my_scene.yaml";
    std::ofstream(path) << yaml;
    return path;
  }

  std::string folder_;
};

/// Of a picture: an empty figure has a handful; the least here, with few lines, has 200.
int coloursOf(const std::string& png) {
  const Ended counted = run({"/usr/bin/convert", png, "-format", "%k", "info:"});
  EXPECT_EQ(counted.code, 0) << counted.said;
  return std::atoi(counted.said.c_str());
}

TEST_F(AccuracyProgram, ReportsACaseAndDrawsIt) {
  const Ended ended = run({kReport, "--case=dzhanibekov", "--over=20", "--substeps=1,4,16",
                           "--integrators=semi_implicit_velocity,split2,exact", "--repeats=1",
                           "--output=" + folder_});
  EXPECT_EQ(ended.code, 0) << ended.said;
  EXPECT_TRUE(contains(ended.said, {"dzhanibekov: one body", "split2", "1e-06 rad: exact, ",
                                    "Numbers: " + folder_}));
  for (const char* name : {"work_precision", "attitude_error", "energy", "side_by_side"}) {
    const std::string png = folder_ + "/" + name + ".png";
    EXPECT_TRUE(contains(ended.said, {"Picture: ", std::string(name) + ".png"}));
    ASSERT_TRUE(fs::exists(png)) << png;
    EXPECT_GT(fs::file_size(png), 15000u) << png;
    EXPECT_GT(coloursOf(png), 100) << png;
  }
}

TEST_F(AccuracyProgram, ReportsAUsersScene) {
  const std::string path = scene(
      "step_s: 0.05\n"
      "effects: {gravity: {acceleration: [0, 0, -9.8]}}\n"
      "bodies:\n"
      "  stone: {box: {size: [0.1, 0.2, 0.3], density: 2000}, angular_velocity: [1, 2, 3]}\n"
      "  drop: {point_mass: 0.1, linear_velocity: [1, 0, 5]}\n");
  const Ended ended = run({kReport, path, "--over=3", "--substeps=1,2", "--repeats=1",
                           "--output=" + folder_ + "/new", "--no-plots"});
  EXPECT_EQ(ended.code, 0) << ended.said;
  EXPECT_TRUE(contains(ended.said, {"my_scene: 2 bodies, a tick of 0.05 s, over 3 s (60 ticks)"}));
  EXPECT_TRUE(fs::exists(folder_ + "/new/methods.csv"));
  EXPECT_FALSE(fs::exists(folder_ + "/new/energy.png"));
}

TEST_F(AccuracyProgram, DrawsPositionsWhereNothingRotates) {
  const std::string path =
      scene("effects: {gravity: {acceleration: [0, 0, -9.8]}}\nbodies: {drop: {point_mass: 1}}\n");
  const Ended ended =
      run({kReport, path, "--over=1", "--substeps=1,2,4", "--repeats=1", "--output=" + folder_});
  EXPECT_EQ(ended.code, 0) << ended.said;
  EXPECT_GT(coloursOf(folder_ + "/position_error.png"), 100);
}

TEST_F(AccuracyProgram, SaysInOneLineWhatIsWrong) {
  struct Wrong {
    std::vector<std::string> arguments;
    std::string says;
  };
  for (const Wrong& wrong :
       {Wrong{{}, "give either a scene file or --case"},
        Wrong{{"--case=boxes"}, "'boxes' is not a case; there are dzhanibekov"},
        Wrong{{"--case=sphere", "--integrators=rk44"}, "'rk44' is not an integrator; there are"},
        Wrong{{"--case=sphere", "--over=0.001"},
              "over 0.001 s: at least a tick, which is 0.02 s (step_s)"},
        Wrong{{"--case=sphere", "--over=1e9", "--output=/dev/null/no"},  // at once
              "/dev/null/no: the folder for the output cannot be written to"},
        Wrong{{"no_such.yaml"}, fs::current_path().string() + "/no_such.yaml: cannot be read"}}) {
    std::vector<std::string> command = {kReport};
    command.insert(command.end(), wrong.arguments.begin(), wrong.arguments.end());
    const Ended ended = run(command);
    EXPECT_EQ(ended.code, 1) << ended.said;
    EXPECT_TRUE(contains(ended.said, {wrong.says}));
    EXPECT_EQ(std::count(ended.said.begin(), ended.said.end(), '\n'), 1) << ended.said;
  }
  EXPECT_NE(run({kReport, "--case=sphere", "--nonsense"}).code, 0);
}

TEST_F(AccuracyProgram, RefusesNumbersOutOfRangeWithTheRange) {
  struct Wrong {
    std::string argument, says;
  };
  for (const Wrong& wrong :
       {Wrong{"--substeps=0", "--substeps: '0' is not a whole number from 1 to 16777216"},
        Wrong{"--substeps=2,x", "'x' is not a whole number"},
        Wrong{"--substeps=1.5", "'1.5' is not a whole number"},
        Wrong{"--over=-1", "--over: '-1' is not a number from 1e-06 to 1000000000 s"},
        Wrong{"--over=nan", "'nan' is not a number"},
        Wrong{"--tolerances=0", "--tolerances: '0' is not a number from 1e-16 to 1\n"},
        Wrong{"--longest=-1", "--longest: '-1' is not a number from 0.001 to 1000000 s"},
        Wrong{"--no-plots", "--no-plots requires --output"}}) {
    const Ended ended = run({kReport, "--case=sphere", wrong.argument});
    EXPECT_NE(ended.code, 0) << wrong.argument;
    EXPECT_TRUE(contains(ended.said, {wrong.says}));
  }
}

TEST_F(AccuracyProgram, DrawsWhatThereIsIfNoMethodFliesToTheEnd) {
  const Ended infinite = run({kReport, "--case=dzhanibekov", "--integrators=semi_implicit_velocity",
                              "--substeps=1", "--repeats=1", "--output=" + folder_});
  EXPECT_EQ(infinite.code, 0) << infinite.said;
  EXPECT_TRUE(contains(infinite.said, {"No work_precision.png: no integrator flew to the end: "
                                       "semi_implicit_velocity (infinite after 53.",
                                       "energy.png"}));
  const std::string path =
      scene("bodies: {top: {box: {size: [1, 2, 3], density: 1}, angular_velocity: [9, 300, 9]}}\n");
  const Ended refused = run({kReport, path, "--over=1", "--integrators=rk4", "--substeps=1",
                             "--repeats=1", "--output=" + folder_});
  EXPECT_EQ(refused.code, 0) << refused.said;
  EXPECT_TRUE(
      contains(refused.said, {"No pictures: no integrator could fly this: rk4 (refused: "}));
  EXPECT_FALSE(fs::exists(folder_ + "/energy.png")) << "the one of the report before";
}

TEST_F(AccuracyProgram, DrawsABodyAtRest) {
  const std::string path = scene("bodies: {block: {box: {size: [1, 2, 3], density: 1}}}\n");
  const Ended ended =
      run({kReport, path, "--over=1", "--substeps=1", "--repeats=1", "--output=" + folder_});
  EXPECT_EQ(ended.code, 0) << ended.said;
  EXPECT_GT(coloursOf(folder_ + "/work_precision.png"), 100);
}

TEST_F(AccuracyProgram, SaysWhichRowIsTheScenesOwn) {
  const std::string body =
      "bodies: {top: {box: {size: [1, 2, 3], density: 1}, angular_velocity: [1, 3, 2]}}\n";
  const std::vector<std::string> options = {"--over=2", "--substeps=1,2", "--repeats=1"};
  const auto report = [&](const std::string& yaml) {
    std::vector<std::string> command = {kReport, scene(yaml + body)};
    command.insert(command.end(), options.begin(), options.end());
    return run(command).said;
  };
  EXPECT_TRUE(contains(report("integrator: split2\nsubsteps: 2\n"),
                       {"The scene's own integrator and substeps: split2 x 2 ("}));
  EXPECT_TRUE(
      contains(report("integrator: split2\nsubsteps: 3\n"), {"split2 x 3 (which is no row"}));
  EXPECT_TRUE(contains(report("accuracy: {attitude_rad: 1.0e-6, over_s: 2}\n"),
                       {"The scene's own accuracy, 1e-06 rad over 2 s, chooses exact ("}));
}

TEST_F(AccuracyProgram, EndsQuietlyWhenInterrupted) {
  const Ended flown = run({kReport, "--case=dzhanibekov", "--over=20", "--substeps=1",
                           "--repeats=1", "--output=" + folder_, "--no-plots"});
  ASSERT_EQ(flown.code, 0) << flown.said;
  ChildProcess plot({kPlot, folder_});
  ASSERT_TRUE(plot.says("work_precision.png", 60));
  plot.signal(SIGINT);
  EXPECT_EQ(plot.exitCode(), 130);
  EXPECT_FALSE(contains(plot.said(), {"Traceback"})) << plot.said();
}

TEST_F(AccuracyProgram, RosrunFindsOneScriptInTheDevelSpace) {
  // It offers every executable of the name, the source's, too.
  const fs::perms source = fs::status(PACKAGE_DIR "/scripts/plot_accuracy").permissions();
  EXPECT_EQ(source & fs::perms::owner_exec, fs::perms::none);
}

TEST_F(AccuracyProgram, ListsTheCasesAndHelps) {
  const Ended list = run({kReport, "--list"});
  EXPECT_EQ(list.code, 0);
  for (const reference::Case& one : reference::cases())
    EXPECT_TRUE(contains(list.said, {one.name + "\n", one.source}));
  EXPECT_TRUE(contains(run({kReport, "--help"}).said, {"--over", "--substeps", "--instructions"}));
}

TEST_F(AccuracyProgram, CountsInstructionsWithValgrind) {
  if (!fs::exists("/usr/bin/valgrind")) GTEST_SKIP() << "no valgrind";
  const Ended ended =
      run({kReport, "--case=tumbling_stone", "--over=1", "--substeps=1,3", "--integrators=split2",
           "--repeats=1", "--instructions", "--no-plots", "--output=" + folder_});
  EXPECT_EQ(ended.code, 0) << ended.said;
  std::ifstream file(folder_ + "/methods.csv");
  std::vector<double> counts;
  for (std::string line; std::getline(file, line);) {
    std::string cell;
    std::istringstream cells(line.substr(line.find("\"\"") + 3));  // after the empty `why`
    for (int i = 0; i < 10; ++i) std::getline(cells, cell, ',');
    if (line.rfind("split2", 0) == 0) counts.push_back(std::stod(cell));
  }
  ASSERT_EQ(counts.size(), 2u);
  EXPECT_GT(counts[0], 200);  // 1048 with gcc 12.2 -O3, half of them around the step
  EXPECT_LT(counts[0], 5000);
  EXPECT_GT(counts[1], 1.5 * counts[0]);
  EXPECT_LT(counts[1], 3 * counts[0]);
}

TEST_F(AccuracyProgram, CountsWhatEachEffectCosts) {
  if (!fs::exists("/usr/bin/valgrind")) GTEST_SKIP() << "no valgrind";
  const std::string path = scene(
      "effects: {gravity: {acceleration: [0, 0, -9.8]}, damping: {linear: 0.1}}\n"
      "bodies:\n"
      "  a: {box: {size: [0.1, 0.2, 0.3], density: 2000}}\n"
      "  b: {box: {size: [0.1, 0.2, 0.3], density: 2000}, damping: false}\n");
  const Ended ended = run({kReport, path, "--over=1", "--substeps=1", "--integrators=exact",
                           "--repeats=1", "--instructions", "--no-plots", "--output=" + folder_});
  EXPECT_EQ(ended.code, 0) << ended.said;
  EXPECT_TRUE(contains(ended.said, {"What the effects cost with exact", "+ gravity alone",
                                    "+ damping alone", "+ all together"}));
  std::map<std::string, std::vector<double>> lines;  // bodies, time, instructions
  std::ifstream file(folder_ + "/effects.csv");
  for (std::string line; std::getline(file, line);) {
    std::istringstream cells(line);
    std::string name, cell;
    std::getline(cells, name, ',');
    while (name != "effect" && std::getline(cells, cell, ','))
      lines[name].push_back(std::stod(cell));
  }
  ASSERT_EQ(lines.size(), 4u);
  for (const auto& [name, numbers] : lines) ASSERT_EQ(numbers.size(), 3u) << name;
  EXPECT_EQ(lines["gravity"][0], 2);
  EXPECT_EQ(lines["damping"][0], 1);
  EXPECT_GT(lines["gravity"][2], 10);
  EXPECT_GT(lines["damping"][2], 10);
  // Together they share what an evaluation costs by itself.
  EXPECT_LT(lines["together"][2], 1.05 * (lines["gravity"][2] + lines["damping"][2]));
}

TEST_F(AccuracyProgram, PlotsOfNothingAreRefused) {
  EXPECT_NE(run({kPlot, folder_}).code, 0);
  EXPECT_NE(run({kPlot}).code, 0);
}

}  // namespace
}  // namespace rigid_body_sim

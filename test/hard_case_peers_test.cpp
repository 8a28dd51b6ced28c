// Other engines beside our rungs in hard_cases. Here they are scripts that do what engines do: they
// answer, end their process, or never come back; with installed ones scripts/compare_hard_cases.
#include <sys/stat.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "generic.hpp"
#include "tools/hard_cases/peers.hpp"

namespace rigid_body_sim::hard_cases {
namespace {

class Engines : public testing::Test {
 protected:
  void SetUp() override { ASSERT_NE(mkdtemp(folder_.data()), nullptr); }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  /// A program that says its `name`, and of a case what `does` does.
  void add(const std::string& name, const std::string& does) const {
    const std::string path = folder_ + "/peer_" + name;
    std::ofstream(path) << "#!/bin/sh\nif [ $1 = names ]; then echo '" << name
                        << "'; echo .; exit; fi\n"
                        << does << '\n';
    ASSERT_EQ(chmod(path.c_str(), 0700), 0);
  }

  std::vector<PeerCell> fly(double longest_s = 60) const {
    return flyPeers({folder_, longest_s}, {"separatrix", "off_centre"},
                    [](const std::string&, double) {});
  }

  std::string folder_ =
      (std::filesystem::temp_directory_path() / "rigid_body_sim_engines_XXXXXX").string();
};

const std::string kLoses =
    "printf 'a word of its own\\nwrong\\t12.5\\t-0.273\\t0.15\\t2\\t2.65\\t0.1\\t1e-9\\t0\\tand "
    "why\\n.\\n'";

TEST_F(Engines, AnswersAreReadAmongAllThatAnEngineSays) {
  add("bullet", kLoses);
  const std::vector<PeerCell> cells = fly();
  ASSERT_EQ(cells.size(), 2u);
  EXPECT_EQ(cells[0].one->name, "separatrix");
  EXPECT_EQ(cells[0].engine, "bullet");
  EXPECT_EQ(cells[0].fate, Fate::kWrong);
  EXPECT_EQ(cells[0].verdict.end_s, 12.5);
  EXPECT_EQ(cells[0].verdict.errors, (std::vector<double>{2.65, 0.1}));
  EXPECT_EQ(cells[0].verdict.bounds, (std::vector<double>{1e-9, 0}));
  EXPECT_EQ(cells[0].verdict.why, "and why");
}

TEST_F(Engines, CellSaysWhatIsLostOrHowFarOffAPlaceIs) {
  add("bullet", kLoses);
  const std::vector<PeerCell> cells = fly();
  EXPECT_EQ(inACell(cells.at(0)), "x E -27%");
  EXPECT_EQ(inACell(cells.at(1)), "x 2.6");  // off_centre is about its position
  PeerCell other = cells.at(0);
  other.verdict.energy_change = 4e6;
  EXPECT_EQ(inACell(other), "x E x4e+06");
  other.verdict.energy_change = 0.1;
  EXPECT_EQ(inACell(other), "x L 15% off");
}

TEST_F(Engines, OneThatEndsItsProcessIsShownAndEndsNothingElse) {
  add("bullet", kLoses);
  add("dart", "echo 'Assertion `it is finite` failed.' >&2; kill -ABRT $$");
  add("ode", "printf 'drifts\\t1\\t0\\t0\\t1\\t0.5\\t1e-9\\t\\n.\\n'");
  const std::vector<PeerCell> cells = fly();
  ASSERT_EQ(cells.size(), 6u);
  EXPECT_EQ(cells[1].fate, Fate::kEnds);
  EXPECT_TRUE(contains(cells[1].verdict.why, {"signal 6", "Assertion `it is finite` failed."}));
  EXPECT_EQ(cells[2].fate, Fate::kDrifts);
  EXPECT_EQ(cells[4].fate, Fate::kEnds);
}

TEST_F(Engines, AnswersMayBeTooSmallForANormalNumber) {
  add("ode", "printf 'holds\\t1\\t0\\t-4.9e-324\\t1\\t1e-310\\t1e-9\\t\\n.\\n'");
  const PeerCell cell = fly().at(0);
  EXPECT_EQ(cell.fate, Fate::kHolds);
  EXPECT_EQ(cell.verdict.errors.at(0), 1e-310);
  EXPECT_EQ(cell.verdict.momentum_error, -4.9e-324);
}

TEST_F(Engines, OneThatSaysSomethingElseHasNotAnswered) {
  add("ode", "echo 'holds'; echo 'wrong\t1\t0\t0\t7\t1'; exit 3");
  EXPECT_EQ(fly().at(0).fate, Fate::kEnds);
}

TEST_F(Engines, OneThatDoesNotComeBackIsGivenUp) {
  add("simbody", "exec sleep 600");
  EXPECT_EQ(fly(0.1).at(0).fate, Fate::kSlow);
}

TEST_F(Engines, AreFlownInTheOrderOfTheirNamesAndNotWithoutAny) {
  EXPECT_TRUE(contains(refusal([&] { engineNames({folder_}); }), {folder_, "compare_hard_cases"}));
  EXPECT_TRUE(contains(refusal([&] { engineNames({"/nowhere"}); }), {"/nowhere"}));
  add("ode", "");
  add("bullet", "");
  EXPECT_EQ(engineNames({folder_}), (std::vector<std::string>{"bullet", "ode"}));
}

TEST_F(Engines, TableAndFileHaveALineACaseAndALineACell) {
  add("bullet", kLoses);
  std::ostringstream table;
  print(fly(), table);
  EXPECT_TRUE(contains(table.str(), {"Other engines", "bullet", "separatrix", "x E -27%"}));
  writeCsv(fly(), folder_);
  const std::string file = readTextFile(folder_ + "/peers.csv");
  EXPECT_EQ(std::count(file.begin(), file.end(), '\n'), 1 + 2);
  EXPECT_TRUE(contains(file, {"separatrix,bullet,wrong,x E -27%,attitude,rad,2.64", "and why"}));
}

}  // namespace
}  // namespace rigid_body_sim::hard_cases

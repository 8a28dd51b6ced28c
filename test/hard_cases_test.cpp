// The program that flies the gallery: its table and files. What it measures is gallery_test's.
#include <algorithm>
#include <filesystem>
#include <sstream>

#include "generic.hpp"
#include "tools/hard_cases/matrix.hpp"

namespace rigid_body_sim::hard_cases {
namespace {

std::vector<Cell> someCells() {
  return fly({{"spin_64_rad_a_step", "torque_switches_each_tick"}, {"exact", "rk4"}, false},
             [](const std::string&, double) {});
}

TEST(HardCases, AreFlownCaseByCaseInTheRegistrysOrder) {
  const std::vector<Cell> cells = someCells();
  ASSERT_EQ(cells.size(), 4u);
  EXPECT_EQ(cells[0].one->name, "spin_64_rad_a_step");
  EXPECT_EQ(cells[0].rung, "rk4");
  EXPECT_EQ(cells[1].rung, "exact");
  EXPECT_EQ(cells[3].one->name, "torque_switches_each_tick");
  for (const Cell& cell : cells) EXPECT_TRUE(cell.keepsClaim()) << cell.rung;
}

TEST(HardCases, TableSaysWhatBecameOfEach) {
  std::ostringstream table;
  print(someCells(), table);
  EXPECT_TRUE(contains(table.str(), {"  1 rk4", "  2 exact", "spin_64_rad_a_step", "refused"}));
  EXPECT_EQ(table.str().find("BROKEN"), std::string::npos);
}

TEST(HardCases, TableNamesWhatIsNotAsClaimed) {
  std::vector<Cell> cells = someCells();
  cells[1].verdict.outcome = reference::Outcome::kWrong;
  cells[1].verdict.errors.front() = 1;
  std::ostringstream table;
  print(cells, table);
  EXPECT_TRUE(contains(table.str(), {"x1!", "BROKEN: spin_64_rad_a_step with exact", "'wrong'"}));
}

TEST(HardCases, FilesHaveALineACaseAndALineACell) {
  const std::string folder =
      (std::filesystem::temp_directory_path() / "rigid_body_sim_hard_cases_test").string();
  writeCsv(someCells(), folder);
  const std::string cases = readTextFile(folder + "/cases.csv");
  const std::string cells = readTextFile(folder + "/cells.csv");
  std::filesystem::remove_all(folder);
  EXPECT_EQ(std::count(cases.begin(), cases.end(), '\n'), 1 + 2);
  EXPECT_EQ(std::count(cells.begin(), cells.end(), '\n'), 1 + 4);
  EXPECT_TRUE(contains(cells, {"spin_64_rad_a_step,rk4,refused,refused,1,", "substeps or more"}));
}

TEST(HardCases, RefuseCasesAndRungsThatAreNotThere) {
  const auto nothing = [](const std::string&, double) {};
  EXPECT_TRUE(contains(refusal([&] { fly({{"easy"}, {}, false}, nothing); }), {"easy"}));
  EXPECT_TRUE(contains(refusal([&] { fly({{}, {"rk9"}, false}, nothing); }), {"rk9"}));
}

}  // namespace
}  // namespace rigid_body_sim::hard_cases

// Energy that a method makes between two looks at it.
#include "ros_fixture.hpp"

namespace rigid_body_sim {
namespace {

using diagnostic_msgs::DiagnosticStatus;
using Encounter = NodeTest;

/// As diagnosed after so many ticks.
Status statusAt(Sim& sim, std::uint64_t tick) {
  return sim.diagnostics([=](const Status& one) { return one.count("tick") == tick; });
}

TEST_F(Encounter, LeavesAWarningThatStaysUntilReset) {
  EXPECT_EQ(statusAt(sim, sim.step(10).tick).level, DiagnosticStatus::OK);
  // Far away by then, where nothing is too stiff.
  const Status after = statusAt(sim, sim.step(30).tick);
  EXPECT_EQ(after.level, DiagnosticStatus::WARN);
  EXPECT_NE(after.message.find("J were unaccounted for at tick "), std::string::npos)
      << after.message;
  EXPECT_EQ(after.message.find("stiff"), std::string::npos) << after.message;
  const Status later = statusAt(sim, sim.step(5000).tick);
  EXPECT_EQ(later.message, after.message);
  EXPECT_EQ(later.level, DiagnosticStatus::WARN);
  sim.reset();
  EXPECT_EQ(statusAt(sim, sim.step(1).tick).level, DiagnosticStatus::OK);
}

}  // namespace
}  // namespace rigid_body_sim

int main(int argc, char** argv) { return rigid_body_sim::runRostest(argc, argv, "encounter_test"); }

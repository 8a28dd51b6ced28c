// What the list of effects costs beside one loop that a hand has written for the same effects: see
// instruction_count/fused.cpp. Times in turn, the least of each; alone, as it measures time.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "generic.hpp"
#include "tools/child_process.hpp"

namespace rigid_body_sim {
namespace {

constexpr const char* kBodies = "10000";

struct Run {
  double ns = kInf;  ///< of a body and tick
  std::vector<double> state;
};

Run runOf(const std::string& effects, const std::string& way) {
  ChildProcess program({TEST_PROGRAM_DIR "/fused", effects, way, kBodies, "20"});
  EXPECT_EQ(program.exitCode(60), 0) << program.said();
  std::istringstream words(program.said());
  Run run;
  std::string unit;
  words >> run.ns >> unit;
  for (double number = 0; words >> number;) run.state.push_back(number);
  EXPECT_EQ(run.state.size(), 13u) << program.said();
  return run;
}

/// Time with the list of effects by that of the one loop.
double ratioOf(const std::string& effects) {
  double list_ns = kInf, fused_ns = kInf;
  for (int round = 0; round < 2; ++round) {
    const Run list = runOf(effects, "list"), fused = runOf(effects, "fused");
    list_ns = std::min(list_ns, list.ns);
    fused_ns = std::min(fused_ns, fused.ns);
    for (std::size_t k = 0; k < list.state.size(); ++k)  // roundings of 21 ticks, not other physics
      EXPECT_NEAR(list.state[k], fused.state[k], 1e-12 * std::max(1.0, std::abs(fused.state[k])));
  }
  return list_ns / fused_ns;
}

TEST(EffectOverhead, OfFreeFlightIsWithinTwoPercentOfOneLoop) {
  const double ratio = ratioOf("free");
  RecordProperty("ratio", std::to_string(ratio));
  EXPECT_LE(ratio, 1.02);  // measured: 0.95
}

TEST(EffectOverhead, OfTenEffectsIsWithinTenPercentOfOneLoop) {
  const double ratio = ratioOf("all");
  RecordProperty("ratio", std::to_string(ratio));
  EXPECT_LE(ratio,
            1.10);  // measured: 0.74, as passes of one effect become SIMD and one loop does not
}

}  // namespace
}  // namespace rigid_body_sim

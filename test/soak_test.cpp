// Whether a bias would be seen; the flights that are long enough to mean something are soak's.
#include "tools/soak/soak.hpp"

#include <cmath>
#include <sstream>

#include "generic.hpp"

namespace rigid_body_sim::soak {
namespace {

constexpr int kBodies = 32;

/// Deviations of a random walk in steps of an ulp, with a drift of `bias` ulps a step.
std::vector<std::vector<double>> walked(double bias) {
  std::mt19937 generator(7);
  std::vector<double> sum(kBodies, 0.0);
  std::vector<std::vector<double>> looks;
  for (int look = 0; look < 64; ++look) {
    for (int step = 0; step < 1000; ++step)
      for (double& one : sum) one += kEps * ((generator() & 1u ? 1 : -1) + bias);
    looks.push_back(sum);
  }
  return looks;
}

TEST(Walk, AtRandomIsNotBiasedAndGrowsByTheRootOfTheSteps) {
  const Walk walk = walkOf(walked(0));
  EXPECT_FALSE(walk.isBiased(kBodies));
  EXPECT_NEAR(walk.scatter, std::sqrt(64'000) * kEps, 0.3 * walk.scatter);
  EXPECT_NEAR(walk.exponent, 0.5, 0.1);
}

TEST(Walk, ThatDriftsByAHundredthOfItsStepIsBiased) {
  const Walk walk = walkOf(walked(0.01));
  EXPECT_TRUE(walk.isBiased(kBodies));
  EXPECT_NEAR(walk.mean / kEps, 640, 3 * std::sqrt(64'000.0 / kBodies));
  EXPECT_GT(walk.exponent, 0.7);
}

TEST(Walk, ThatNeverLeavesIsNotBiased) {
  const Walk walk = walkOf(std::vector<std::vector<double>>(64, std::vector<double>(kBodies, 0)));
  EXPECT_FALSE(walk.isBiased(kBodies));
  EXPECT_EQ(walk.worst, 0);
}

TEST(Walk, OfNumbersThatAreNoneIsBiased) {
  const double nan = std::nan("");
  EXPECT_TRUE(walkOf({std::vector<double>(kBodies, nan)}).isBiased(kBodies));
}

TEST(Walk, OfEachToItsOwnSideIsADriftAndNoBias) {
  std::vector<std::vector<double>> looks = walked(0);
  for (std::size_t look = 0; look < looks.size(); ++look)
    for (int i = 0; i < kBodies; ++i)
      looks[look][static_cast<std::size_t>(i)] +=
          (i % 2 == 0 ? 1 : -1) * 0.05 * kEps * 1000 * static_cast<double>(look + 1);
  const Walk walk = walkOf(looks);
  EXPECT_TRUE(walk.isDrift());
  EXPECT_FALSE(walk.isBiased(kBodies));
  EXPECT_FALSE(walkOf(walked(0)).isDrift());
}

TEST(Soak, OfEachRungLeavesLToTheBitAndEnergyWithinWhatWasMeasured) {
  for (const std::string& rung : rungs()) {
    const Report report = fly(rung, 200'000, [](double) {});
    EXPECT_EQ(report.ticks % 64, 0) << rung;
    EXPECT_LE(report.length_worst, 4 * kEps) << rung;
    EXPECT_EQ(report.angular_momentum.worst, 0) << rung;
    EXPECT_TRUE(report.isAsMeasured())
        << rung << " " << report.energy.worst << " of " << report.energy_limit;
    EXPECT_FALSE(rung == "exact" && report.energy.isDrift());
    std::ostringstream text;
    print({report}, text);
    EXPECT_TRUE(contains(text.str(), {rung, "to the bit"}));
    EXPECT_EQ(text.str().find("MORE"), std::string::npos);
  }
}

TEST(Soak, SaysWhatIsMoreThanWasMeasured) {
  Report report = fly("exact", 640, [](double) {});
  report.energy.worst = 1e-13;
  std::ostringstream text;
  print({report}, text);
  EXPECT_TRUE(contains(text.str(), {"MORE than was measured"}));
}

TEST(Soak, RefusesRungsOfWhichTruncationIsMore) {
  EXPECT_TRUE(
      contains(refusal([] { fly("semi_implicit", 64, [](double) {}); }), {"exact, split2"}));
}

}  // namespace
}  // namespace rigid_body_sim::soak

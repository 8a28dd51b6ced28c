// Which wrenches are held, and which end which.
#include <algorithm>

#include "generic.hpp"

namespace rigid_body_sim {
namespace {

/// As a topic gives it: held, replacing what the same publisher sent before.
WrenchInput held(const std::string& source, std::uint64_t sequence, Eigen::Index body = 0) {
  WrenchInput input;
  input.body = body;
  input.applied.wrench.f_F << 0.7, -1.9, 1.3;
  input.replaces = true;
  input.origin = {source, sequence, 0};
  return input;
}

/// Sequences of what is held.
std::vector<std::uint64_t> sequences(const AppliedWrenches& applied) {
  std::vector<std::uint64_t> result;
  for (const WrenchInput& input : applied.held()) result.push_back(input.origin.sequence);
  return result;
}

using Sequences = std::vector<std::uint64_t>;

bool isReplacedBy(const WrenchInput& old, const WrenchInput& input) {
  std::vector<WrenchInput> held = {old};
  settle(held, {input});
  return held.size() == 1;
}

TEST(IsReplacedBy, ALaterMessageOfThePublisher) {
  EXPECT_TRUE(isReplacedBy(held("/a/wrench", 7), held("/a/wrench", 8)));
}

TEST(IsReplacedBy, AMessageOfThePublisherThatStartedAgainAndCountsFromZero) {
  EXPECT_TRUE(isReplacedBy(held("/a/wrench", 7), held("/a/wrench", 0)));
  EXPECT_TRUE(isReplacedBy(held("/a/wrench", 7), held("/a/wrench", 6)));
}

TEST(IsReplacedBy, NoOtherEntryOfItsOwnMessage) {
  WrenchInput second = held("/wrenches", 7);
  second.origin.entry = 1;
  EXPECT_FALSE(isReplacedBy(held("/wrenches", 7), second));
}

TEST(IsReplacedBy, NothingOfAnotherPublisherOrBody) {
  EXPECT_FALSE(isReplacedBy(held("/a/wrench", 7), held("/b/wrench", 8)));
  EXPECT_FALSE(isReplacedBy(held("/a/wrench", 7, 0), held("/a/wrench", 8, 1)));
}

TEST(IsReplacedBy, NothingUnlessBothReplace) {
  WrenchInput adds = held("/a/wrench", 8);
  adds.replaces = false;
  EXPECT_FALSE(isReplacedBy(held("/a/wrench", 7), adds));
  EXPECT_FALSE(isReplacedBy(adds, held("/a/wrench", 9)));
}

TEST(AppliedWrenches, OfAPublisherThatStartedAgainEndItsOldOnes) {
  AppliedWrenches applied;
  applied.update({held("/a/wrench", 7), held("/b/wrench", 9)}, 0);
  ASSERT_EQ(sequences(applied), (Sequences{7, 9}));
  EXPECT_TRUE(applied.update({held("/a/wrench", 0)}, 1).empty());  // replaced, not run out
  EXPECT_EQ(sequences(applied), (Sequences{0, 9}));
}

TEST(AppliedWrenches, OfZeroOnlyReplace) {
  AppliedWrenches applied;
  applied.update({held("/a/wrench", 7), held("/b/wrench", 9)}, 0);
  WrenchInput zero = held("/a/wrench", 8);
  zero.applied.wrench = {};
  applied.update({zero}, 1);
  EXPECT_EQ(sequences(applied), (Sequences{9}));
}

TEST(AppliedWrenches, ThatRanOutAreHandedBackAtTheTickAfterTheirLast) {
  AppliedWrenches applied;
  WrenchInput brief = held("/a/wrench", 7);
  brief.start = 5;
  brief.ticks = 2;
  EXPECT_TRUE(applied.update({brief, held("/b/wrench", 9)}, 5).empty());
  EXPECT_TRUE(applied.update({}, 6).empty());
  EXPECT_EQ(sequences(applied), (Sequences{7, 9}));
  const std::vector<WrenchInput> ended = applied.update({}, 7);
  ASSERT_EQ(ended.size(), 1u);
  EXPECT_EQ(ended[0].origin.sequence, 7u);
  EXPECT_EQ(sequences(applied), (Sequences{9}));
}

TEST(AppliedWrenches, AreHeldInOneOrderWhateverOrderTheyCameIn) {
  std::vector<WrenchInput> inputs = {held("/a", 3, 0), held("/b", 1, 0), held("/a", 2, 1),
                                     held("/c", 5, 1)};
  do {
    AppliedWrenches at_once, one_by_one;
    at_once.update(inputs, 0);
    for (const WrenchInput& input : inputs) one_by_one.update({input}, 0);
    EXPECT_EQ(sequences(at_once), (Sequences{3, 1, 2, 5}));
    EXPECT_EQ(sequences(one_by_one), (Sequences{3, 1, 2, 5}));
  } while (std::next_permutation(inputs.begin(), inputs.end(), [](const auto& a, const auto& b) {
    return a.origin.sequence < b.origin.sequence;
  }));
}

}  // namespace
}  // namespace rigid_body_sim

// An accuracy budget as users of the node see it: the bill, the diagnostics, a new choice.

#include <std_msgs/String.h>

#include "probe_inputs.hpp"

namespace rigid_body_sim {
namespace {

using diagnostic_msgs::DiagnosticStatus;

const Vector3d kTorque(0.8, -0.5, 0.6);
constexpr std::uint64_t kTicks = 150;  // the push acts from tick 20 to tick 119

/// A simulator of scenes/budget.yaml or replan.yaml in a namespace.
class Budgeted {
 public:
  explicit Budgeted(const std::string& ns)
      : sim("/" + ns + "/sim"),
        states(sim, "/" + ns + "/states"),
        bills(sim, "/" + ns + "/accuracy_bill"),
        wrenches_(sim, "/" + ns + "/wrenches") {
    states.expect(1);
    bills.expect(1);
  }

  /// Turns the rotor ever faster for two seconds.
  void push() {
    BodyWrench entry = bodyWrench("rotor", "rotor", Vector3d::Zero(), kTorque, 2);
    entry.start = states.messages.back().header.stamp + ros::Duration(20 * kStep_s);
    wrenches_.send(arrayOf<BodyWrenches>(std::vector<BodyWrench>{entry}));
  }

  Sim sim;
  Recording<BodyStates> states;
  Recording<std_msgs::String> bills;

 private:
  Input<BodyWrenches> wrenches_;
};

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(AccuracyBill, IsLatchedAndDiagnosticsFollowIt) {
  Budgeted warned("warned");
  const std::string bill = warned.bills.messages.back().data;
  for (const char* part : {"accuracy: 1e-06 rad over 10 s", "calm, rotor: exact leaves",
                           "runner-up", "one digit less", "one digit more", "reference: exact"})
    EXPECT_TRUE(has(bill, part)) << part << " is not in\n" << bill;
  warned.sim.step(40);
  const Status status = warned.sim.diagnostics([](const Status& now) {
    const auto found = now.values.find("local errors measured");
    return found != now.values.end() && found->second != "0";
  });
  EXPECT_EQ(status.level, DiagnosticStatus::OK) << status.message;
  EXPECT_EQ(status.values.at("accuracy budget"), "1e-06 rad over 10 s");
  EXPECT_EQ(status.values.at("accuracy plans made"), "1");
  EXPECT_EQ(status.values.at("accuracy method 1"), "exact: calm, rotor");
  for (const char* key : {"local error latest", "local error worst", "predicted error"})
    EXPECT_TRUE(has(status.values.at(key), " rad and ")) << key;
  EXPECT_TRUE(has(status.values.at("scene"), "exact (2 bodies) to keep 1e-06 rad over 10 s"));
}

TEST(AccuracyBill, DiagnosticsWarnWhenAPushBreaksTheBudget) {
  Budgeted warned("warned");
  warned.sim.reset();
  warned.push();
  warned.sim.step(100);
  const Status status =
      warned.sim.diagnostics([](const Status& now) { return now.level == DiagnosticStatus::WARN; });
  EXPECT_TRUE(has(status.message, "the accuracy budget breaks: rotor: ")) << status.message;
  EXPECT_EQ(status.values.at("accuracy plans made"), "1");
  warned.sim.reset();
  warned.sim.step(40);
  const Status after =
      warned.sim.diagnostics([](const Status& now) { return now.level == DiagnosticStatus::OK; });
  EXPECT_EQ(after.level, DiagnosticStatus::OK) << after.message;
}

TEST(AccuracyBill, ANewChoiceIsPublishedAndTheSameAtAnySpeed) {
  Budgeted fast("fast"), real("real");
  for (Budgeted* one : {&fast, &real}) {  // one by one: the fast one would take all the time
    one->push();
    one->sim.unpause();
    need("its ticks", [&] { return one->states.messages.back().tick >= kTicks; });
    one->sim.pause();
  }
  fast.bills.expect(2);
  real.bills.expect(2);
  EXPECT_EQ(fast.bills.messages[1].data, real.bills.messages[1].data);
  EXPECT_FALSE(has(fast.bills.messages[1].data, "from tick 0"));
  EXPECT_FALSE(has(fast.bills.messages[1].data, "calm, rotor: exact")) << "they part";

  // At full speed roscpp's queue drops some; those that came are the same.
  std::map<std::uint64_t, const BodyStates*> by_tick;
  for (const BodyStates& one : real.states.messages) by_tick[one.tick] = &one;
  std::size_t compared = 0;
  for (const BodyStates& one : fast.states.messages) {
    const auto found = by_tick.find(one.tick);
    if (found == by_tick.end()) continue;
    EXPECT_TRUE(sameBits(one, *found->second)) << "tick " << one.tick;
    ++compared;
  }
  EXPECT_GT(compared, 50u);
  const Status status = real.sim.diagnostics([](const Status& now) {
    const auto found = now.values.find("accuracy plans made");
    return found != now.values.end() && found->second != "1";
  });
  EXPECT_FALSE(has(status.message, "accuracy")) << status.message;
}

}  // namespace
}  // namespace rigid_body_sim

int main(int argc, char** argv) {
  return rigid_body_sim::runRostest(argc, argv, "accuracy_bill_test");
}

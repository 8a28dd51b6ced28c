// A body whose state would become infinite or not a number, as the node's users see it.

#include <rosgraph_msgs/Log.h>
#include <tf2_msgs/TFMessage.h>

#include <cmath>

#include "probe.hpp"
#include "ros_fixture.hpp"

namespace rigid_body_sim {
namespace {

using diagnostic_msgs::DiagnosticStatus;

constexpr int kWild = 1;  // its place in the messages

class Freeze : public NodeTest {
 protected:
  static bool isFinite(const BodyStates& states) {
    for (const std::string& name : states.names) {
      const Motion motion = motionOf(states, name);
      if (!motion.p_WL.allFinite() || !motion.q_WL.coeffs().allFinite() ||
          !motion.v_WL_L.allFinite() || !motion.w_WL_L.allFinite())
        return false;
    }
    return true;
  }

  static bool isSame(const BodyStates& a, const BodyStates& b, int body) {
    return std::memcmp(&a.poses[body], &b.poses[body], sizeof(a.poses[body])) == 0 &&
           std::memcmp(&a.twists[body], &b.twists[body], sizeof(a.twists[body])) == 0;
  }

  /// Steps until the wild body does not move any more; the states then.
  BodyStates stepUntilFrozen() {
    BodyStates before = sim.step();
    for (int k = 0; k < 1000; ++k) {
      const BodyStates after = sim.step();
      EXPECT_TRUE(isFinite(after)) << "tick " << after.tick;
      if (isSame(before, after, kWild)) return after;
      before = after;
    }
    throw std::runtime_error("it never freezes");
  }
};

TEST_F(Freeze, ItStopsAtItsLastGoodStateAndTheOthersGoOn) {
  const BodyStates frozen = stepUntilFrozen();
  const BodyStates later = sim.step(100);
  EXPECT_TRUE(isSame(frozen, later, kWild));
  EXPECT_TRUE(isFinite(later));
  const Motion before = motionOf(frozen, "calm"), after = motionOf(later, "calm");
  const Vector3d way = 100 * kStep_s * Vector3d(0.1, -0.2, 0.3);
  // A hundred additions to numbers up to five, half an ulp (4e-16) each.
  EXPECT_LE((after.p_WL - before.p_WL - way).norm(), 1e-13);
  EXPECT_GT((after.q_WL.coeffs() - before.q_WL.coeffs()).norm(), 0.1) << "it turns";
}

TEST_F(Freeze, TransformsAndOdometryCarryOnlyFiniteNumbersAndUnitQuaternions) {
  Recording<tf2_msgs::TFMessage> tf(sim, "/tf");
  tf.expect(1);
  const std::uint64_t first = sim.step().tick;
  const std::uint64_t last = stepUntilFrozen().tick;
  tf.expect(2 + last - first);
  for (const tf2_msgs::TFMessage& message : tf.messages) {
    ASSERT_EQ(message.transforms.size(), 2u) << "a frozen body keeps its frame";
    for (const auto& one : message.transforms) {
      EXPECT_TRUE(toEigen(one.transform.translation).allFinite());
      // tf2 refuses what is off by more than 1e-3 (QUATERNION_NORMALIZATION_TOLERANCE).
      EXPECT_NEAR(toEigen(one.transform.rotation).norm(), 1, 1e-9);
    }
  }
}

TEST_F(Freeze, DiagnosticsAndALineNameItAndResetClearsIt) {
  Recording<rosgraph_msgs::Log> log(sim, "/rosout");
  const BodyStates frozen = stepUntilFrozen();
  log.expect(1);
  EXPECT_EQ(log.messages[0].level, rosgraph_msgs::Log::ERROR);
  EXPECT_NE(log.messages[0].msg.find("wild is frozen"), std::string::npos) << log.messages[0].msg;
  const Status error =
      sim.diagnostics([](const Status& now) { return now.level == DiagnosticStatus::ERROR; });
  EXPECT_NE(error.message.find("wild is frozen"), std::string::npos) << error.message;
  EXPECT_EQ(error.values.count("frozen: wild"), 1u);
  EXPECT_EQ(error.values.count("frozen: calm"), 0u);
  sim.step(10);
  EXPECT_EQ(log.messages.size(), 1u) << "one line";

  sim.reset();
  const BodyStates again = sim.step();
  EXPECT_FALSE(isSame(again, frozen, kWild));
  EXPECT_FALSE(isSame(again, sim.step(), kWild)) << "it moves";
  const Status ok =
      sim.diagnostics([](const Status& now) { return now.level == DiagnosticStatus::OK; });
  EXPECT_EQ(ok.values.count("frozen: wild"), 0u);
}

TEST_F(Freeze, AfterAResetItFreezesAtTheSameTickInTheSameState) {
  const std::uint64_t start = sim.step().tick;
  const BodyStates first = stepUntilFrozen();
  sim.reset();
  const std::uint64_t again = sim.step().tick;
  const BodyStates second = stepUntilFrozen();
  EXPECT_EQ(second.tick - again, first.tick - start);
  EXPECT_TRUE(sameBits(first, second));
}

}  // namespace
}  // namespace rigid_body_sim

int main(int argc, char** argv) { return rigid_body_sim::runRostest(argc, argv, "freeze_test"); }

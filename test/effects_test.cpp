// Effects of a running node: switched by a service, seen in topics and diagnostics.

#include <rigid_body_sim/EffectWrenches.h>
#include <rigid_body_sim/SwitchEffect.h>

#include "probe_inputs.hpp"

namespace rigid_body_sim {
namespace {

const Vector3d kGravity(0.3, -0.4, -9.8);

class Effects : public NodeTest {
 protected:
  static SwitchEffect::Response turn(const std::string& effect, bool active) {
    SwitchEffect service;
    service.request.effect = effect;
    service.request.active = active;
    EXPECT_TRUE(ros::service::call("/rigid_body_sim/switch_effect", service)) << "a failed call";
    return service.response;
  }

  Vector3d momentum(std::uint32_t ticks) { return momentumOf(probe(), sim.step(ticks)).P_WB; }
};

/// The momentum after n ticks of half a kick, exp(-c h) and half a kick.
Vector3d fallen(Vector3d P_WB, int ticks, const Vector3d& g_W, double damping) {
  for (int i = 0; i < ticks; ++i) {
    P_WB += 0.5 * kStep_s * probe().mass * g_W;
    P_WB *= std::exp(-damping * kStep_s);
    P_WB += 0.5 * kStep_s * probe().mass * g_W;
  }
  return P_WB;
}

TEST_F(Effects, AreSwitchedOffAndOnFromTheNextTickOnUntilTheReset) {
  const Vector3d start = momentumAtStart(probe()).P_WB;
  const double rounding = 1e-13 * probe().mass * 10;  // of some hundred sums
  Vector3d P_WB = momentum(5);
  Vector3d wanted = fallen(start, 5, kGravity, 0.5);
  EXPECT_LT((P_WB - wanted).norm(), rounding);

  const SwitchEffect::Response off = turn("gravity", false);
  EXPECT_TRUE(off.success) << off.message;
  EXPECT_EQ(off.message.find("gravity"), std::string::npos) << off.message;
  EXPECT_NE(off.message.find("damping (1 body)"), std::string::npos) << off.message;
  EXPECT_EQ(turn("gravity", false).message.rfind("gravity is off already: ", 0), 0u);
  P_WB = momentum(5);
  wanted = fallen(wanted, 5, Vector3d::Zero(), 0.5);
  EXPECT_LT((P_WB - wanted).norm(), rounding);

  EXPECT_TRUE(turn("damping", false).success);
  EXPECT_TRUE(turn("gravity", true).success);
  P_WB = momentum(5);
  wanted = fallen(wanted, 5, kGravity, 0);
  EXPECT_LT((P_WB - wanted).norm(), rounding);

  sim.reset();
  P_WB = momentum(5);
  EXPECT_LT((P_WB - fallen(start, 5, kGravity, 0.5)).norm(), rounding);
}

TEST_F(Effects, ThatTheSceneDoesNotHaveAreRefusedWithThoseItHas) {
  for (const std::string name : {"drag", "", "magnetic_dipole", "applied"}) {
    const SwitchEffect::Response refused = turn(name, true);
    EXPECT_FALSE(refused.success) << name;
    EXPECT_NE(refused.message.find("gyroscopic, gravity, damping"), std::string::npos)
        << refused.message;
  }
}

TEST_F(Effects, ShowTheirOwnWrenchesOnRequest) {
  Recording<EffectWrenches> recording(sim, "/effect_wrenches");
  const BodyStates states = sim.step(1);
  need("the tick's wrenches", [&] {
    return !recording.messages.empty() &&
           recording.messages.back().header.stamp == states.header.stamp;
  });
  const EffectWrenches& wrenches = recording.messages.back();
  EXPECT_EQ(wrenches.header.frame_id, "world");
  EXPECT_EQ(wrenches.names, states.names);
  ASSERT_EQ(wrenches.effects.size(), 2u);
  EXPECT_EQ(wrenches.effects[0].effect, "gravity");
  EXPECT_EQ(wrenches.effects[1].effect, "damping");
  const Vector3d weight = toEigen(wrenches.effects[0].wrenches[0].force);
  EXPECT_LT((weight - probe().mass * kGravity).norm(), 1e-14 * weight.norm());
  const Vector3d braking = toEigen(wrenches.effects[1].wrenches[0].force);
  EXPECT_LT((braking + 0.5 * momentumOf(probe(), states).P_WB).norm(), 1e-13);
  EXPECT_EQ(toEigen(wrenches.effects[1].wrenches[1].force), Vector3d::Zero());
}

TEST_F(Effects, AndInputsAddUpToTheAppliedWrenchInTheBodysAxes) {
  const Vector3d push(2.1, -1.4, 0.9);
  Recording<WrenchStamped> recording(sim, "/probe/applied_wrench");
  Input<WrenchStamped> input(sim, "/probe/wrench");
  EXPECT_TRUE(turn("damping", false).success);
  input.send(wrenchIn("world", push));
  const BodyStates states = sim.step(1);
  need("the tick's wrench", [&] {
    return !recording.messages.empty() &&
           recording.messages.back().header.stamp == states.header.stamp;
  });
  EXPECT_EQ(recording.messages.back().header.frame_id, "probe/com");
  // The axes of probe/com are the principal ones: the length tells without them.
  const Vector3d force = toEigen(recording.messages.back().wrench.force);
  EXPECT_NEAR(force.norm(), (probe().mass * kGravity + push).norm(), 1e-12);
}

TEST_F(Effects, AreCountedAndAuditedInDiagnostics) {
  sim.step(10);
  const Status status = sim.diagnostics(
      [](const Status& one) { return one.values.count("evaluations of gravity") > 0; });
  EXPECT_EQ(status.count("evaluations of gravity"), 10u * 2 * 2);  // ticks, bodies, kicks
  EXPECT_EQ(status.count("evaluations of damping"), 10u * 1 * 1);
  EXPECT_EQ(status.values.count("evaluations of magnetic_dipole"), 0u);
  EXPECT_EQ(status.values.count("not computed"), 1u);
  const double unaccounted = std::stod(status.values.at("energy unaccounted for"));
  EXPECT_LT(std::abs(unaccounted), 1e-2);  // of some 10 J that the damping takes
  EXPECT_NE(status.values.at("work since the start").find("0 J of inputs, -"), std::string::npos)
      << status.values.at("work since the start");
}

}  // namespace
}  // namespace rigid_body_sim

int main(int argc, char** argv) { return rigid_body_sim::runRostest(argc, argv, "effects_test"); }

#include "generic.hpp"
#include "rigid_body_sim/effect.hpp"

namespace rigid_body_sim {
namespace {

const Vector3d kGravity(0.3, -0.4, -9.80665);

Bodies threeBodies() {
  Bodies bodies(3);
  for (int i = 0; i < 3; ++i) bodies.setState(i, {});
  bodies.mass << 0.5, 2, 4;
  bodies.I_BBcm_B.setOnes();
  return bodies;
}

TEST(Gravity, PullsEveryListedBodyByItsMass) {
  const auto gravity = uniformGravity(kGravity, {0, 2});
  ActiveEffects active;
  active.add(gravity.get());
  const Wrenches& wrenches = active.evaluate(threeBodies(), 0);
  EXPECT_EQ(Vector3d(wrenches.f_W.row(0)), 0.5 * kGravity);
  EXPECT_EQ(Vector3d(wrenches.f_W.row(1)), Vector3d::Zero());
  EXPECT_EQ(Vector3d(wrenches.f_W.row(2)), 4 * kGravity);
}

TEST(Gravity, ActsAtTheCentreOfMassAndSoHasNoTorque) {
  const auto gravity = uniformGravity(kGravity, {0, 1, 2});
  ActiveEffects active;
  active.add(gravity.get());
  EXPECT_TRUE(active.evaluate(threeBodies(), 0).t_Bcm_W.isZero(0));
}

TEST(Gravity, SaysWhatItIsAndOnHowManyBodies) {
  EXPECT_EQ(uniformGravity(kGravity, {0, 2})->name(), "gravity");
  EXPECT_EQ(uniformGravity(kGravity, {0, 2})->bodyCount(), 2u);
}

TEST(ActiveEffects, Add) {
  const auto first = uniformGravity({1, 2, 3}, {0, 1});
  const auto second = uniformGravity({10, 0, 0}, {1});
  ActiveEffects active;
  EXPECT_TRUE(active.empty());
  active.add(first.get());
  active.add(second.get());
  EXPECT_FALSE(active.empty());
  const Wrenches& wrenches = active.evaluate(threeBodies(), 0);
  EXPECT_EQ(Vector3d(wrenches.f_W.row(0)), Vector3d(0.5, 1, 1.5));
  EXPECT_EQ(Vector3d(wrenches.f_W.row(1)), Vector3d(22, 4, 6));
}

TEST(ActiveEffects, StartFromNothingAtEveryEvaluation) {
  const auto gravity = uniformGravity({1, 2, 3}, {1});
  ActiveEffects active;
  active.add(gravity.get());
  active.evaluate(threeBodies(), 0);
  EXPECT_EQ(Vector3d(active.evaluate(threeBodies(), 0).f_W.row(1)), Vector3d(2, 4, 6));
}

TEST(ActiveEffects, ForgetTheOneThatIsRemoved) {
  const auto first = uniformGravity({1, 2, 3}, {0});
  const auto second = uniformGravity({10, 0, 0}, {0});
  ActiveEffects active;
  active.add(first.get());
  active.add(second.get());
  active.remove(first.get());
  EXPECT_EQ(Vector3d(active.evaluate(threeBodies(), 0).f_W.row(0)), Vector3d(5, 0, 0));
  active.remove(second.get());
  EXPECT_TRUE(active.empty());
}

}  // namespace
}  // namespace rigid_body_sim

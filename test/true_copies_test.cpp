#include "core/true_copies.hpp"

#include "accuracy_scenes.hpp"

namespace rigid_body_sim {
namespace {

TEST(TrueCopies, AreEightAtMostAndOneOfABody) {
  const Simulator simulator(swarmScene(12).scene);
  TrueCopies copies;
  for (Eigen::Index i = 0; i < 8; ++i) {
    EXPECT_TRUE(copies.follow(i, simulator.bodies(), 5));
    EXPECT_FALSE(copies.follow(i, simulator.bodies(), 6));
  }
  EXPECT_FALSE(copies.follow(8, simulator.bodies(), 7));
  copies.forget(3);
  EXPECT_TRUE(copies.follow(8, simulator.bodies(), 8));
  EXPECT_EQ(copies.copies().back().body, 8);
  EXPECT_EQ(copies.copies().back().since, 8);
}

TEST(TrueCopies, GetTheImpulseAtTheirOwnAttitude) {
  Simulator simulator(swarmScene(2).scene);
  Bodies turned = simulator.bodies();
  BodyState state = turned.state(1);
  state.q_WB = genericAttitude() * state.q_WB;
  turned.setState(1, state);
  TrueCopies copies;
  copies.follow(1, turned, 0);
  ImpulseInput input;
  input.applied = {Axes::kBody, {{1, 2, 3}, {0.3, -0.4, 0.5}}, {0.1, 0.2, -0.3}};
  copies.give(input);  // of another body
  EXPECT_TRUE(sameBits(copies.copies()[0].state, state));
  input.body = 1;
  copies.give(input);
  const Wrench impulse = inWorldAboutCom(input.applied, state.q_WB);
  EXPECT_LE(difference(copies.copies()[0].state.P_WB, state.P_WB + impulse.f_F), 4 * kEps);
  EXPECT_LE(difference(copies.copies()[0].state.L_WBcm_W, state.L_WBcm_W + impulse.t_Q_F),
            4 * kEps);
}

}  // namespace
}  // namespace rigid_body_sim

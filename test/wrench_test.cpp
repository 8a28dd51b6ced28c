#include "rigid_body_sim/wrench.hpp"

#include "generic.hpp"

namespace rigid_body_sim {
namespace {

const Wrench kWrench = {{1.3, -0.7, 2.1}, {0.4, 0.9, -1.6}};
const Vector3d kArm(0.8, -1.2, 0.5);

/// A cross product and a sum, each of three terms of size up to 3.
constexpr double kTolerance = 16 * kEps;

TEST(Wrench, MovingThePointAddsArmCrossForce) {
  const Wrench moved = aboutPoint({{0, 0, 5}, {1, 1, 1}}, {2, 0, 0});  // x cross z is -y
  EXPECT_EQ(moved.f_F, Vector3d(0, 0, 5));
  EXPECT_EQ(moved.t_Q_F, Vector3d(1, 1 - 10, 1));
}

TEST(Wrench, MovingThePointThereAndBackChangesNothing) {
  const Wrench back = aboutPoint(aboutPoint(kWrench, kArm), -kArm);
  EXPECT_EQ(back.f_F, kWrench.f_F);
  EXPECT_LE(difference(back.t_Q_F, kWrench.t_Q_F), kTolerance);
}

TEST(Wrench, MovingInTwoStepsIsMovingByTheirSum) {
  const Vector3d second(-0.3, 0.6, 1.1);
  const Wrench at_once = aboutPoint(kWrench, kArm + second);
  const Wrench in_steps = aboutPoint(aboutPoint(kWrench, kArm), second);
  EXPECT_LE(difference(in_steps.t_Q_F, at_once.t_Q_F), kTolerance);
}

TEST(Wrench, MovingAlongTheForceChangesNoTorque) {
  const Wrench moved = aboutPoint(kWrench, 3 * kWrench.f_F);
  EXPECT_LE(difference(moved.t_Q_F, kWrench.t_Q_F), 3 * kTolerance);
}

TEST(Wrench, DoesTheSamePowerWhateverThePointItIsAbout) {
  // f.v + t.w with the velocity of the point, v_R = v_Q + w x p_QR.
  const Vector3d v_Q(0.3, -0.9, 0.4), w(1.2, 0.5, -0.8);
  const double power = kWrench.f_F.dot(v_Q) + kWrench.t_Q_F.dot(w);
  const Wrench about_R = aboutPoint(kWrench, kArm);
  const Vector3d v_R = v_Q + w.cross(-kArm);
  EXPECT_NEAR(about_R.f_F.dot(v_R) + about_R.t_Q_F.dot(w), power, 2 * kTolerance);
}

TEST(MomentAboutPoint, IsArmCrossVector) {
  EXPECT_EQ(momentAboutPoint({1, 2, 3}, {4, 5, 6}), Vector3d(-3, 6, -3));
}

TEST(MomentAboutPoint, IsUnchangedWhenTheForceSlidesAlongItsLine) {
  const Vector3d force(0.7, -0.2, 1.5);
  EXPECT_LE(difference(momentAboutPoint(kArm + 4 * force, force), momentAboutPoint(kArm, force)),
            8 * kTolerance);
}

TEST(MomentAboutAxis, IsThePartOfTheMomentAlongTheAxis) {
  // A force along y at x = 2: about an axis along z, arm times force.
  EXPECT_EQ(momentAboutAxis({2, 0, 7}, {0, 3, 0}, {0, 0, 5}), Vector3d(0, 0, 6));
}

TEST(MomentAboutAxis, NeedsOnlyWhatIsPerpendicularToTheAxis) {
  // The founding text's second form: r_perp x F_perp.
  const Vector3d direction(0.6, -1.1, 0.4), force(0.7, -0.2, 1.5);
  const Vector3d u = direction.normalized();
  const Vector3d arm_across = kArm - kArm.dot(u) * u;
  const Vector3d force_across = force - force.dot(u) * u;
  EXPECT_LE(difference(momentAboutAxis(kArm, force, direction), arm_across.cross(force_across)),
            kTolerance);
}

TEST(MomentAboutAxis, IsTheSameForEveryPointOfTheAxisAndLengthOfTheDirection) {
  const Vector3d direction(0.6, -1.1, 0.4), force(0.7, -0.2, 1.5);
  const Vector3d expected = momentAboutAxis(kArm, force, direction);
  EXPECT_LE(difference(momentAboutAxis(kArm - 2.5 * direction, force, direction), expected),
            4 * kTolerance);
  EXPECT_LE(difference(momentAboutAxis(kArm, force, -40 * direction), expected), kTolerance);
}

TEST(MomentAboutAxis, VanishesForAForceAlongOrThroughTheAxis) {
  const Vector3d direction(0.6, -1.1, 0.4);
  EXPECT_LE(momentAboutAxis(kArm, 3 * direction, direction).norm(), kTolerance);
  EXPECT_LE(momentAboutAxis(2 * direction, {0.7, -0.2, 1.5}, direction).norm(), kTolerance);
}

TEST(AppliedWrench, InWorldAxesKeepsItsForceWhileItsPointTurns) {
  // A quarter turn about z takes the body's x to the world's y; y cross x is -z.
  const Quaterniond quarter(Eigen::AngleAxisd(kPi / 2, Vector3d::UnitZ()));
  const Wrench wrench = inWorldAboutCom({Axes::kWorld, {{5, 0, 0}, {0, 0, 1}}, {2, 0, 0}}, quarter);
  EXPECT_EQ(wrench.f_F, Vector3d(5, 0, 0));
  EXPECT_LE(difference(wrench.t_Q_F, Vector3d(0, 0, 1 - 10)), 10 * 2 * kEps);
}

TEST(AppliedWrench, InBodyAxesTurnsWithTheBody) {
  const Quaterniond quarter(Eigen::AngleAxisd(kPi / 2, Vector3d::UnitZ()));
  const Wrench wrench = inWorldAboutCom({Axes::kBody, {{5, 0, 0}, {0, 3, 0}}, {0, 2, 0}}, quarter);
  EXPECT_LE(difference(wrench.f_F, Vector3d(0, 5, 0)), 5 * 2 * kEps);
  EXPECT_LE(difference(wrench.t_Q_F, Vector3d(-3, 0, -10)), 10 * 2 * kEps);
}

TEST(AppliedWrench, AtAGeneralAttitudeFollowsTheMatrixFormula) {
  const Quaterniond q_WB = genericAttitude();
  const Matrix3d R_WB = q_WB.toRotationMatrix();
  const Wrench in_world = inWorldAboutCom({Axes::kWorld, kWrench, kArm}, q_WB);
  EXPECT_EQ(in_world.f_F, kWrench.f_F);
  EXPECT_LE(difference(in_world.t_Q_F, kWrench.t_Q_F + (R_WB * kArm).cross(kWrench.f_F)),
            kTolerance);
  const Wrench in_body = inWorldAboutCom({Axes::kBody, kWrench, kArm}, q_WB);
  EXPECT_LE(difference(in_body.f_F, R_WB * kWrench.f_F), kTolerance);
  EXPECT_LE(difference(in_body.t_Q_F, R_WB * (kWrench.t_Q_F + kArm.cross(kWrench.f_F))),
            kTolerance);
}

TEST(AppliedWrench, IsTheSameActionInEitherAxesAtTheMoment) {
  const Quaterniond q_WB = genericAttitude();
  const Wrench in_B = {q_WB.conjugate() * kWrench.f_F, q_WB.conjugate() * kWrench.t_Q_F};
  const Wrench from_W = inWorldAboutCom({Axes::kWorld, kWrench, kArm}, q_WB);
  const Wrench from_B = inWorldAboutCom({Axes::kBody, in_B, kArm}, q_WB);
  EXPECT_LE(difference(from_B.f_F, from_W.f_F), kTolerance);
  EXPECT_LE(difference(from_B.t_Q_F, from_W.t_Q_F), kTolerance);
}

}  // namespace
}  // namespace rigid_body_sim

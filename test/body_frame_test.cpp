#include "rigid_body_sim/body_frame.hpp"

#include "generic.hpp"
#include "rigid_body_sim/conserved.hpp"

namespace rigid_body_sim {
namespace {

/// Products of three rotations and a tensor, of numbers up to ten.
constexpr double kTolerance = 128 * kEps;

const Vector3d kVelocity(0.4, -1.1, 0.6);
const Vector3d kSpin(1.3, 0.7, -0.9);  // in link axes

BodyState genericState() {
  return stateOfLink(bodyFrame(genericBody()), genericPose(), kVelocity, kSpin);
}

TEST(BodyFrame, IsTheFrameInWhichTheTensorIsDiagonal) {
  const MassProperties body = genericBody();
  const BodyFrame frame = bodyFrame(body);
  EXPECT_EQ(frame.mass, body.mass);
  EXPECT_EQ(frame.p_LBcm, body.p_FBcm);
  const Matrix3d R_LB = frame.q_LB.toRotationMatrix();
  EXPECT_LE(difference(R_LB * frame.I_BBcm_B.asDiagonal() * R_LB.transpose(), body.I_BBcm_F),
            kTolerance);
  EXPECT_GT(rotationLog(frame.q_LB).norm(), 0.1);  // a frame that is not the link's
}

TEST(BodyFrame, RefusesABodyThatCannotBe) {
  MassProperties body = genericBody();
  body.I_BBcm_F(2, 2) = 9;
  EXPECT_TRUE(contains(refusal([&] { bodyFrame(body); }), {"triangle inequality"}));
}

TEST(StateOfLink, PutsTheCentreOfMassWhereTheLinkCarriesIt) {
  EXPECT_LE(difference(genericState().p_WBcm, genericPose() * genericBody().p_FBcm), kTolerance);
}

TEST(StateOfLink, HasTheMomentaOfTheFullTensor) {
  const Matrix3d R_WL = genericPose().linear();
  const Vector3d L_W = R_WL * (genericBody().I_BBcm_F * kSpin);
  EXPECT_EQ(genericState().P_WB, genericBody().mass * kVelocity);
  EXPECT_LE(difference(genericState().L_WBcm_W, L_W), kTolerance);
}

TEST(StateOfLink, HasTheEnergyOfTheFullTensor) {
  const BodyFrame frame = bodyFrame(genericBody());
  const double expected =
      0.5 * frame.mass * kVelocity.squaredNorm() + 0.5 * kSpin.dot(genericBody().I_BBcm_F * kSpin);
  EXPECT_NEAR(kineticEnergy(genericState(), frame.mass, frame.I_BBcm_B), expected,
              kTolerance * expected);
}

TEST(LinkMotion, GivesBackThePoseAndTheSpin) {
  const LinkMotion link = linkMotion(bodyFrame(genericBody()), genericState());
  EXPECT_LE(difference(link.p_WL, genericPose().translation()), kTolerance);
  EXPECT_LE(difference(link.q_WL.toRotationMatrix(), genericPose().linear()), kTolerance);
  EXPECT_LE(difference(link.w_WL_L, kSpin), kTolerance);
}

TEST(LinkMotion, HasTheVelocityOfTheLinksOriginInLinkAxes) {
  const Matrix3d R_WL = genericPose().linear();
  const Vector3d p_BcmL_W = -(R_WL * genericBody().p_FBcm);
  const Vector3d v_WL = kVelocity + (R_WL * kSpin).cross(p_BcmL_W);
  const LinkMotion link = linkMotion(bodyFrame(genericBody()), genericState());
  EXPECT_LE(difference(link.v_WL_L, R_WL.transpose() * v_WL), kTolerance);
  EXPECT_GT((v_WL - kVelocity).norm(), 0.1);  // else the offset would show nothing
}

TEST(LinkMotion, HasTheVelocityThatMovesTheLink) {
  // Positions a little before and after, by central differences extrapolated once; the body spins
  // about a principal axis, so that its motion is a steady screw.
  const BodyFrame frame = bodyFrame(genericBody());
  BodyState body = genericState();
  body.L_WBcm_W = body.q_WB * Vector3d(0, 1.5, 0);
  const Vector3d w_WB = angularVelocity(body, frame.I_BBcm_B);
  const auto origin = [&](double t) {
    BodyState moved = body;
    moved.p_WBcm += t * velocity(body, frame.mass);
    moved.q_WB = rotationExp(t * w_WB) * body.q_WB;
    return linkMotion(frame, moved).p_WL;
  };
  const auto slope = [&](double h) { return Vector3d((origin(h) - origin(-h)) / (2 * h)); };
  const double h = 1e-3;
  const Vector3d v_WL = (4 * slope(h / 2) - slope(h)) / 3;
  const LinkMotion link = linkMotion(frame, body);
  EXPECT_LE(difference(link.q_WL * link.v_WL_L, v_WL), 16 * kEps / h);
}

TEST(LinkMotion, OfADiagonalBodyAtItsOriginIsTheState) {
  MassProperties body;
  body.mass = 2;
  body.I_BBcm_F = Vector3d(1, 2, 3).asDiagonal();
  const BodyFrame frame = bodyFrame(body);
  const BodyState state = {{1, 2, 3}, genericAttitude(), {2, 4, 6}, {0, 0, 0}};
  const LinkMotion link = linkMotion(frame, state);
  EXPECT_EQ(link.p_WL, state.p_WBcm);
  EXPECT_EQ(link.q_WL.coeffs(), state.q_WB.coeffs());
  EXPECT_LE(difference(link.q_WL * link.v_WL_L, Vector3d(1, 2, 3)), kTolerance);
}

}  // namespace
}  // namespace rigid_body_sim

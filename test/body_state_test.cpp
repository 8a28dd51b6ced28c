#include "rigid_body_sim/body_state.hpp"

#include "generic.hpp"

namespace rigid_body_sim {
namespace {

const Vector3d kMoments(0.6, 1.7, 2.2);

BodyState genericState() {
  return {{1, -2, 3}, genericAttitude(), {0.9, -0.3, 1.4}, {-0.7, 1.1, 0.5}};
}

TEST(BodyState, VelocityIsMomentumOverMass) {
  EXPECT_EQ(velocity(genericState(), 0.5), Vector3d(1.8, -0.6, 2.8));
}

TEST(BodyState, AngularVelocityIsTheInverseTensorTimesAngularMomentum) {
  const BodyState body = genericState();
  const Matrix3d R = body.q_WB.toRotationMatrix();
  const Matrix3d I_W = R * kMoments.asDiagonal() * R.transpose();
  const Vector3d w_WB = angularVelocity(body, kMoments);
  // Two rotations and a quotient by a moment down to 0.6.
  EXPECT_LE(difference(I_W * w_WB, body.L_WBcm_W), 16 * kEps);
  EXPECT_LE(difference(R * angularVelocityInBody(body, kMoments), w_WB), 16 * kEps);
}

TEST(BodyState, AngularVelocityIsParallelToAngularMomentumOnAPrincipalAxisOnly) {
  BodyState body = genericState();
  body.L_WBcm_W = body.q_WB * Vector3d(0, 3.4, 0);
  EXPECT_LE(difference(angularVelocity(body, kMoments), body.L_WBcm_W / 1.7), 16 * kEps);
  body.L_WBcm_W = genericState().L_WBcm_W;
  EXPECT_GT(angularVelocity(body, kMoments).cross(body.L_WBcm_W).norm(), 0.1);
}

TEST(BodyState, VelocityOfAPointIsThatOfTheCentrePlusSpinCrossArm) {
  EXPECT_EQ(velocityOfPoint({1, 2, 3}, {0, 0, 2}, {5, 0, 7}), Vector3d(1, 12, 3));
}

TEST(BodyState, VelocityOfAPointIsTheDerivativeOfItsPosition) {
  // p = R r + x of the founding text's section 1; central differences of a steady screw motion,
  // extrapolated once: error of order h^4 |w|^5 r / 30 plus kEps / h.
  const BodyState body = genericState();
  const Vector3d v = velocity(body, 2.5), w = angularVelocity(body, kMoments), r_B(0.4, 1.3, -0.8);
  const auto position = [&](double t) {
    const Vector3d p = rotationExp(t * w) * (body.q_WB * r_B) + (body.p_WBcm + t * v);
    return p;
  };
  const auto slope = [&](double h) { return Vector3d((position(h) - position(-h)) / (2 * h)); };
  const double h = 1e-3;
  const Vector3d derivative = (4 * slope(h / 2) - slope(h)) / 3;
  EXPECT_LE(difference(velocityOfPoint(v, w, body.q_WB * r_B), derivative), 16 * kEps / h);
}

TEST(BodyState, IsFiniteOnlyIfEveryComponentIs) {
  EXPECT_TRUE(isFinite(genericState()));
  for (const double bad : {kInf, -kInf, kNaN}) {
    for (int i = 0; i < 3; ++i) {
      for (Vector3d BodyState::*part :
           {&BodyState::p_WBcm, &BodyState::P_WB, &BodyState::L_WBcm_W}) {
        BodyState body = genericState();
        (body.*part)(i) = bad;
        EXPECT_FALSE(isFinite(body));
      }
    }
    for (int i = 0; i < 4; ++i) {
      BodyState body = genericState();
      body.q_WB.coeffs()(i) = bad;
      EXPECT_FALSE(isFinite(body));
    }
  }
}

TEST(Bodies, KeepTheStateTheyAreGivenAndLeaveTheOthers) {
  Bodies bodies(3);
  for (int i = 0; i < 3; ++i) bodies.setState(i, {});
  bodies.setState(1, genericState());
  EXPECT_TRUE(sameBits(bodies.state(1), genericState()));
  EXPECT_TRUE(sameBits(bodies.state(0), BodyState()));
  EXPECT_TRUE(sameBits(bodies.state(2), BodyState()));
}

TEST(Bodies, AreStoredColumnByColumn) {
  Bodies bodies(3);
  bodies.p_WBcm << 1, 2, 3, 4, 5, 6, 7, 8, 9;  // a row a body
  EXPECT_EQ(bodies.p_WBcm.data()[1], 4);       // the second body's x follows the first's
  EXPECT_EQ(bodies.state(2).p_WBcm, Vector3d(7, 8, 9));
}

TEST(BodyState, MovesByTheSumOfAllWaysRoundedOnce) {
  // Position and rest together are the exact sum, but for half a rounding of each way as it is
  // added to the rest: of ways far below the position's last bit, and of some far beyond it.
  for (const double size : {1e-12, 1.0, 1e13}) {
    BodyState body;
    body.p_WBcm = {1e3, -7e2, 0.3};
    using Exactly = Eigen::Matrix<long double, 3, 1>;
    const Vector3d start = body.p_WBcm;
    Exactly ways = Exactly::Zero();
    for (int i = 0; i < 1000; ++i) {
      const Vector3d way = size * Vector3d(1.0 / 3, -1.0 / 7, 1.0 / 11) * (i % 3 == 0 ? -0.5 : 1);
      move(body, way);
      ways += way.cast<long double>();
    }
    const Exactly rest = (start.cast<long double>() - body.p_WBcm.cast<long double>()) + ways;
    for (int k = 0; k < 3; ++k) {
      EXPECT_LE(std::abs(body.p_low(k)), 0.5 * kEps * std::abs(body.p_WBcm(k))) << size;
      EXPECT_NEAR(body.p_low(k), static_cast<double>(rest(k)), 1000 * 0.5 * kEps * size / 3);
    }
  }
}

}  // namespace
}  // namespace rigid_body_sim

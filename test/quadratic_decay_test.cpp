#include "effects/quadratic_decay.hpp"

#include "generic.hpp"

namespace rigid_body_sim {
namespace {

/// An inverse mass matrix of no special shape [1/kg]; its eigenvalues are about 0.2, 0.7 and 1.6.
Matrix3d inverseMass() {
  const Matrix3d R = Quaterniond(0.2, 0.7, -0.4, 0.5).normalized().toRotationMatrix();
  return R * Vector3d(0.2, 1.6, 0.7).asDiagonal() * R.transpose();
}

/// P' = -c |u| u with u = R A R^T P - wind for a time, by the classical Runge-Kutta method.
Vector3d reference(Vector3d P, const Matrix3d& A_W, const Vector3d& wind, double c, double time) {
  const auto rate = [&](const Vector3d& at) {
    const Vector3d u = A_W * at - wind;
    return Vector3d(-c * u.norm() * u);
  };
  const int steps = 4000;
  const double h = time / steps;
  for (int i = 0; i < steps; ++i) {
    const Vector3d k1 = rate(P), k2 = rate(P + 0.5 * h * k1), k3 = rate(P + 0.5 * h * k2),
                   k4 = rate(P + h * k3);
    P += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
  }
  return P;
}

const Vector3d kMomentum(2.1, -3.3, 1.4);
const Vector3d kWind(0.7, 0.4, -0.9);

TEST(QuadraticDecay, IsExactForAPlainMass) {
  const double m = 1.3, c = 0.6, h = 2;
  const Vector3d u = kMomentum / m - kWind;
  const Vector3d expected = m * (kWind + u / (1 + c / m * u.norm() * h));
  const Vector3d braked = brakedMomentum(kMomentum, m, kWind, c * h);
  EXPECT_LT(difference(braked, expected), 1e-14);
  const Matrix3d A = Matrix3d::Identity() / m;
  EXPECT_LT(difference(braked, reference(kMomentum, A, kWind, c, h)), 1e-12);
}

TEST(QuadraticDecay, OfAMassMatrixThatIsANumberIsThatOfTheMass) {
  const Matrix3d A = Matrix3d::Identity() / 1.3;
  EXPECT_LT(difference(brakedMomentum(kMomentum, A, genericAttitude(), kWind, 1.2),
                       brakedMomentum(kMomentum, 1.3, kWind, 1.2)),
            1e-14);
}

TEST(QuadraticDecay, OfAMassMatrixIsOfSecondOrder) {
  const Quaterniond q = genericAttitude();
  const Matrix3d A_W = q.toRotationMatrix() * inverseMass() * q.toRotationMatrix().transpose();
  const double c = 0.6, time = 2;
  const Vector3d exact = reference(kMomentum, A_W, kWind, c, time);
  std::vector<double> errors;
  for (const int steps : {16, 32, 64}) {
    Vector3d P = kMomentum;
    for (int i = 0; i < steps; ++i)
      P = brakedMomentum(P, inverseMass(), q, kWind, c * time / steps);
    errors.push_back(difference(P, exact));
  }
  EXPECT_NEAR(std::log2(errors[0] / errors[1]), 2, 0.1);
  EXPECT_NEAR(std::log2(errors[1] / errors[2]), 2, 0.05);
}

TEST(QuadraticDecay, OfSpinIsThatOfAMomentumWithTheInverseTensorInStillAir) {
  const Vector3d I(0.6, 1.4, 1.7);
  const Matrix3d A = I.cwiseInverse().asDiagonal();
  const Quaterniond q = genericAttitude();
  EXPECT_LT(difference(brakedSpin(kMomentum, I, q, 0.8),
                       brakedMomentum(kMomentum, A, q, Vector3d::Zero(), 0.8)),
            1e-14);
  const Vector3d sphere(1.4, 1.4, 1.4);
  EXPECT_LT(difference(brakedSpin(kMomentum, sphere, q, 0.8),
                       brakedMomentum(kMomentum, 1.4, Vector3d::Zero(), 0.8)),
            1e-15);
}

TEST(QuadraticDecay, NeverTurnsAVelocityRoundNorMakesItFaster) {
  Sampler sampler(3);
  for (int n = 0; n < 2000; ++n) {
    const Quaterniond q = sampler.attitude();
    const Matrix3d R = q.toRotationMatrix();
    const Vector3d I =
        Vector3d(1, 1, 1) + Vector3d(sampler.between(0, 1e-3), sampler.between(0, 1), 1.5);
    const Vector3d L = sampler.vector();
    const double c_h = std::pow(10, sampler.between(-12, 300));
    const Vector3d before = R.transpose() * L;
    const Vector3d after = R.transpose() * brakedSpin(L, I, q, c_h);
    const Vector3d wind = sampler.vector();
    const Matrix3d A = R * I.cwiseInverse().asDiagonal() * R.transpose();
    const Vector3d u = R.transpose() * (R * A * R.transpose() * L - wind);
    const Vector3d left =
        R.transpose() * (R * A * R.transpose() * brakedMomentum(L, A, q, wind, c_h) - wind);
    const auto axes = Eigen::SelfAdjointEigenSolver<Matrix3d>(A).eigenvectors();
    const Vector3d u_axes = axes.transpose() * u, left_axes = axes.transpose() * left;
    for (int i = 0; i < 3; ++i) {
      const double f = after(i) / before(i), g = left_axes(i) / u_axes(i);
      // Rounding of the way there and back, relative to the whole.
      const double tiny = 8 * kEps * L.norm() / std::abs(before(i));
      const double tiny_wind = 32 * kEps * (L.norm() + wind.norm()) / std::abs(u_axes(i));
      ASSERT_GE(f, -tiny);
      ASSERT_LE(f, 1 + tiny);
      ASSERT_GE(g, -tiny_wind);
      ASSERT_LE(g, 1 + tiny_wind);
    }
    ASSERT_GE(brakedMomentum(L, 0.7, Vector3d::Zero(), c_h).dot(L), 0);
  }
}

TEST(QuadraticDecay, LeavesWhatRestsInTheAirAtRest) {
  const Vector3d none = Vector3d::Zero();
  EXPECT_TRUE(brakedMomentum(none, 2, none, 1e9).isZero(0));
  EXPECT_TRUE(brakedMomentum(none, inverseMass(), genericAttitude(), none, 1e9).isZero(0));
  EXPECT_TRUE(brakedSpin(none, Vector3d(1, 2, 2.5), genericAttitude(), 1e9).isZero(0));
}

TEST(QuadraticDecay, FastestRateIsTwiceTheSpeedsForAPlainMass) {
  const Vector3d u(1, -2, 2);
  EXPECT_NEAR(fastestDecay(u, Matrix3d::Identity() / 4, 0.5), 2 * 0.5 * 3 / 4, 1e-15);
  EXPECT_EQ(fastestDecay(Vector3d::Zero(), Matrix3d::Identity(), 1), 0);
}

TEST(QuadraticDecay, FastestRateIsTheLargestEigenvalueOfTheLinearisedMotion) {
  const Vector3d u(1, -2, 0.7);
  const double c = 0.5, d = 1e-6;
  Matrix3d slope;  // of c A |u| u, by central differences
  for (int k = 0; k < 3; ++k) {
    const Vector3d step = d * Vector3d::Unit(k);
    slope.col(k) = inverseMass() * c *
                   ((u + step).norm() * (u + step) - (u - step).norm() * (u - step)) / (2 * d);
  }
  const double largest = slope.eigenvalues().real().maxCoeff();
  EXPECT_NEAR(fastestDecay(u, inverseMass(), c), largest, 1e-9);
}

}  // namespace
}  // namespace rigid_body_sim

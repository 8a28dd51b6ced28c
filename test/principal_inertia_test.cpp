// The part of mass_properties.hpp that diagonalises and judges tensors.
#include <algorithm>
#include <array>
#include <cmath>

#include "generic.hpp"

namespace rigid_body_sim {
namespace {

MassProperties bodyWith(const Vector3d& moments) {
  MassProperties body = genericBody();
  body.I_BBcm_F = moments.asDiagonal();
  return body;
}

Matrix3d turned(const Vector3d& moments, const Quaterniond& q) {
  const Matrix3d R = q.toRotationMatrix();
  const Matrix3d I = R * moments.asDiagonal() * R.transpose();
  return 0.5 * (I + I.transpose());
}

TEST(PrincipalInertia, AscendsAndRebuildsTheTensor) {
  Sampler sample(11);
  for (int i = 0; i < 500; ++i) {
    const double scale = std::exp2(sample.between(-40, 40));
    const Vector3d moments = scale * (sample.vector() + Vector3d::Constant(1.1));
    const Matrix3d I = turned(moments, sample.attitude());
    const PrincipalInertia principal = principalInertia(I);
    const Vector3d& found = principal.I_BBcm_B;
    EXPECT_LE(found(0), found(1));
    EXPECT_LE(found(1), found(2));
    EXPECT_NEAR(principal.q_FB.norm(), 1, 2 * kEps);
    // The solver is backward stable; measured: 5 kEps.
    EXPECT_LE(difference(turned(found, principal.q_FB), I), 16 * kEps * I.norm());
  }
}

TEST(PrincipalInertia, FindsTheMomentsOfATensorWithKnownOnes) {
  const Vector3d moments(0.6, 1.7, 2.2);
  const PrincipalInertia principal = principalInertia(turned(moments, genericAttitude()));
  EXPECT_LE(difference(principal.I_BBcm_B, moments), 8 * kEps * 2.2);
}

TEST(PrincipalInertia, KeepsTheSmallMomentOfARod) {
  // A closed-form cubic solver would be off by the root of kEps here.
  const Vector3d moments(1e-6, 1, 1.0000005);
  const PrincipalInertia principal = principalInertia(turned(moments, genericAttitude()));
  EXPECT_NEAR(principal.I_BBcm_B(0), 1e-6, 8 * kEps);
}

TEST(PrincipalInertia, TakesADiagonalTensorAsItStands) {
  const Vector3d moments(0.1, 0.2, 0.27);  // none of them a round binary number
  std::array<int, 3> order = {0, 1, 2};
  do {
    const Vector3d permuted(moments(order[0]), moments(order[1]), moments(order[2]));
    const Matrix3d I = permuted.asDiagonal();
    const PrincipalInertia principal = principalInertia(I);
    EXPECT_EQ(principal.I_BBcm_B, moments);
    EXPECT_LE(difference(turned(moments, principal.q_FB), I), 4 * kEps * 0.27);
  } while (std::next_permutation(order.begin(), order.end()));
}

TEST(PrincipalInertia, OfAnAscendingDiagonalTensorHasNoRotation) {
  for (const Vector3d& moments : {Vector3d(1, 2, 3), Vector3d(1, 1, 2), Vector3d(1, 2, 2),
                                  Vector3d(7, 7, 7), Vector3d(1e-9, 1, 1)}) {
    const PrincipalInertia principal = principalInertia(moments.asDiagonal());
    EXPECT_EQ(principal.I_BBcm_B, moments);
    EXPECT_EQ(principal.q_FB.coeffs(), Quaterniond::Identity().coeffs());
  }
}

TEST(PrincipalInertia, TakesTheAxesNearestToTheFrame) {
  // Axes turned by 0.3 rad: of the four right-handed choices of signs, that turn itself.
  const Quaterniond q = rotationExp(0.3 * Vector3d(0.48, -0.6, 0.64));
  const PrincipalInertia principal = principalInertia(turned({1, 2, 3}, q));
  EXPECT_LE(angleBetween(principal.q_FB, q), 16 * kEps);
}

TEST(PrincipalInertia, TurnsNoFurtherThanAThirdOfATurn) {
  // The best of four sign choices of any three perpendicular axes.
  Sampler sample(13);
  for (int i = 0; i < 500; ++i) {
    const PrincipalInertia principal = principalInertia(turned({1, 2, 3}, sample.attitude()));
    EXPECT_LE(rotationLog(principal.q_FB).norm(), 2 * kPi / 3 + 16 * kEps);
  }
}

TEST(Invalidity, IsEmptyForBodiesThatCanBe) {
  EXPECT_EQ(invalidity(genericBody()), "");
  for (const Vector3d& moments :
       {Vector3d(1, 2, 3), Vector3d(1e-12, 1, 1), Vector3d(3, 1, 2),
        Vector3d(1e-200, 1e-200, 1e-200), Vector3d(1e160, 1e160, 1e160), Vector3d(1, 1, 2.0000019)})
    EXPECT_EQ(invalidity(bodyWith(moments)), "") << moments.transpose();
}

TEST(Invalidity, AllowsTheRoundingOfAChangeOfFrame) {
  Sampler sample(17);
  for (int i = 0; i < 500; ++i) {
    Isometry3d X = Isometry3d::Identity();
    X.linear() = sample.attitude().toRotationMatrix();
    EXPECT_EQ(invalidity(expressedIn(X, bodyWith({1e-3, 1, 1.0009}))), "");
  }
}

TEST(Invalidity, AllowsSixteenUlpsOfAsymmetry) {
  // Sixteen ulps of the largest element, 2.1, is what invalidity says a sum of parts may be off by.
  // Half an ulp of the element that is spoilt is below 0.1 of these.
  const double ulp = kEps * 2.1;
  for (const double sign : {1.0, -1.0}) {
    MassProperties body = genericBody();
    body.I_BBcm_F(0, 1) += sign * 15 * ulp;
    EXPECT_EQ(invalidity(body), "");
    body = genericBody();
    body.I_BBcm_F(0, 1) += sign * 17 * ulp;
    EXPECT_TRUE(contains(invalidity(body), {"not symmetric"}));
  }
}

TEST(Invalidity, AllowsAMillionthOfTheTriangleInequality) {
  for (const Quaterniond& q : {Quaterniond::Identity(), genericAttitude()}) {
    for (const double scale : {1e-9, 1.0, 1e9}) {
      MassProperties body = genericBody();
      body.I_BBcm_F = scale * turned({0.7, 1.3, 2 * (1 + 0.9e-6)}, q);
      EXPECT_EQ(invalidity(body), "");
      body.I_BBcm_F = scale * turned({0.7, 1.3, 2 * (1 + 1.1e-6)}, q);
      EXPECT_TRUE(contains(invalidity(body), {"triangle inequality"}));
    }
  }
}

TEST(Invalidity, NamesWhatIsWrong) {
  struct Row {
    const char* what;
    void (*spoil)(MassProperties&);
    std::vector<std::string> parts;
  };
  const std::vector<Row> rows = {
      {"no mass", [](auto& b) { b.mass = 0; }, {"mass is 0 kg", "positive and finite"}},
      {"negative mass", [](auto& b) { b.mass = -2; }, {"mass is -2 kg"}},
      {"NaN mass", [](auto& b) { b.mass = kNaN; }, {"mass is nan"}},
      {"infinite mass", [](auto& b) { b.mass = kInf; }, {"mass is inf"}},
      {"NaN centre", [](auto& b) { b.p_FBcm(1) = kNaN; }, {"centre of mass", "not finite"}},
      {"NaN tensor", [](auto& b) { b.I_BBcm_F(1, 2) = kNaN; }, {"tensor", "not finite"}},
      {"infinite tensor", [](auto& b) { b.I_BBcm_F(0, 0) = kInf; }, {"tensor", "not finite"}},
      {"not symmetric", [](auto& b) { b.I_BBcm_F(0, 1) += 1e-9; }, {"not symmetric"}},
      {"zero tensor", [](auto& b) { b.I_BBcm_F.setZero(); }, {"(0, 0, 0)", "must be positive"}},
      {"zero moment",
       [](auto& b) { b.I_BBcm_F = Vector3d(1, 0, 1).asDiagonal(); },
       {"(0, 1, 1) kg m^2", "must be positive"}},
      {"denormal moment",
       [](auto& b) { b.I_BBcm_F = Vector3d(1e-310, 1, 1).asDiagonal(); },
       {"must be positive"}},
      {"negative moment",
       [](auto& b) { b.I_BBcm_F = Vector3d(1, 1, -0.5).asDiagonal(); },
       {"-0.5", "must be positive"}},
      {"indefinite though its diagonal is positive",
       [](auto& b) { b.I_BBcm_F(0, 1) = b.I_BBcm_F(1, 0) = 2.5; },
       {"must be positive"}},
      {"triangle inequality",
       [](auto& b) { b.I_BBcm_F = Vector3d(1, 3, 1).asDiagonal(); },
       {"triangle inequality: 1 + 1 < 3"}},
      {"a little over the slack",
       [](auto& b) { b.I_BBcm_F = Vector3d(1, 1, 2.000003).asDiagonal(); },
       {"triangle inequality"}},
  };
  for (const Row& row : rows) {
    MassProperties body = genericBody();
    row.spoil(body);
    EXPECT_TRUE(contains(invalidity(body), row.parts)) << row.what;
  }
}

TEST(Invalidity, ParticlesInALineHaveNoMomentAboutIt) {
  // In exact numbers the smallest moment is zero; in doubles it is noise of either sign.
  Sampler sample(19);
  for (int i = 0; i < 200; ++i) {
    const Vector3d from = sample.vector(), along = sample.vector();
    const MassProperties body =
        massPropertiesOfParticles({{1.3, from}, {0.4, from + along}, {2.1, from + 2.7 * along}});
    EXPECT_TRUE(contains(invalidity(body), {"must be positive"}));
  }
}

TEST(NearestValidInertia, LeavesAValidTensorAlone) {
  const Matrix3d I = genericBody().I_BBcm_F;
  EXPECT_LE(difference(nearestValidInertia(I), I), 16 * kEps * I.norm());
}

TEST(NearestValidInertia, SetsTheNegativeSecondMomentToZero) {
  // Moments (1, 1, 3): second moments (1.5, 1.5, -0.5); without the last (1.5, 1.5, 3).
  const Matrix3d I = nearestValidInertia(turned({1, 1, 3}, genericAttitude()));
  EXPECT_LE(difference(I, turned({1.5, 1.5, 3}, genericAttitude())), 64 * kEps);
  MassProperties body = genericBody();
  body.I_BBcm_F = I;
  EXPECT_EQ(invalidity(body), "");
}

TEST(NearestValidInertia, OfPositiveMomentsAlwaysPasses) {
  Sampler sample(23);
  int changed = 0;
  for (int i = 0; i < 500; ++i) {
    const Matrix3d I = turned(sample.vector() + Vector3d::Constant(1.01), sample.attitude());
    MassProperties body = genericBody();
    body.I_BBcm_F = I;
    changed += invalidity(body).empty() ? 0 : 1;
    body.I_BBcm_F = nearestValidInertia(I);
    EXPECT_EQ(invalidity(body), "");
  }
  EXPECT_GT(changed, 100);
}

}  // namespace
}  // namespace rigid_body_sim

#include "rigid_body_sim/mass_properties.hpp"

#include <array>
#include <cmath>

#include "generic.hpp"

namespace rigid_body_sim {
namespace {

/// Sums over a few parts: some ten products and additions an element, each off by kEps / 2.
constexpr double kSumRounding = 16 * kEps;

const std::vector<Particle>& fiveParticles() {
  static const std::vector<Particle> particles = {{0.7, {0.3, -1.1, 0.4}},
                                                  {1.9, {-0.8, 0.2, 1.3}},
                                                  {0.4, {1.5, 0.9, -0.6}},
                                                  {2.2, {-0.1, -0.7, -1.2}},
                                                  {1.1, {0.6, 1.4, 0.5}}};
  return particles;
}

/// Sum of m r x (w x r) = I w, column by column, about `p_FO`: the definition of the tensor,
/// written without any of its elements.
Matrix3d tensorByDefinition(const std::vector<Particle>& particles, const Vector3d& p_FO) {
  Matrix3d I = Matrix3d::Zero();
  for (int i = 0; i < 3; ++i)
    for (const Particle& particle : particles) {
      const Vector3d r = particle.p_FQ - p_FO;
      I.col(i) += particle.mass * r.cross(Vector3d::Unit(i).cross(r));
    }
  return I;
}

TEST(Particles, MassAndCentreAreTheWeightedSums) {
  const MassProperties body = massPropertiesOfParticles({{1, {0, 0, 0}}, {3, {4, -8, 12}}});
  EXPECT_EQ(body.mass, 4);
  EXPECT_EQ(body.p_FBcm, Vector3d(3, -6, 9));
}

TEST(Particles, TwoMassesTurnAsTheReducedMassAtTheirDistance) {
  const Vector3d apart(2, -1, 2);  // 3 m long
  const MassProperties body = massPropertiesOfParticles({{2, {1, 1, 1}}, {6, {3, 0, 3}}});
  const double reduced = 2.0 * 6.0 / 8.0;
  const Vector3d across = apart.cross(Vector3d(0.3, 0.7, -0.2));
  EXPECT_NEAR(inertiaAboutAxis(body, body.p_FBcm, across), reduced * 9, kSumRounding * 13.5);
  EXPECT_NEAR(inertiaAboutAxis(body, body.p_FBcm, apart), 0, kSumRounding * 13.5);
}

TEST(Particles, TensorIsWhatTurnsAngularVelocityIntoAngularMomentum) {
  const MassProperties body = massPropertiesOfParticles(fiveParticles());
  const Matrix3d expected = tensorByDefinition(fiveParticles(), body.p_FBcm);
  EXPECT_LE(difference(body.I_BBcm_F, expected), kSumRounding * expected.norm());
}

TEST(Particles, OffDiagonalElementsAreMinusTheProductsOfInertia) {
  const MassProperties body = massPropertiesOfParticles(fiveParticles());
  double product_xy = 0, product_xz = 0, product_yz = 0, product_xx_yy = 0;
  for (const Particle& particle : fiveParticles()) {
    const Vector3d r = particle.p_FQ - body.p_FBcm;
    product_xy += particle.mass * r.x() * r.y();
    product_xz += particle.mass * r.x() * r.z();
    product_yz += particle.mass * r.y() * r.z();
    product_xx_yy += particle.mass * (r.x() * r.x() + r.y() * r.y());
  }
  const double tolerance = kSumRounding * body.I_BBcm_F.norm();
  EXPECT_NEAR(body.I_BBcm_F(0, 1), -product_xy, tolerance);
  EXPECT_NEAR(body.I_BBcm_F(2, 0), -product_xz, tolerance);
  EXPECT_NEAR(body.I_BBcm_F(1, 2), -product_yz, tolerance);
  EXPECT_NEAR(body.I_BBcm_F(2, 2), product_xx_yy, tolerance);
  EXPECT_GT(std::abs(product_xy), 0.1);  // else the sign would show nothing
}

TEST(Particles, NoneOrOneWithoutMassIsRefused) {
  EXPECT_TRUE(contains(refusal([] { massPropertiesOfParticles({}); }), {"no particle"}));
  for (const double mass : {0.0, -1.0, kInf, kNaN})
    EXPECT_TRUE(contains(refusal([&] {
                           massPropertiesOfParticles({{mass, {1, 2, 3}}});
                         }),
                         {"mass of a particle", "positive and finite"}));
}

TEST(Box, HasTheTextbookMoments) {
  const MassProperties box = solidBox({2, 4, 6}, 0.5);
  EXPECT_EQ(box.mass, 24);
  EXPECT_EQ(box.p_FBcm, Vector3d::Zero());
  EXPECT_EQ(box.I_BBcm_F, Matrix3d(Vector3d(104, 80, 40).asDiagonal()));
}

TEST(Box, IsTheLimitOfALatticeOfParticles) {
  // A lattice of n^3 particles at the cells' centres has sum x^2 = (a^2 / 12)(1 - 1/n^2) an edge.
  const Vector3d size(0.7, 1.1, 1.9);
  const MassProperties box = solidBox(size, 3);
  for (const int n : {2, 8, 16}) {
    std::vector<Particle> lattice;
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j)
        for (int k = 0; k < n; ++k)
          lattice.push_back({box.mass / (n * n * n),
                             (Vector3d(i + 0.5, j + 0.5, k + 0.5) / n - Vector3d::Constant(0.5))
                                 .cwiseProduct(size)});
    const MassProperties body = massPropertiesOfParticles(lattice);
    // Sums of n^3 terms in turn: their rounding grows as the count in the worst case.
    const double tolerance = n * n * n * kEps;
    EXPECT_NEAR(body.mass, box.mass, tolerance * box.mass);
    EXPECT_LE(difference(body.I_BBcm_F, (1 - 1.0 / (n * n)) * box.I_BBcm_F),
              tolerance * box.I_BBcm_F.norm());
  }
}

TEST(Box, IsTheSumOfItsPieces) {
  const Vector3d size(0.7, 1.1, 1.9);
  const std::array<double, 4> cuts = {0, 0.2, 0.65, 1};
  std::vector<MassProperties> pieces;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      const Vector3d low(cuts[i], cuts[j], 0), high(cuts[i + 1], cuts[j + 1], 1);
      Isometry3d X = Isometry3d::Identity();
      X.translation() = (0.5 * (low + high) - Vector3d::Constant(0.5)).cwiseProduct(size);
      pieces.push_back(expressedIn(X, solidBox((high - low).cwiseProduct(size), 3)));
    }
  const MassProperties box = solidBox(size, 3);
  const MassProperties body = combined(pieces);
  EXPECT_NEAR(body.mass, box.mass, kSumRounding * box.mass);
  EXPECT_LE(body.p_FBcm.norm(), kSumRounding * size.norm());
  EXPECT_LE(difference(body.I_BBcm_F, box.I_BBcm_F), kSumRounding * box.I_BBcm_F.norm());
}

TEST(Cylinder, HasTheTextbookMoments) {
  const MassProperties cylinder = solidCylinder(2, 6, 3 / kPi);
  EXPECT_NEAR(cylinder.mass, 72, 72 * 4 * kEps);
  const Vector3d expected(288, 288, 144);  // m (3 r^2 + l^2) / 12 and m r^2 / 2
  EXPECT_LE(difference(cylinder.I_BBcm_F, Matrix3d(expected.asDiagonal())), 288 * 4 * kEps);
  EXPECT_EQ(cylinder.I_BBcm_F(0, 0), cylinder.I_BBcm_F(1, 1));
}

TEST(Cylinder, IsTheSumOfItsDiscs) {
  std::vector<MassProperties> discs;
  double bottom = -0.8;
  for (const double length : {0.3, 0.9, 0.4}) {
    Isometry3d X = Isometry3d::Identity();
    X.translation().z() = bottom + 0.5 * length;
    discs.push_back(expressedIn(X, solidCylinder(0.45, length, 7)));
    bottom += length;
  }
  const MassProperties whole = solidCylinder(0.45, 1.6, 7);
  EXPECT_LE(difference(combined(discs).I_BBcm_F, whole.I_BBcm_F),
            kSumRounding * whole.I_BBcm_F.norm());
}

TEST(Sphere, HasTheTextbookMoment) {
  const MassProperties sphere = solidSphere(1.5, 2 / kPi);
  EXPECT_NEAR(sphere.mass, 9, 9 * 4 * kEps);  // 4/3 pi r^3
  EXPECT_LE(difference(sphere.I_BBcm_F, Matrix3d(8.1 * Matrix3d::Identity())), 8.1 * 8 * kEps);
}

TEST(Sphere, IsTheLimitOfAPileOfDiscs) {
  const double radius = 1.3;
  const MassProperties sphere = solidSphere(radius, 2);
  const auto error = [&](int n) {
    std::vector<MassProperties> discs;
    for (int i = 0; i < n; ++i) {
      Isometry3d X = Isometry3d::Identity();
      X.translation().z() = radius * ((2 * i + 1.0) / n - 1);
      const double disc_radius = std::sqrt(radius * radius - X.translation().squaredNorm());
      discs.push_back(expressedIn(X, solidCylinder(disc_radius, 2 * radius / n, 2)));
    }
    return difference(combined(discs).I_BBcm_F, sphere.I_BBcm_F);
  };
  // The midpoint rule: a quarter of the error for twice the discs. Measured: 1.998.
  EXPECT_NEAR(std::log2(error(16) / error(32)), 2, 0.05);
  EXPECT_LT(error(32), 0.01 * sphere.I_BBcm_F(0, 0));
}

TEST(Shapes, RefuseWhatIsNotPositiveAndFinite) {
  for (const double bad : {0.0, -1.0, kInf, kNaN}) {
    EXPECT_TRUE(contains(refusal([&] { solidBox({1, bad, 1}, 1); }), {"size"}));
    EXPECT_TRUE(contains(refusal([&] { solidBox({1, 1, 1}, bad); }), {"density"}));
    EXPECT_TRUE(contains(refusal([&] { solidSphere(bad, 1); }), {"radius"}));
    EXPECT_TRUE(contains(refusal([&] { solidSphere(1, bad); }), {"density"}));
    EXPECT_TRUE(contains(refusal([&] { solidCylinder(bad, 1, 1); }), {"radius"}));
    EXPECT_TRUE(contains(refusal([&] { solidCylinder(1, bad, 1); }), {"length"}));
    EXPECT_TRUE(contains(refusal([&] { solidCylinder(1, 1, bad); }), {"density"}));
  }
}

TEST(ParallelAxisTheorem, AddsMassTimesSquaredDistanceOfTheAxes) {
  const MassProperties body = genericBody();
  const Vector3d direction(0.3, -0.5, 1.1), p_FQ(-1.4, 0.8, 0.3);
  const double distance = (p_FQ - body.p_FBcm).cross(direction).norm() / direction.norm();
  const double expected =
      inertiaAboutAxis(body, body.p_FBcm, direction) + body.mass * distance * distance;
  EXPECT_NEAR(inertiaAboutAxis(body, p_FQ, direction), expected, kSumRounding * expected);
  EXPECT_GT(distance, 0.5);
}

TEST(ParallelAxisTheorem, GivesTheTensorAboutAnyPoint) {
  const MassProperties body = massPropertiesOfParticles(fiveParticles());
  const Vector3d p_FQ(-1.4, 0.8, 0.3);
  const Matrix3d expected = tensorByDefinition(fiveParticles(), p_FQ);
  EXPECT_LE(difference(inertiaAboutPoint(body, p_FQ), expected), kSumRounding * expected.norm());
}

TEST(InertiaAboutAxis, IsTheSumOfMassTimesSquaredDistanceAndTheLengthOfTheDirectionIsFree) {
  const MassProperties body = massPropertiesOfParticles(fiveParticles());
  const Vector3d direction(0.3, -0.5, 1.1), p_FQ(-1.4, 0.8, 0.3);
  double expected = 0;
  for (const Particle& particle : fiveParticles())
    expected += particle.mass * ((particle.p_FQ - p_FQ).cross(direction)).squaredNorm() /
                direction.squaredNorm();
  EXPECT_NEAR(inertiaAboutAxis(body, p_FQ, direction), expected, kSumRounding * expected);
  EXPECT_NEAR(inertiaAboutAxis(body, p_FQ, -17 * direction), expected, kSumRounding * expected);
}

TEST(InertiaAboutAxis, RefusesADirectionThatIsNone) {
  for (const Vector3d& direction : {Vector3d(0, 0, 0), Vector3d(1, kNaN, 0), Vector3d(0, kInf, 0)})
    EXPECT_TRUE(contains(refusal([&] {
                           inertiaAboutAxis(genericBody(), {0, 0, 0}, direction);
                         }),
                         {"direction"}));
}

TEST(PerpendicularAxisTheorem, GivesALaminasMomentAboutItsNormal) {
  // Particles in one plane, seen from a turned frame; the axes meet in a point of the plane.
  std::vector<Particle> lamina;
  Sampler sample(7);
  for (int i = 0; i < 9; ++i)
    lamina.push_back({sample.between(0.1, 2), {sample.number(), sample.number(), 0}});
  const MassProperties body = expressedIn(genericPose(), massPropertiesOfParticles(lamina));
  const Matrix3d R = genericPose().linear() * Eigen::AngleAxisd(0.7, Vector3d::UnitZ());
  const Vector3d meeting_point = genericPose() * Vector3d(0.4, -0.3, 0);
  const double along_x = inertiaAboutAxis(body, meeting_point, R.col(0));
  const double along_y = inertiaAboutAxis(body, meeting_point, R.col(1));
  const double normal = inertiaAboutAxis(body, meeting_point, R.col(2));
  EXPECT_NEAR(laminaNormalInertia(along_x, along_y), normal, 2 * kSumRounding * normal);
  EXPECT_GT(std::abs(along_x - along_y), 0.1);
}

TEST(PerpendicularAxisTheorem, IsTheLimitOfAThinCylinder) {
  const double length = 1e-9;
  const MassProperties disc = solidCylinder(0.8, length, 5);
  const Vector3d I = disc.I_BBcm_F.diagonal();
  EXPECT_NEAR(laminaNormalInertia(I(0), I(1)), I(2), 4 * kEps * I(2));
}

TEST(ExpressedIn, IsTheTensorOfTheMovedParticles) {
  std::vector<Particle> moved = fiveParticles();
  for (Particle& particle : moved) particle.p_FQ = genericPose() * particle.p_FQ;
  const MassProperties expected = massPropertiesOfParticles(moved);
  const MassProperties body =
      expressedIn(genericPose(), massPropertiesOfParticles(fiveParticles()));
  EXPECT_EQ(body.mass, expected.mass);
  EXPECT_LE(difference(body.p_FBcm, expected.p_FBcm), kSumRounding * expected.p_FBcm.norm());
  EXPECT_LE(difference(body.I_BBcm_F, expected.I_BBcm_F), kSumRounding * expected.I_BBcm_F.norm());
}

TEST(ExpressedIn, ThereAndBackIsTheBody) {
  const MassProperties body = genericBody();
  const MassProperties back =
      expressedIn(genericPose().inverse(), expressedIn(genericPose(), body));
  EXPECT_LE(difference(back.p_FBcm, body.p_FBcm), kSumRounding * 3);  // via 3 m away
  EXPECT_LE(difference(back.I_BBcm_F, body.I_BBcm_F), kSumRounding * body.I_BBcm_F.norm());
}

TEST(Combined, IsTheBodyOfAllParticlesHoweverTheyAreGrouped) {
  const std::vector<Particle>& all = fiveParticles();
  const MassProperties expected = massPropertiesOfParticles(all);
  const MassProperties first = massPropertiesOfParticles({all[3], all[0]});
  const MassProperties rest = massPropertiesOfParticles({all[4], all[2], all[1]});
  for (const MassProperties& body : {combined({first, rest}), combined({rest, first})}) {
    EXPECT_NEAR(body.mass, expected.mass, kSumRounding * expected.mass);
    EXPECT_LE(difference(body.p_FBcm, expected.p_FBcm), kSumRounding);
    EXPECT_LE(difference(body.I_BBcm_F, expected.I_BBcm_F),
              kSumRounding * expected.I_BBcm_F.norm());
  }
}

TEST(Combined, PartsWithoutMassContributeNothing) {
  const MassProperties body = genericBody();
  MassProperties massless;
  massless.p_FBcm << 5, 6, 7;
  massless.I_BBcm_F = Matrix3d::Identity();
  const MassProperties sum = combined({massless, body, massless});
  EXPECT_EQ(sum.mass, body.mass);
  EXPECT_LE(difference(sum.p_FBcm, body.p_FBcm), kEps);
  EXPECT_LE(difference(sum.I_BBcm_F, body.I_BBcm_F), kEps);
  EXPECT_EQ(combined({massless, massless}).mass, 0);
  EXPECT_EQ(combined({massless, massless}).I_BBcm_F, Matrix3d::Zero());
}

}  // namespace
}  // namespace rigid_body_sim

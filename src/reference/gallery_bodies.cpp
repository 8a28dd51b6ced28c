// Bodies of extreme shape, size or make.
#include <algorithm>
#include <iomanip>
#include <sstream>

#include "reference/gallery_rows.hpp"

namespace rigid_body_sim::reference {
namespace {

HardCase thinRod() {
  HardCase one = {"rod_1_to_1e6", "moments a million to one, spinning about itself and across",
                  sceneYaml(bodyYaml("rod", "1", "1.0e-6, 1, 1.0000005", "10, 1, 2")), 5'000};
  one.answer = freeFlight;
  one.must = toRounding();
  one.must[2] = {Measure::kEnergy, 1e-10, "of R^T L an ulp is 2e-10 of the spin about itself"};
  one.source = "Taylor series in extended precision";
  one.elsewhere =
      "Buss' second-order step gains 1e6 times the energy, NO_SQUISH loses the phase (prototypes)";
  one.excuses = onlyExactHolds(Outcome::kInfinite, kFiniteOrder);
  return one;
}

HardCase needle() {
  HardCase one = {"rod_1_to_1e9",
                  "Ixx goes to zero: the spin about itself is 1e-8 of the angular momentum",
                  sceneYaml(bodyYaml("needle", "1", "1.0e-9, 1, 1", "10, 1, 2")), 5'000};
  one.answer = freeTops;
  one.must = toRounding();
  one.must[2] = {Measure::kEnergy, 1e-7, "of R^T L an ulp is 2e-7 of the spin about itself"};
  one.source = "closed form of a top with two equal moments";
  one.elsewhere = "the textbook's psi = G t / I1 - ... loses 6 digits at 1:1e6 (own prototype)";
  one.excuses = onlyExactHolds(Outcome::kInfinite, {"rk4", "rk8", "adaptive"});
  return one;
}

HardCase lamina() {
  HardCase one = {"lamina",
                  "a flat plate: I1 + I2 = I3 to the last bit, the triangle inequality's edge",
                  sceneYaml(bodyYaml("plate", "1", "0.3, 0.9, 1.2", "1, -4, 2")), 5'000};
  one.answer = freeFlight;
  one.must = toRounding();
  one.source = "perpendicular axes theorem; Taylor series in extended precision";
  one.elsewhere =
      "not measured; the triangle inequality without slack refuses plates once they are rounded";
  one.excuses = onlyExactHolds(Outcome::kInfinite, kFiniteOrder);
  return one;
}

HardCase almostSphere() {
  HardCase one = {
      "almost_sphere", "moments apart by 1e-15 of themselves: 1/I1 - 1/I2 is all rounding",
      sceneYaml(bodyYaml("ball", "1", "1, 1.000000000000001, 1.000000000000002", "1, -2, 3")),
      5'000};
  one.answer = freeFlight;
  one.must = toRounding();
  one.source = "Taylor series in extended precision";
  one.elsewhere = "not measured; of the textbook's 1/I1 - 1/I2 no digit is left here";
  one.excuses = {velocityRungsSlip()};
  return one;
}

HardCase masses() {
  const std::string motion = "orientation: [-0.51, 0.62, 0.41, 0.43], linear_velocity: [3, -2, 50]";
  HardCase one = {
      "masses_1e-9_to_1e9", "a microgram beside a million tonnes, falling and tumbling",
      sceneYaml(bodyYaml("mote", "1.0e-9", "1.0e-15, 1.3e-15, 2.1e-15", "1, -2, 1", motion) + ", " +
                    bodyYaml("ship", "1.0e+9", "1.0e+13, 1.3e+13, 2.1e+13", "1, -2, 1", motion),
                "0.02", "gravity: {acceleration: [0, 0, -9.80665]}"),
      500};
  one.answer = freeFall({0, 0, -9.80665});
  one.must = {{Measure::kAttitude, 0, "an ulp each of up to 11 rotations a step", 11 * 0x1p-52, 16},
              {Measure::kPosition, 0, "kicks and drifts, each rounded by half an ulp of 512 m",
               2 * 256 * 0x1p-52},
              {Measure::kMomentum, 0, "a sum a step, of half an ulp", 2 * 0x1p-52},
              momentumToTheBit(),
              unitLength()};
  one.source = "the parabola; Taylor series in extended precision";
  one.elsewhere = "not measured; momenta scale with the mass, and nothing is added across bodies";
  one.excuses = onlyExactHolds(Outcome::kWrong, kSecondAndFourth);
  return one;
}

HardCase sizes() {
  const std::string motion = "orientation: [-0.51, 0.62, 0.41, 0.43]";
  HardCase one = {
      "moments_1e-150_to_1e150", "squares of angular momenta at the ends of the numbers",
      sceneYaml(bodyYaml("tiny", "1", "1.0e-150, 1.3e-150, 2.1e-150", "1, -2, 1") + ", " +
                bodyYaml("huge", "1", "1.0e+150, 1.3e+150, 2.1e+150", "1, -2, 1")),
      5'000};
  one.answer = freeFlight;
  one.must = toRounding();
  one.source = "Taylor series in extended precision";
  one.elsewhere = "products of two moments leave the range of doubles (own prototypes)";
  one.excuses = onlyExactHolds(Outcome::kWrong, kFiniteOrder);
  one.excuses.front() = {{"explicit_euler_velocity"}, Outcome::kWrong, "loses energy and L"};
  one.excuses.push_back({{"semi_implicit_newton"},
                         Outcome::kInfinite,
                         "its 3 x 3 system has a determinant of moments cubed"});
  return one;
}

constexpr int kAlong = 7, kAcross = 3, kUp = 2;
const Vector3d kBrick(0.11, 0.23, 0.17);  // [m]
constexpr double kBrickMass = 1.25;       // [kg]

/// Centre of brick k of the wall, in the wall's axes, from its first brick.
Vector3d placeOf(int k) {
  return Vector3d(k % kAlong, k / kAlong % kAcross, k / kAlong / kAcross).cwiseProduct(kBrick);
}

std::string xyz(const Vector3d& v) {
  std::ostringstream text;
  text << std::setprecision(17) << v.x() << ' ' << v.y() << ' ' << v.z();
  return text.str();
}

/// 42 equal bricks that fill a box, each hung on the one before by a joint that turns by 1.1 rad
/// about one axis after another; a brick's inertial frame turns all of that back.
std::string wallOfBricks() {
  const Vector3d I = solidBox(kBrick, kBrickMass / kBrick.prod()).I_BBcm_F.diagonal();
  std::ostringstream urdf;
  urdf << std::setprecision(17) << "<robot name='wall'>";
  Matrix3d R_WL = Matrix3d::Identity();
  for (int k = 0; k < kAlong * kAcross * kUp; ++k) {
    const Vector3d rpy = 1.1 * Vector3d::Unit(k % 3);
    if (k > 0) {
      const Vector3d step = R_WL.transpose() * (placeOf(k) - placeOf(k - 1));
      urdf << "<joint name='j" << k << "' type='fixed'><origin xyz='" << xyz(step) << "' rpy='"
           << xyz(rpy) << "'/><parent link='brick" << k - 1 << "'/><child link='brick" << k
           << "'/></joint>";
      R_WL = R_WL * Eigen::AngleAxisd(1.1, Vector3d::Unit(k % 3)).toRotationMatrix();
    }
    const Matrix3d I_L = R_WL.transpose() * I.asDiagonal() * R_WL;
    urdf << "<link name='brick" << k << "'><inertial><mass value='" << kBrickMass
         << "'/><inertia ixx='" << I_L(0, 0) << "' ixy='" << I_L(0, 1) << "' ixz='" << I_L(0, 2)
         << "' iyy='" << I_L(1, 1) << "' iyz='" << I_L(1, 2) << "' izz='" << I_L(2, 2)
         << "'/></inertial></link>";
  }
  urdf << "</robot>";
  return urdf.str();
}

/// The box that the bricks fill, by its own formula, turning as the URDF's root does.
Answer solidWall(const Bodies& start, double time_s, double step_s) {
  const Vector3d size = Vector3d(kAlong, kAcross, kUp).cwiseProduct(kBrick);
  Bodies box = start;
  Vector3d I = solidBox(size, kBrickMass / kBrick.prod()).I_BBcm_F.diagonal();
  std::sort(I.data(), I.data() + 3);
  box.mass(0) = kBrickMass * kAlong * kAcross * kUp;
  box.I_BBcm_B.row(0) = I;
  return freeFlight(box, time_s, step_s);
}

HardCase lump() {
  HardCase one = {"urdf_of_42_links",
                  "a box of 42 bricks, a chain of 41 turned joints: one body, that box",
                  "{urdf_parameter: wall, bodies: {brick0: {angular_velocity: [1, -2, 1.5], "
                  "linear_velocity: [0.3, -0.2, 0.1]}}}",
                  5'000};
  one.answer = solidWall;
  one.must = toRounding();
  // 42 rotations of tensors, some 30 operations each: so many ulps of moments and axes.
  one.must[0] = {Measure::kAttitude, 0, "42 lumpings of some 30 roundings each", 0x1p-52, 42 * 30};
  one.must[2] = {Measure::kEnergy, 42 * 30 * 0x1p-52, "the same roundings"};
  one.source = "the uniform box; Taylor series in extended precision";
  one.elsewhere =
      "not measured; importers that drop a joint's or an inertial's rotation tumble another body";
  one.urdf = wallOfBricks();
  one.excuses = onlyExactHolds(Outcome::kWrong, kSecondAndFourth);
  return one;
}

}  // namespace

std::vector<HardCase> extremeBodies() {
  return {thinRod(), needle(), lamina(), almostSphere(), masses(), sizes(), lump()};
}

}  // namespace rigid_body_sim::reference

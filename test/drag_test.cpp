#include <cmath>

#include "effects/atmosphere.hpp"
#include "generic.hpp"
#include "rigid_body_sim/conserved.hpp"

namespace rigid_body_sim {
namespace {

constexpr double kDensity = 1.225;  // [kg/m^3]

// A body of no special shape with 0.5 m^2 and 0.2 m^5, and a ball with 0.3 m^2 and 0.04 m^5.
const std::string kBodies =
    "bodies: {stone: {mass: 2.7, inertia: [1.6, -0.3, 0.2, 2.1, 0.4, 1.8], com: [0.1, -0.2, 0.3], "
    "position: [1, 2, 40], orientation: [-0.5, 0.5, 0.5, 0.5], linear_velocity: [3, -4, 5], "
    "angular_velocity: [1.3, 0.7, -0.9], drag: {drag_area: 0.5, rotational_drag: 0.2}}, "
    "ball: {sphere: {radius: 0.2, density: 90}, position: [0, 0, 25], linear_velocity: [-6, 2, 1], "
    "angular_velocity: [2, -3, 1], drag: {drag_area: 0.3, rotational_drag: 0.04}}}";

constexpr Eigen::Index kBall = 0, kStone = 1;  // by name

std::string sceneText(const std::string& drag, const std::string& more = "") {
  return "{" + more + "effects: {drag: {" + drag + "}}, " + kBodies + "}";
}

/// One falling ball without spin: 2 kg, 0.4 m^2, in a gravity of 9.8 m/s^2.
std::string fallText(const std::string& more, const std::string& drag = "air_density: 1.225") {
  return "{" + more + ", effects: {gravity: {acceleration: [0, 0, -9.8]}, drag: {" + drag +
         ", drag_area: 0.4}}, bodies: {ball: {mass: 2, inertia: [1, 1, 1]}}}";
}

Wrenches wrenchesIn(const Scene& scene) { return Simulator(scene).effectWrenches().at(0).wrenches; }

Scene flown(Scene scene, const std::string& integrator, std::int64_t step_ns) {
  scene.integrator = integrator;
  scene.step_ns = step_ns;
  return scene;
}

Simulator after(const Scene& scene, int steps) {
  Simulator simulator(scene);
  for (int i = 0; i < steps; ++i) simulator.step();
  return simulator;
}

// ---- Forces and torques

TEST(Drag, IsHalfTheDensityTimesTheAreaTimesTheSquareOfTheSpeedAgainstTheMotionThroughTheAir) {
  const Wrenches wrenches = wrenchesIn(sceneFrom(sceneText("air_density: 1.1, wind: [1, 2, -3]")));
  const Vector3d u = Vector3d(3, -4, 5) - Vector3d(1, 2, -3);
  const Vector3d f = wrenches.f_W.row(kStone);
  EXPECT_LT(difference(f, Vector3d(-0.5 * 1.1 * 0.5 * std::sqrt(4 + 36 + 64) * u)), 1e-13);
}

TEST(Drag, IsATorqueAgainstTheSpinAtAnyAttitude) {
  const Wrenches wrenches = wrenchesIn(sceneFrom(sceneText("air_density: 1.1")));
  const Vector3d w_W = Quaterniond(0.5, -0.5, 0.5, 0.5) * Vector3d(1.3, 0.7, -0.9);
  const Vector3d t = wrenches.t_Bcm_W.row(kStone);
  EXPECT_LT(difference(t, Vector3d(-0.5 * 1.1 * 0.2 * std::sqrt(1.69 + 0.49 + 0.81) * w_W)), 1e-14);
}

TEST(Drag, TakesTheDensityAtItsAltitudeAboveZ0OrAboveASphere) {
  const StandardAtmosphere1976 air;
  const Vector3d v(-6, 2, 1);
  const auto force = [&](const std::string& drag) {
    return Vector3d(wrenchesIn(sceneFrom(sceneText(drag))).f_W.row(kBall));
  };
  const double k = 0.5 * 0.3 * v.norm();
  EXPECT_LT(difference(force("atmosphere: us_standard_1976"), Vector3d(-k * air.density(25) * v)),
            1e-13);
  // 3000, 4000 and 12025 from the centre: 13019.24 m.
  const double altitude = std::sqrt(9e6 + 16e6 + 12025.0 * 12025.0) - 2000;
  EXPECT_LT(difference(force("atmosphere: us_standard_1976, "
                             "sea_level: {center: [3000, 4000, -12000], radius: 2000}"),
                       Vector3d(-k * air.density(altitude) * v)),
            1e-13);
}

TEST(Drag, TakesTheShearAtItsAltitude) {
  const auto force = [&](const std::string& drag) {
    return Vector3d(wrenchesIn(sceneFrom(sceneText(drag))).f_W.row(kBall));
  };
  const auto expected = [](double altitude) {
    const Vector3d u = Vector3d(-6, 2, 1) - std::pow(altitude / 10, 0.2) * Vector3d(4, 5, 0);
    return Vector3d(-0.5 * kDensity * 0.3 * u.norm() * u);
  };
  const std::string shear =
      "air_density: 1.225, wind: {velocity: [4, 5, 0], shear: {reference_height: 10, exponent: "
      "0.2}}";
  EXPECT_LT(difference(force(shear), expected(25)), 1e-13);
  EXPECT_LT(
      difference(force(shear + ", sea_level: {center: [0, 0, -1000], radius: 1005}"), expected(20)),
      1e-12);
}

// ---- Pure drag in still air, and in wind

TEST(Drag, AloneIsExactInStillAirAtAnyStep) {
  const Scene scene = sceneFrom(sceneText("air_density: 1.225"));
  const double mass = 4.0 / 3 * kPi * 0.008 * 90, I = 0.4 * mass * 0.04;
  const Vector3d v(-6, 2, 1), w(2, -3, 1);
  for (const std::string integrator : {"exact", "split2", "semi_implicit", "explicit_euler"}) {
    for (const int steps : {1, 7, 300}) {
      const Simulator simulator = after(flown(scene, integrator, 600'000'000 / steps), steps);
      const double t = simulator.time_s();
      const Vector3d v_end = v / (1 + 0.5 * kDensity * 0.3 / mass * v.norm() * t);
      const Vector3d w_end = w / (1 + 0.5 * kDensity * 0.04 / I * w.norm() * t);
      EXPECT_LT(difference(simulator.bodies().v_WBcm(kBall), v_end), 1e-12) << integrator << steps;
      EXPECT_LT(difference(Vector3d(simulator.bodies().L_WBcm_W.row(kBall)), Vector3d(I * w_end)),
                1e-12)
          << integrator << steps;
    }
  }
}

TEST(Drag, AloneCarriesABodyAlongWithTheWindExactly) {
  const Vector3d wind(5, -3, 1);
  const Scene scene = sceneFrom(sceneText("air_density: 1.225, wind: [5, -3, 1]"));
  const Simulator simulator = after(flown(scene, "exact", 10'000'000), 500);
  const Vector3d u = Vector3d(3, -4, 5) - wind;
  const Vector3d u_end = u / (1 + 0.5 * kDensity * 0.5 / 2.7 * u.norm() * simulator.time_s());
  EXPECT_LT(difference(simulator.bodies().v_WBcm(kStone), Vector3d(wind + u_end)), 1e-12);
  EXPECT_LT(u_end.norm(), 0.45 * u.norm());
}

TEST(Drag, LeavesABodyThatMovesWithTheWindAlone) {
  const Scene scene = sceneFrom(sceneText("air_density: 1.225, wind: [3, -4, 5]"));
  const Simulator simulator = after(flown(scene, "exact", 10'000'000), 100);
  EXPECT_LT(difference(simulator.bodies().v_WBcm(kStone), Vector3d(3, -4, 5)), 1e-13);
}

// ---- The fall with quadratic drag

/// The largest of the relative errors of speed and depth after a second and a half from rest:
/// v = v_t tanh(g t / v_t), z = -v_t^2 / g ln cosh(g t / v_t), v_t^2 = 2 m g / (rho CdA).
double fallError(const std::string& integrator, int steps) {
  const Scene scene = sceneFrom(fallText("step_s: 0.02"));
  const Simulator simulator = after(flown(scene, integrator, 1'500'000'000 / steps), steps);
  const double t = simulator.time_s(), g = 9.8, v_t = std::sqrt(2 * 2 * g / (kDensity * 0.4));
  const double v = v_t * std::tanh(g * t / v_t),
               z = v_t * v_t / g * std::log(std::cosh(g * t / v_t));
  return std::max(std::abs(simulator.bodies().v_WBcm(0).z() / -v - 1),
                  std::abs(simulator.bodies().p_WBcm(0, 2) / -z - 1));
}

TEST(Drag, OfAFallHasTheOrderOfEachMethod) {
  for (const IntegratorRow& row : integrators()) {
    if (row.order == 0 || (row.has_drifts && row.order_under_drag == 0)) continue;
    const int order = row.has_drifts ? std::min(row.order, 2) : row.order;
    const int steps = row.order == 8 ? 4 : 96;
    const double coarse = fallError(row.name, steps), fine = fallError(row.name, 2 * steps);
    EXPECT_NEAR(std::log2(coarse / fine), order, order == 8 ? 0.6 : 0.06) << row.name;
  }
}

TEST(Drag, OfAFallKeepsTheToleranceOfTheReference) { EXPECT_LT(fallError("adaptive", 1), 1e-11); }

TEST(Drag, LetsABodyFallAtItsTerminalVelocityInTheEnd) {
  const double v_t = std::sqrt(2 * 2 * 9.8 / (kDensity * 0.4));
  for (const std::string integrator : {"exact", "split2", "rk4", "rk8"}) {
    const Scene scene = sceneFrom(fallText("step_s: 0.001, integrator: " + integrator));
    // Rest minus v_t is 2 v_t exp(-2 g t / v_t): 1e-12 after 13 s. A kick of half a step's gravity
    // stands before the drag and half a one after it: (g h / v_t)^2 / 8 = 1.5e-7 of v_t.
    const Simulator simulator = after(scene, 15000);
    const double tolerance = integrator[0] == 'r' ? 1e-11 : 2e-7;
    EXPECT_NEAR(simulator.bodies().v_WBcm(0).z() / -v_t, 1, tolerance) << integrator;
  }
}

// ---- Energy

TEST(Drag, DissipatesWhatTheBodiesLoseInStillAir) {
  const Scene scene = sceneFrom(sceneText("air_density: 1.225", "energy_audit: true, "));
  Simulator simulator(scene);
  const double start = kineticEnergy(simulator.bodies());
  double last = start;
  for (int i = 0; i < 200; ++i) {
    simulator.step();
    const double now = kineticEnergy(simulator.bodies());
    ASSERT_LT(now, last);
    last = now;
  }
  const EnergyBalance energy = simulator.energy();
  EXPECT_LT(last, 0.5 * start);
  // Of some 1e3 operations, each rounded to the start's energy.
  EXPECT_NEAR(energy.effects_J, last - start, 1e3 * kEps * start);
  EXPECT_NEAR(energy.unaccounted_J(), 0, 1e3 * kEps * start);
}

TEST(Drag, ClosesTheEnergyAuditOfAFallInWindWithTheOrderOfTheMethod) {
  const auto open = [](const std::string& integrator, int steps) {
    const Scene scene =
        flown(sceneFrom(fallText("energy_audit: true", "air_density: 1.225, wind: [4, -3, 0.5]")),
              integrator, 1'600'000'000 / steps);
    return std::abs(after(scene, steps).energy().unaccounted_J());
  };
  EXPECT_NEAR(std::log2(open("rk4", 40) / open("rk4", 80)), 4, 0.3);
  EXPECT_NEAR(std::log2(open("exact", 40) / open("exact", 80)), 2, 0.05);
  EXPECT_NEAR(std::log2(open("split2", 40) / open("split2", 80)), 2, 0.05);
}

}  // namespace
}  // namespace rigid_body_sim

// Drag on tumbling bodies in shear and gusts against the reference, its bounds at absurd
// parameters, and parts of it against the whole.
#include <cmath>

#include "effects/wind.hpp"
#include "generic.hpp"
#include "reference/flight.hpp"
#include "rigid_body_sim/conserved.hpp"

namespace rigid_body_sim {
namespace {

using reference::Real;
using reference::Vector3r;

/// A tumbling body in wind of which both shear and gusts matter.
Scene windyScene() {
  return sceneFrom(
      "{effects: {drag: {air_density: 1.2, drag_area: 0.6, rotational_drag: 0.9, wind: {velocity: "
      "[7, -4, 1], shear: {reference_height: 10, exponent: 0.2}, gusts: {deviation: 2, time: 4, "
      "seed: 5}}}}, bodies: {stone: {mass: 2.7, inertia: [1.6, -0.3, 0.2, 2.1, 0.4, 1.8], com: "
      "[0.1, -0.2, 0.3], position: [1, 2, 4], orientation: [-0.5, 0.5, 0.5, 0.5], "
      "linear_velocity: [3, -4, 5], angular_velocity: [1.3, 0.7, -0.9]}}}");
}

/// What windyScene() says, in words of its own.
reference::PushLaw windyLaw(const Vector3d& I_double) {
  const Vector3r I = I_double.cast<Real>();
  return [I, gusts = Gusts({2, 4, 5})](Real t, const reference::State& body) {
    const Vector3r wind = std::pow(body.p_WBcm.z() / 10, Real(0.2)) * Vector3r(7, -4, 1) +
                          gusts.at(static_cast<double>(t)).cast<Real>();
    const Vector3r u = body.P_WB / Real(2.7) - wind;
    const Vector3r w =
        body.q_WB * Vector3r((body.q_WB.conjugate() * body.L_WBcm_W).cwiseQuotient(I));
    return reference::Push{Real(-0.6) * Real(0.6) * u.norm() * u,
                           Real(-0.6) * Real(0.9) * w.norm() * w};
  };
}

double distance(const BodyState& a, const BodyState& b) {
  return std::max({difference(a.p_WBcm, b.p_WBcm), angleBetween(a.q_WB, b.q_WB),
                   difference(a.P_WB, b.P_WB), difference(a.L_WBcm_W, b.L_WBcm_W)});
}

double windyError(const std::string& integrator, int steps, const BodyState& exact) {
  Scene scene = windyScene();
  scene.integrator = integrator;
  scene.step_ns = 1'200'000'000 / steps;
  Simulator simulator(scene);
  for (int i = 0; i < steps; ++i) simulator.step();
  return distance(simulator.state(0), exact);
}

TEST(DragLaws, InShearAndGustsOnATumblingBodyHaveTheOrderOfEachMethod) {
  const Simulator start(windyScene());
  const Vector3d I = start.bodies().moments(0);
  const BodyState exact = reference::fly(start.state(0), 2.7, I, windyLaw(I), Real(1.2)).end;
  for (const IntegratorRow& row : integrators()) {
    if (row.order == 0 || (row.has_drifts && row.order_under_drag == 0)) continue;
    const int order = row.has_drifts ? std::min(row.order, 2) : row.order;
    const int steps = order == 8 ? 6 : order == 1 ? 1600 : 160;
    const double coarse = windyError(row.name, steps, exact);
    const double fine = windyError(row.name, 2 * steps, exact);
    // Measured: within 0.02 up to order 4.
    EXPECT_NEAR(std::log2(coarse / fine), order, order == 8 ? 0.8 : 0.06) << row.name << fine;
    RecordProperty(row.name, std::to_string(std::log2(coarse / fine)));
  }
  EXPECT_LT(windyError("adaptive", 1, exact), 1e-10);
}

// ---- Absurd parameters

std::string absurdText(const std::string& integrator) {
  // rho CdA |u| h / 2m and the same of the spin are some 1e6 and more.
  return "{step_s: 0.1, integrator: " + integrator +
         ", effects: {drag: {air_density: 1.2, drag_area: 1.0e+7, rotational_drag: 1.0e+7}}, "
         "bodies: {stone: {mass: 2.7, inertia: [0.02, 0, 0, 1.1, 0, 1.1], linear_velocity: "
         "[3, -4, 5], angular_velocity: [1.3, 0.7, -0.9]}, ball: {sphere: {radius: 0.2, density: "
         "90}, linear_velocity: [-6, 2, 1], angular_velocity: [2, -3, 1]}}}";
}

TEST(DragLaws, NeverTurnAVelocityRoundWhateverTheParameters) {
  for (const IntegratorRow& row : integrators()) {
    if (!row.has_drifts || row.order_under_drag == 0) continue;
    Simulator simulator(sceneFrom(absurdText(row.name)));
    const Bodies start = simulator.bodies();
    double last = kineticEnergy(start);
    for (int step = 0; step < 50; ++step) {
      simulator.step();
      const Bodies& now = simulator.bodies();
      for (int i = 0; i < 2; ++i) {
        ASSERT_GT(now.v_WBcm(i).dot(start.v_WBcm(i)), 0) << row.name;
        ASSERT_LT(now.v_WBcm(i).norm(), 1e-5 * start.v_WBcm(i).norm()) << row.name;
      }
      ASSERT_GT(now.L_WBcm_W.row(0).dot(start.L_WBcm_W.row(0)), 0) << row.name;
      ASSERT_LT(kineticEnergy(now), last) << row.name;
      last = kineticEnergy(now);
    }
    EXPECT_TRUE(simulator.frozenBodies().empty()) << row.name;
  }
}

TEST(DragLaws, HoldABodyInAnAbsurdGaleAtTheSpeedOfTheWind) {
  for (const std::string integrator : {"exact", "split2", "semi_implicit"}) {
    Simulator simulator(sceneFrom(
        "{step_s: 0.1, integrator: " + integrator +
        ", effects: {gravity: {acceleration: [0, 0, -9.8]}, drag: {air_density: 1.2, drag_area: "
        "1.0e+9, wind: [300, -200, 0]}}, bodies: {b: {mass: 2, inertia: [1, 1, 1]}}}"));
    for (int step = 0; step < 100; ++step) simulator.step();
    // Gravity's kick of a step, 0.98 m/s, is the most that is left.
    EXPECT_LT((simulator.bodies().v_WBcm(0) - Vector3d(300, -200, 0)).norm(), 1) << integrator;
    EXPECT_NEAR(simulator.bodies().p_WBcm(0, 0), 3000, 1e-3 * 3000) << integrator;
  }
}

TEST(DragLaws, AreFollowedFromRestByStepsThatAdapt) {
  // 1.8e5 /m: the first trial step overshoots so far that its stages are no numbers.
  Scene scene = sceneFrom(
      "{effects: {gravity: {acceleration: [0, 0, -9.8]}, drag: {air_density: 1.2, drag_area: "
      "3.0e+5}}, bodies: {leaf: {point_mass: 1}}}");
  scene.integrator = "adaptive";
  Simulator simulator(scene);
  simulator.step();
  ASSERT_TRUE(simulator.frozenBodies().empty());
  const double k = 0.5 * 1.2 * 3e5,
               speed = std::sqrt(9.8 / k) * std::tanh(std::sqrt(9.8 * k) * 0.02);
  EXPECT_NEAR(simulator.state(0).P_WB.z(), -speed, 1e-12 * speed + 1e-14);
}

TEST(DragLaws, AreRefusedByRungeKuttaMethodsWithTheLargestStableStep) {
  // rho CdA |u| / m = 1.2 * 0.5 * 10 / 0.01 = 600 1/s; rk4 bears 2.78: 4.633 ms.
  const auto text = [](const std::string& integrator, const std::string& step) {
    return "{step_s: " + step + ", integrator: " + integrator +
           ", effects: {drag: {air_density: 1.2, drag_area: 0.5}}, bodies: {b: {point_mass: 0.01, "
           "linear_velocity: [6, 0, -8]}}}";
  };
  const auto load = [&](const std::string& integrator, const std::string& step) {
    Simulator simulator(sceneFrom(text(integrator, step)));
  };
  EXPECT_TRUE(contains(refusal([&] { load("rk4", "0.005"); }),
                       {"body 'b': 'drag'", "slows down at 600 1/s",
                        "with 'rk4' the largest stable step is 0.004633", "exact"}));
  EXPECT_NO_THROW(load("rk4", "0.0046"));
  EXPECT_TRUE(contains(refusal([&] { load("rk8", "0.0107"); }),
                       {"with 'rk8' the largest stable step is 0.01063"}));
  EXPECT_NO_THROW(load("exact", "1"));
  EXPECT_TRUE(contains(refusal([&] { load("exact4", "0.001"); }), {"'drag' would feed energy"}));
}

TEST(DragLaws, OfSpinAreRefusedByRungeKuttaMethodsToo) {
  // 2 kappa |w| / I about the axis of the spin, the fastest: 1.2 * 0.5 * 20 / 0.01 = 1200 1/s.
  const std::string text =
      "{step_s: 0.01, integrator: rk4, effects: {drag: {air_density: 1.2, rotational_drag: 0.5}}, "
      "bodies: {b: {mass: 1, inertia: [0.01, 0.02, 0.025], angular_velocity: [20, 0, 0]}}}";
  EXPECT_TRUE(
      contains(refusal([&] { Simulator simulator(sceneFrom(text)); }), {"slows down at 1200 1/s"}));
}

// ---- Added mass

/// Bodies of which one carries a mass matrix of no special shape, and one the plain mass.
Bodies withAddedMass() {
  Bodies bodies(2);
  bodies.mass << 2, 3;
  bodies.I_BBcm_B << 1, 2, 2.5, 1, 1, 1;
  const Matrix3d R = Quaterniond(0.2, 0.7, -0.4, 0.5).normalized().toRotationMatrix();
  bodies.setInverseMass(0, R * Vector3d(0.1, 0.4, 0.25).asDiagonal() * R.transpose());
  for (int i = 0; i < 2; ++i)
    bodies.setState(i, {{1, 2, 3}, genericAttitude(), {4, -5, 6}, {1, -2, 0.5}});
  return bodies;
}

std::shared_ptr<const Effect> dragInWind(const std::string& areas) {
  return sceneFrom("{effects: {drag: {air_density: 1.2, wind: [1, -2, 0.5], " + areas +
                   "}}, bodies: {a: {mass: 1, inertia: [1, 1, 1]}, b: {mass: 1, inertia: [1, 1, "
                   "1]}}}")
      .effects.at(0);
}

/// The flow of the effect alone for 0.7 s.
Bodies braked(const Effect& drag, int steps) {
  Bodies bodies = withAddedMass();
  for (int i = 0; i < steps; ++i) {
    drag.beforeDrift(bodies, Instant(bodies, 0), 0.7 / steps);
    drag.afterDrift(bodies, Instant(bodies, 0), 0.7 / steps);
  }
  return bodies;
}

/// The same by the wrenches, in many steps of the classical Runge-Kutta method.
Bodies brakedByWrenches(const Effect& drag) {
  Bodies bodies = withAddedMass();
  const int steps = 2000;
  const double h = 0.7 / steps;
  const auto wrenchesAt = [&](const Wrenches& rates, double ah) {
    Bodies at = bodies;
    at.P_WB += ah * rates.f_W;
    at.L_WBcm_W += ah * rates.t_Bcm_W;
    Wrenches wrenches;
    wrenches.setZero(2);
    drag.addWrenches(Instant(at, 0), wrenches);
    return wrenches;
  };
  Wrenches none;
  none.setZero(2);
  for (int i = 0; i < steps; ++i) {
    const Wrenches k1 = wrenchesAt(none, 0), k2 = wrenchesAt(k1, 0.5 * h),
                   k3 = wrenchesAt(k2, 0.5 * h), k4 = wrenchesAt(k3, h);
    bodies.P_WB += h / 6 * (k1.f_W + 2 * k2.f_W + 2 * k3.f_W + k4.f_W);
    bodies.L_WBcm_W += h / 6 * (k1.t_Bcm_W + 2 * k2.t_Bcm_W + 2 * k3.t_Bcm_W + k4.t_Bcm_W);
  }
  return bodies;
}

TEST(DragLaws, OfABodyThatCarriesMassAlongAreOfSecondOrderAndExactOfThePlainOne) {
  const auto drag = dragInWind("drag_area: 1.1, rotational_drag: 0.8");
  const Bodies exact = brakedByWrenches(*drag);
  std::vector<double> errors, spin_errors;
  for (const int steps : {16, 32}) {
    const Bodies end = braked(*drag, steps);
    errors.push_back(difference(end.P_WB.row(0), exact.P_WB.row(0)));
    spin_errors.push_back(difference(end.L_WBcm_W.row(0), exact.L_WBcm_W.row(0)));
    EXPECT_LT(difference(end.P_WB.row(1), exact.P_WB.row(1)), 1e-11);
    EXPECT_LT(difference(end.L_WBcm_W.row(1), exact.L_WBcm_W.row(1)), 1e-11);
  }
  EXPECT_NEAR(std::log2(errors[0] / errors[1]), 2, 0.06);
  EXPECT_NEAR(std::log2(spin_errors[0] / spin_errors[1]), 2, 0.06);
}

TEST(DragLaws, TellTheStiffnessOfABodyThatCarriesMassAlong) {
  const auto drag = dragInWind("drag_area: 1.1");
  const Bodies bodies = withAddedMass();
  const Stiffness stiffness = drag->stiffness(Instant(bodies, 0));
  // Between 1 and 2 times c |u| times the extremes of the inverse mass.
  const double c_u = 0.5 * 1.2 * 1.1 * (bodies.v_WBcm(0) - Vector3d(1, -2, 0.5)).norm();
  const double c_u_plain = 0.5 * 1.2 * 1.1 * (bodies.v_WBcm(1) - Vector3d(1, -2, 0.5)).norm();
  EXPECT_GT(stiffness.decay, std::max(0.4 * c_u, 2 * c_u_plain / 3 * (1 - 1e-12)));
  EXPECT_LT(stiffness.decay, 2 * 0.4 * c_u);
}

// ---- Parts

TEST(DragLaws, OfSomeBodiesAreThoseOfTheWhole) {
  for (const std::string air :
       {"air_density: 1.2",
        "atmosphere: us_standard_1976, wind: {velocity: [3, 1, 0], shear: "
        "{reference_height: 2, exponent: 0.3}, gusts: {deviation: 1, time: 2}}"}) {
    const Scene scene = sceneFrom(
        "{effects: {drag: {" + air +
        ", drag_area: 0.5}}, bodies: {a: {point_mass: 1, position: "
        "[0, 0, 3], linear_velocity: [1, 2, 3]}, b: {sphere: {radius: 1, density: 2}, drag: false},"
        " c: {mass: 2, inertia: [1, 2, 2.5], position: [0, 0, 50], linear_velocity: [3, 2, -3], "
        "angular_velocity: [1, 2, 3], drag: {rotational_drag: 2}}}}");
    const Effect& whole = *scene.effects.at(0);
    EXPECT_EQ(whole.bodyCount(), 2u);
    const auto part = whole.restrictedTo({2, 1});
    EXPECT_EQ(part->bodyCount(), 1u);
    EXPECT_EQ(whole.restrictedTo({1})->bodyCount(), 0u);
    const Bodies bodies = Simulator(scene).bodies();
    Bodies some(2);
    some.mass << bodies.mass(2), bodies.mass(1);
    some.I_BBcm_B << bodies.I_BBcm_B.row(2), bodies.I_BBcm_B.row(1);
    some.setState(0, bodies.state(2));
    some.setState(1, bodies.state(1));
    Wrenches all, few;
    all.setZero(3);
    few.setZero(2);
    whole.addWrenches(Instant(bodies, 0.4), all);
    part->addWrenches(Instant(some, 0.4), few);
    EXPECT_EQ(few.f_W.row(0), all.f_W.row(2));
    EXPECT_EQ(few.t_Bcm_W.row(0), all.t_Bcm_W.row(2));
    EXPECT_TRUE(few.f_W.row(1).isZero(0));
    Bodies moved = bodies;
    whole.beforeDrift(moved, Instant(moved, 0.4), 0.1);
    part->beforeDrift(some, Instant(some, 0.4), 0.1);
    EXPECT_TRUE(sameBits(some.state(0), moved.state(2)));
    EXPECT_TRUE(sameBits(some.state(1), bodies.state(1)));
  }
}

}  // namespace
}  // namespace rigid_body_sim

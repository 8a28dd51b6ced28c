// Budgets under friction that is stiff for a tick, against closed forms.
#include <cmath>

#include "core/accuracy_plan.hpp"
#include "core/suitability.hpp"
#include "generic.hpp"

namespace rigid_body_sim {
namespace {

constexpr double kGravity = 9.80665;

using Height = std::function<double(double time_s)>;

/// One point mass that moves along one axis, and where it is.
struct Friction {
  Scene scene;
  Vector3d axis;
  Height height;
};

std::string numberText(double number) {
  std::ostringstream text;
  text.precision(17);
  text << std::scientific << number;
  return text.str();
}

Scene falling(double mass, const std::string& effects, const std::string& of_body = "") {
  return sceneFrom("{bodies: {dot: {point_mass: " + numberText(mass) + of_body +
                   "}}, effects: {gravity: {acceleration: [0, 0, -9.80665]}, " + effects + "}}");
}

/// v' = -g - c v from rest.
Friction damped(double c) {
  return {falling(1, "damping: {linear: " + numberText(c) + "}"), Vector3d::UnitZ(),
          [c](double t) { return -kGravity / c * (t + std::expm1(-c * t) / c); }};
}

/// v' = -g + k v^2 from rest, k = rho CdA / 2m: z = -ln(cosh(sqrt(g k) t)) / k.
Friction dragged(double drag_area, double mass) {
  const double k = 0.5 * 1.2 * drag_area / mass;
  const double rate = std::sqrt(kGravity * k);
  return {falling(mass, "drag: {air_density: 1.2, drag_area: " + numberText(drag_area) + "}"),
          Vector3d::UnitZ(), [=](double t) {
            return -(rate * t + std::log1p(std::exp(-2 * rate * t)) - std::log(2.0)) / k;
          }};
}

/// x'' = -k x - c x', of one kilogram from rest at x = 1; overdamped.
Friction sprung(double k, double c) {
  const double fast = -0.5 * (c + std::sqrt(c * c - 4 * k)), slow = k / fast;
  return {sceneFrom("{bodies: {dot: {point_mass: 1, position: [1, 0, 0]}}, effects: {spring: "
                    "[{body: dot, anchor: [0, 0, 0], stiffness: " +
                    numberText(k) + ", damping: " + numberText(c) + "}]}}"),
          Vector3d::UnitX(), [=](double t) {
            return (slow * std::exp(fast * t) - fast * std::exp(slow * t)) / (slow - fast);
          }};
}

Budget metres(double position_m, double over_s) {
  Budget budget;
  budget.position_m = position_m;
  budget.over_s = over_s;
  return budget;
}

/// The largest distance from the closed form at any tick of the budget's span.
double worstError(const Friction& one, const Budget& budget) {
  Scene scene = one.scene;
  scene.accuracy = budget;
  Simulator simulator(scene);
  double worst = 0;
  for (int tick = 1; tick * scene.step_s() <= budget.over_s + 1e-9; ++tick) {
    simulator.step();
    const Vector3d truth = one.height(tick * scene.step_s()) * one.axis;
    const Vector3d p = simulator.state(0).p_WBcm;
    if (!p.allFinite()) return kInf;
    worst = std::max(worst, (p - truth).norm());
  }
  EXPECT_TRUE(simulator.frozenBodies().empty());
  EXPECT_TRUE(simulator.accuracy()->keepsBudget());
  return worst;
}

void expectKept(const Friction& one, const Budget& budget, const std::string& name) {
  try {
    EXPECT_LE(worstError(one, budget), budget.position_m) << name;
  } catch (const std::invalid_argument& refused) {
    ADD_FAILURE() << name << ": " << refused.what();
  }
}

TEST(StiffFriction, HasATruthThatIsNoFurtherFromTheClosedFormThanItsDoubt) {
  for (const auto& [name, one] :
       std::vector<std::pair<std::string, Friction>>{{"damping 20", damped(20)},
                                                     {"damping 230", damped(230)},
                                                     {"damping 1e4", damped(1e4)},
                                                     {"damping 1e5", damped(1e5)},
                                                     {"drag", dragged(3000, 0.01)},
                                                     {"spring 100", sprung(100, 100)},
                                                     {"spring 2000", sprung(100, 2000)}}) {
    const TrueTrajectory truth = flyTruly(one.scene, 250, 1);
    double worst = 0;
    for (std::size_t k = 0; k < truth.trajectory.samples.size(); ++k)
      worst = std::max(worst, (truth.trajectory.samples[k].state(0).p_WBcm -
                               one.height(0.02 * static_cast<double>(k)) * one.axis)
                                  .norm());
    // Both flights round alike, at every step of some hundred thousand: measured, 2e-15 m.
    EXPECT_LE(worst, truth.doubt.position_m + 2e-14) << name << ": " << truth.how;
    EXPECT_LE(truth.doubt.position_m, 1e-11) << name << ": " << truth.how;
  }
}

TEST(StiffFriction, HasItsBudgetKept) {
  for (const double c : {20., 230., 1000., 1500., 1e4})
    for (const double error : {1e-2, 1e-3, 1e-5, 1e-8})
      expectKept(damped(c), metres(error, 5), "damping " + numberText(c) + numberText(error));
  expectKept(damped(5e5), metres(1e-6, 0.2), "damping 5e5");
  for (const double error : {1e-2, 1e-4, 1e-6})
    expectKept(dragged(3000, 0.01), metres(error, 5), "drag " + numberText(error));
  for (const double c : {21., 100., 2000.})
    for (const double error : {3e-2, 1e-3, 1e-6})
      expectKept(sprung(100, c), metres(error, 2), "spring " + numberText(c) + numberText(error));
}

TEST(StiffFriction, OfABodyThatFliesFastAtFirstHasItsBudgetKept) {
  // It slows down at 1.8e5 1/s, for some millionths of a second; then it sinks.
  Friction one = dragged(3000, 0.01);
  one.scene.bodies[0].v_WBcm << 0.5, 0, 0;
  const TrueTrajectory truth = flyTruly(one.scene, 50, 1);
  EXPECT_LE(truth.doubt.position_m, 1e-9) << truth.how;
  one.scene.accuracy = metres(1e-2, 1);
  Simulator simulator(one.scene);
  for (std::size_t k = 1; k <= 50; ++k) {
    simulator.step();
    EXPECT_LE((simulator.state(0).p_WBcm - truth.trajectory.samples[k].state(0).p_WBcm).norm(),
              1e-2);
  }
}

TEST(StiffFriction, IsPlannedWithMethodsThatTheSimulatorTakes) {
  for (const double c : {100., 1000., 1e4}) {
    for (const double error : {1e-1, 1e-3, 1e-6}) {
      const Friction one = sprung(100, c);
      const Bill bill = plan(one.scene, metres(error, 2));
      for (const ClassBill& bought : bill.classes)
        for (const auto& offer :
             {std::optional<Offer>(bought.chosen), bought.runner_up, bought.digit_less}) {
          if (!offer) continue;
          EXPECT_NO_THROW(Simulator{withMethod(one.scene, offer->method)}) << toText(offer->method);
        }
    }
  }
}

TEST(StiffFriction, ThatNoReferenceCanFollowIsRefusedAndSaysSo) {
  // 2e7 times in a tick, of which `adaptive` takes a thousandth at least, in pieces.
  Friction one = damped(1e9);
  one.scene.accuracy = metres(1, 5);
  EXPECT_TRUE(contains(
      refusal([&] { Simulator{one.scene}; }),
      {"accuracy: 1 m over 5 s cannot be planned for body 'dot': 'damping' is too stiff: it slows "
       "it down at 1e+09 1/s, 2e+07 times in a tick; there is no reference",
       "take a smaller step_s, or name an integrator"}));
  const TrueTrajectory none = flyTruly(one.scene, 10, 1);
  EXPECT_EQ(none.doubt.position_m, kInf);
  EXPECT_EQ(none.trajectory.samples.size(), 11u);
  EXPECT_TRUE(contains(none.how, {"there is no reference"}));
}

TEST(StiffFriction, LeavesLocalErrorsThatAreNumbers) {
  Friction one = damped(1e4);
  one.scene.accuracy = metres(1e-5, 5);
  Simulator simulator(one.scene);
  for (int tick = 0; tick < 100; ++tick) simulator.step();
  ASSERT_TRUE(simulator.accuracy()->worst_ever);
  // Of a tick's error there is a hundredth of the span's.
  EXPECT_LE(simulator.accuracy()->worst_ever->error.position_m, 1e-7);
  EXPECT_LE(simulator.accuracy()->worst_ever->predicted.position_m, 1e-5);
}

TEST(StiffFriction, OfSeveralBodiesIsNamedWithItsBody) {
  Scene scene = sceneFrom(
      "{bodies: {free: {point_mass: 1}, dot: {point_mass: 1, damping: {linear: 1.0e+9}}}, effects: "
      "{gravity: {acceleration: [0, 0, -9.8]}, damping: {linear: 1}}}");
  scene.accuracy = metres(1, 5);
  EXPECT_TRUE(contains(refusal([&] { Simulator{scene}; }), {"planned for body 'dot': 'damping'"}));
}

TEST(StiffFriction, OfCoupledBodiesHasItsBudgetKept) {
  // Two bodies, overdamped between each other: half of the distance is as that of one on a spring
  // to the world of twice the numbers.
  Friction one = sprung(100, 1000);
  one.scene = sceneFrom(
      "{bodies: {dot: {point_mass: 1, position: [1, 0, 0]}, other: {point_mass: 1, position: [-1, "
      "0, 0]}}, effects: {spring: [{body: dot, to: other, stiffness: 50, damping: 500}]}}");
  expectKept(one, metres(1e-4, 2), "pair");
}

TEST(StiffFriction, OfBodiesOverLongIsExtrapolated) {
  // A spring that goes on creeping gives the reference no rest: a hundred steps a tick.
  std::string bodies, springs;
  for (int i = 0; i < 2; ++i) {
    const std::string name = "dot_" + std::to_string(i);
    bodies += name + ": {point_mass: 1, position: [1, " + std::to_string(i) + ", 0]}, ";
    springs += "{body: " + name + ", anchor: [0, " + std::to_string(i) +
               ", 0], stiffness: 100, damping: 1.0e+4}, ";
  }
  const Scene scene = sceneFrom("{bodies: {" + bodies + "}, effects: {spring: [" + springs + "]}}");
  const Bill bill = plan(scene, metres(1e-2, 150));
  EXPECT_LT(bill.ticks_flown, 7500);
  EXPECT_TRUE(contains(toText(bill, scene), {"extrapolated"}));
  Scene strict = scene;
  strict.accuracy = metres(1e-16, 150);
  EXPECT_TRUE(contains(refusal([&] { Simulator{strict}; }),
                       {"cannot be kept", "extrapolated from the first", "ask for less"}));
}

TEST(StiffFriction, GetsTheSameMethodEachTime) {
  for (const Friction& one : {damped(1e4), dragged(3000, 0.01), sprung(100, 2000)}) {
    const auto bill = [&] { return toText(plan(one.scene, metres(1e-4, 2)), one.scene); };
    EXPECT_EQ(bill(), bill());
  }
}

TEST(StiffSpring, ThatOneExactStepDoesNotBearIsPlannedInMore) {
  // 1000 rad/s: 20 rad a tick.
  const Scene scene = sceneFrom(
      "{bodies: {dot: {point_mass: 1, position: [1, 0, 0]}}, effects: {spring: [{body: "
      "dot, anchor: [0, 0, 0], stiffness: 1.0e+6}]}}");
  const Friction one = {scene, Vector3d::UnitX(), [](double t) { return std::cos(1000 * t); }};
  expectKept(one, metres(1e-3, 0.4), "spring");
  EXPECT_GE(plan(scene, metres(1e-3, 0.4)).classes[0].chosen.method.substeps, 4);
}

TEST(NotFinite, AtTheStartIsSaidInsteadOfAMethodsError) {
  Scene scene = sceneFrom(
      "{bodies: {dot: {point_mass: 1, position: [1, 0, 0]}}, effects: {rotating_frame: "
      "{angular_velocity: [0, 0, 1.0e+200]}}}");
  scene.accuracy = metres(1e-3, 1);
  EXPECT_TRUE(
      contains(refusal([&] { Simulator{scene}; }),
               {"body 'dot'", "'rotating_frame' acts on it with a wrench that is not finite"}));
}

}  // namespace
}  // namespace rigid_body_sim

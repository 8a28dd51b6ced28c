// Bodies on which something acts: pulses, switches, stiff springs, heavy drag.
#include <cmath>

#include "reference/gallery_rows.hpp"

namespace rigid_body_sim::reference {
namespace {

const char* const kTooFast = "a velocity that is turned by 1e5 rad at once";
const char* const kFrozen = "more radians a step than it bears: frozen, and warned of";
const char* const kTries = "a step tried that was far too long overflows, and is given up";
const Vector3d kAlong = Vector3d(0.48, -0.6, 0.64);  // unit, along no axis
const std::string kStone = bodyYaml("stone", "1", "1, 1.3, 2.1", "1.1, -2.3, 0.7");

HardCase pulse() {
  HardCase one = {"torque_pulse_of_1e9_Nm", "for one tick: 2e7 N m s, 2e5 rad a step ever after",
                  sceneYaml(kStone), 100};
  one.input = [](Tick tick) {
    TorqueInput input;
    if (tick == 0) input.t_W = 1e9 * kAlong;
    return input;
  };
  one.answer = gaining(1e9 * 0.02 * kAlong);
  one.must = {{Measure::kAngularMomentum, 4 * 0x1p-52, "torque times time, in two halves"},
              unitLength()};
  one.source = "L' = t";
  one.elsewhere =
      "Jolt and Bullet clamp the rate; DART ends the process on an assertion; MuJoCo "
      "resets the whole simulation with a warning (measured)";
  one.excuses = {
      {{"explicit_euler_velocity", "semi_implicit_velocity"}, Outcome::kInfinite, kTooFast},
      {{"semi_implicit_newton"}, Outcome::kWrong, "loses what it was given within a few steps"},
      {{"rk8", "adaptive"}, Outcome::kInfinite, kFrozen}};
  return one;
}

HardCase impulses() {
  HardCase one = {"impulses_of_1e6_Nms", "to and fro each tick, 500 times: all must be paid back",
                  sceneYaml(kStone), 1'000};
  one.input = [](Tick tick) {
    TorqueInput input;
    input.J_W = (tick % 2 == 0 ? 1e6 : -1e6) * kAlong;
    return input;
  };
  one.answer = rest;
  // Half an ulp of 1e6 in each component, of the 3.5 kg m^2/s that there are.
  one.must = {{Measure::kAngularMomentum, 0, "half an ulp of the impulse a sum",
               0.5 * 0x1p-33 * 1.74 / 3.5},
              unitLength()};
  one.source = "L changes by the sum of the impulses";
  one.elsewhere = "Jolt clamps rates at 47 rad/s, Bullet at pi/4 a step (measured): not given back";
  one.excuses = {
      {{"explicit_euler_velocity", "semi_implicit_velocity"}, Outcome::kInfinite, kTooFast},
      {{"semi_implicit_newton"}, Outcome::kWrong, "loses what it was given within a few steps"},
      {{"rk8"}, Outcome::kInfinite, kFrozen}};
  return one;
}

HardCase switching() {
  HardCase one = {"torque_switches_each_tick", "full on one way, full on the other, for 10 s",
                  sceneYaml(kStone), 500};
  one.input = [](Tick tick) {
    TorqueInput input;
    input.t_W = (tick % 2 == 0 ? 1 : -1) * 20 * kAlong;
    return input;
  };
  one.answer = switchedTorque(20 * kAlong);
  one.must = {{Measure::kAttitude, 5e-4, "second order: measured 1.7e-4 (exact), 2.3e-4 (split2)"},
              {Measure::kAngularMomentum, 0, "a sum a step: half an ulp of each", 2 * 0x1p-52},
              unitLength()};
  one.source = "extrapolated midpoint rule from tick to tick, in extended precision";
  one.elsewhere = "not measured; multistep methods carry a jump on into later steps";
  one.excuses = {{kVelocityRungs + kFirstOrder, Outcome::kWrong, "first order: 0.6 to 1.3 rad"}};
  return one;
}

HardCase stiffSpring() {
  // 4900 N/m at 0.5 kg: 98.99 rad/s, 1.98 rad a step; kicks and drifts are unstable from 2.
  HardCase one = {"stiff_spring",
                  "1.98 rad of swing a step, where kick and drift end at 2: must not grow, no more",
                  sceneYaml("bob: {mass: 0.5, inertia: [1, 1.3, 2.1], position: [0.3, -0.2, 0.1]}",
                            "0.02", "spring: [{body: bob, anchor: [0, 0, 0], stiffness: 4900}]"),
                  5'000};
  one.answer = swing(std::sqrt(4900 / 0.5));
  // The leapfrog keeps w^2 x^2 (1 - (w h)^2/4) + v^2: x stays below x0 / sqrt(1 - 0.98) = 7.1 x0;
  // the true one below x0 = 0.374 m.
  one.must = {
      {Measure::kPosition, (1 + 1 / std::sqrt(1 - 0.9801)) * 0.3742,
       "the leapfrog's own invariant: at most 7.1 times the start's length, and the truth's"},
      unitLength()};
  one.source = "harmonic oscillator; Hairer, Lubich, Wanner, Geometric Numerical Integration, I.1";
  one.elsewhere =
      "not measured; any kick and drift grows from 2 rad a step, and explicit Euler from 0";
  one.excuses = {{{"explicit_euler_velocity", "explicit_euler"},
                  Outcome::kRefused,
                  "bear 0.05 rad a step, and say the largest step"}};
  return one;
}

HardCase heavyDrag() {
  HardCase one = {
      "heavy_drag", "the first step would turn the velocity round, 1500 times over",
      sceneYaml("ball: {mass: 0.2, inertia: [0.01, 0.01, 0.01], "
                "linear_velocity: [300, -200, 100], angular_velocity: [100, 200, 50]}",
                "0.02", "drag: {air_density: 1000, drag_area: 0.08, rotational_drag: 0.001}"),
      500};
  one.answer = dragged(0.5 * 1000 * 0.08, 0.5 * 1000 * 0.001);
  one.must = {{Measure::kMomentum, 1e-13, "a quotient a step, of an end of 1e-5 of the start"},
              {Measure::kAngularMomentum, 1e-13, "the same"},
              // With x = k/m v0 h = 1497 the sum of h v0 / (1 + x (n + 1/2)) over the steps n is
              // m/k (ln x + psi(1/2)) short of the way, and as much of the turn with x = 229.
              {Measure::kPosition, 0.02676, "the midpoint rule, of v as it is: 0.0676 m"},
              {Measure::kAttitude, 0.06985, "the midpoint rule, of w as it is: 0.233 rad"},
              unitLength()};
  one.source = "v = v0 / (1 + k/m v0 t)";
  one.elsewhere = "not measured; an explicit step makes v of it -1495 v, and then infinity";
  one.excuses = {{kRungeKutta, Outcome::kRefused, "too stiff for them: they name the substeps"},
                 {kBackInTime, Outcome::kRefused, "drag in their steps back in time feeds energy"}};
  one.untrapped = {{"adaptive"}, kTries};
  return one;
}

HardCase heavyDamping() {
  HardCase one = {"heavy_damping", "exp(-200) a step: down through the denormals to rest",
                  sceneYaml(bodyYaml("stone", "1", "1, 1.3, 2.1", "1.1, -2.3, 0.7",
                                     "linear_velocity: [3, -2, 1]"),
                            "0.02", "damping: {linear: 1.0e+4, angular: 1.0e+4}"),
                  100};
  one.answer = damped(1e4);
  // Kick and drift turn it by less than nothing; the truth by |w| / c.
  one.must = {{Measure::kAngularMomentum, 1e-30, "exp(-20000) is zero"},
              {Measure::kAttitude, 2.65 / 1e4, "all of the true turn, |w| / c"},
              {Measure::kPosition, 3.75 / 1e4, "all of the true way, |v| / c"},
              unitLength()};
  one.source = "free flight in the time (1 - exp(-c t)) / c";
  one.elsewhere = "not measured; an explicit step makes v of it -199 v: infinite after 134";
  one.excuses = {{kRungeKutta, Outcome::kRefused, "too stiff for them: they name the substeps"},
                 {kBackInTime, Outcome::kRefused, "drag in their steps back in time feeds energy"}};
  one.untrapped = {{"adaptive"}, kTries};
  return one;
}

}  // namespace

std::vector<HardCase> pushedCases() {
  return {pulse(), impulses(), switching(), stiffSpring(), heavyDrag(), heavyDamping()};
}

}  // namespace rigid_body_sim::reference

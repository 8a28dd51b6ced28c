// Rates, places and steps at the ends of the numbers.
#include "reference/gallery_rows.hpp"

namespace rigid_body_sim::reference {
namespace {

HardCase tinyRates() {
  const std::string still = "orientation: [0.5, -0.5, 0.5, 0.5]";
  HardCase one = {
      "denormal_rates", "1e-310 rad/s, and 1e-170 of which the square underflows: no 0/0, no drift",
      sceneYaml(bodyYaml("first", "1", "1, 1.3, 2.1", "1.0e-310, -3.0e-310, 2.0e-310", still) +
                ", " +
                bodyYaml("second", "1", "1, 1.3, 2.1", "1.0e-170, -3.0e-170, 2.0e-170", still)),
      5'000};
  one.answer = rest;
  one.must = {
      {Measure::kAttitude, 4 * 0x1p-52, "100 s turn it by 1e-168 rad: length restored, no more"},
      momentumToTheBit(),
      unitLength()};
  one.source = "rate times time";
  one.elsewhere = "0/0 in a textbook RK4 that rescales |w| (own prototype)";
  one.excuses = {velocityRungsSlip()};
  return one;
}

HardCase farAway() {
  HardCase one = {"far_away",
                  "1e9 m from the origin, a micrometre a second: an ulp there is 0.12 um",
                  sceneYaml(bodyYaml("probe", "1", "1, 1.3, 2.1", "0, 0, 0",
                                     "position: [1.0e+9, -1.0e+9, 1.0e+9], "
                                     "linear_velocity: [1.0e-6, -1.0e-6, 1.0e-6]")),
                  100'000};
  one.answer = freeFlight;
  one.must = {{Measure::kPosition, 0x1p-23, "one ulp of 1e9 m"}, momentumToTheBit(), unitLength()};
  one.source = "x0 + v t";
  one.elsewhere =
      "engines add less than half an ulp to their doubles, and the body stays where it is; in "
      "float32 an ulp is 64 m there";
  return one;
}

HardCase atRest() {
  HardCase one = {"at_rest_for_a_year",
                  "beside a turning ball, in steps of 1 s; a year with --long, else two days",
                  sceneYaml("still: {mass: 1, inertia: [1, 1.3, 2.1], position: [1, 2, 3], "
                            "orientation: [0.5, -0.5, 0.5, 0.5]}, " +
                                bodyYaml("ball", "1", "1, 1, 1", "0.01, -0.02, 0.03"),
                            "1.0"),
                  200'000, 31'557'600};
  one.answer = steadyTurn;
  one.must = toRounding();
  one.must.push_back({Measure::kPosition, 0, "it is where it was"});
  one.source = "Newton's first law; a turn at a constant rate";
  one.elsewhere =
      "not measured; Bullet and Jolt put resting bodies to sleep, and do not simulate them";
  one.excuses = {velocityRungsSlip()};
  return one;
}

HardCase stepsOf(const std::string& name, const std::string& step_s, Tick ticks) {
  HardCase one = {name, "the same stone as ever, in steps of " + step_s + " s",
                  sceneYaml(bodyYaml("stone", "1", "1, 1.3, 2.1", "1.1, -2.3, 0.7"), step_s),
                  ticks};
  one.answer = freeFlight;
  one.must = toRounding();
  one.source = "tumbling stone of reference/cases.cpp; Taylor series in extended precision";
  one.elsewhere =
      "an explicit gyroscopic term gains h^2 a.I a / 2 a step at any h (literal_euler_test.cpp)";
  one.excuses = step_s == "0.1"
                    ? onlyExactHolds(Outcome::kInfinite, kFiniteOrder)
                    : std::vector<Excuse>{{kVelocityRungs + kFirstOrder, Outcome::kDrifts,
                                           "first order: an error of 1e-7 rad in 0.1 s even so"}};
  return one;
}

}  // namespace

std::vector<HardCase> extremeNumbers() {
  return {tinyRates(), farAway(), atRest(), stepsOf("steps_of_1_us", "1.0e-6", 100'000),
          stepsOf("steps_of_0.1_s", "0.1", 5'000)};
}

}  // namespace rigid_body_sim::reference

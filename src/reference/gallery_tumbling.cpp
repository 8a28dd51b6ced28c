// Free rotation that is hard by its course: it turns over, hangs on the separatrix, or spins by
// many turns a step.
#include "reference/gallery_rows.hpp"

namespace rigid_body_sim::reference {
namespace {

const char* const kTooFar = "a velocity that is turned by tens of radians at once";

HardCase intermediateAxis() {
  HardCase one = {"intermediate_axis", "turns over again and again, for an hour; six with --long",
                  sceneYaml(bodyYaml("handle", "1", "1, 2, 3", "0.1, 5, 0.1")), 180'000, 1'080'000};
  one.answer = freeFlight;
  one.must = toRounding();
  one.source = "rates of S. Peters' benchmark 'boxes'; Taylor series in extended precision";
  one.elsewhere =
      "after 10 s: Bullet 2.65 rad off and 27 % of the energy gone, MuJoCo 1.8, DART 1.8, ODE 2.0, "
      "Jolt 0.4 (measured, Debian 12's builds); semi-implicit Euler on velocities infinite";
  one.excuses = onlyExactHolds(Outcome::kInfinite, kFiniteOrder);
  return one;
}

HardCase separatrix() {
  // m1^2 (1/I1 - 1/I2) = m3^2 (1/I2 - 1/I3), here m3 = 1.7320508 m1, but for 1e-12 of it.
  HardCase one = {"separatrix",
                  "a part in 1e12 off the motion that never turns over: hangs, then flips",
                  sceneYaml(bodyYaml("handle", "1", "1, 2, 3", "1, 2, 0.57735026918992",
                                     "orientation: [0, 0, 0, 1]")),
                  5'000};
  one.answer = freeFlight;
  one.must = toRounding();
  one.source = "Landau and Lifshitz, Mechanics, section 37; Taylor series in extended precision";
  one.elsewhere =
      "methods with branches lose it: the signs of Celledoni et al. 2008 had to be "
      "mended (principia, physics/euler_solver)";
  one.excuses = onlyExactHolds(Outcome::kWrong, kFiniteOrder);
  return one;
}

HardCase exactAxis() {
  HardCase one = {
      "exact_axis", "exactly about the intermediate axis: must neither leave it nor divide by zero",
      sceneYaml(bodyYaml("handle", "1", "1, 2, 3", "0, 5, 0", "orientation: [0, 0, 0, 1]")),
      50'000};
  one.answer = steadyTurn;
  one.must = toRounding();
  one.source = "Euler's equations: w x I w = 0; a turn at a constant rate";
  one.elsewhere = "not measured; closed forms with a case for each orbit divide 0 by 0 on the axis";
  return one;
}

HardCase fastSpinner() {
  HardCase one = {"spin_64_rad_a_step", "tumbles by ten turns a step",
                  sceneYaml(bodyYaml("spinner", "1", "0.01, 0.02, 0.03", "1700, 30, 2700")), 100};
  one.answer = freeFlight;
  one.must = toRounding();
  one.source = "fast spinner of reference/cases.cpp, 34 times as fast; Taylor series";
  one.elsewhere =
      "Bullet turns by pi/4 a step at most, Jolt by 47 rad/s (85 % of the energy gone): both "
      "measured; DART and MuJoCo blow up";
  one.excuses = {
      {{"explicit_euler_velocity", "semi_implicit_velocity"}, Outcome::kInfinite, kTooFar},
      {{"semi_implicit_newton"}, Outcome::kWrong, kTooFar},
      {kFirstOrder + Rungs{"split2"}, Outcome::kWrong,
       "bounded as L is kept, but a turn of tens of radians in one piece is any motion"},
      {kRungeKutta, Outcome::kRefused, "bear 1 and 2 rad a step, and say how many substeps do"},
      {{"adaptive"}, Outcome::kDrifts, "its tolerance is of a step, and it takes 300 a tick"}};
  return one;
}

HardCase absurdSpinner() {
  HardCase one = {"spin_2e6_rad_a_step", "1e8 rad/s, and 1e10 rad in all",
                  sceneYaml(bodyYaml("top", "1", "0.4, 1, 1", "1.0e+8, 3.0e+7, -4.0e+7")), 5'000};
  one.answer = freeTops;
  one.must = toRounding();
  one.source = "closed form of a top with two equal moments, in extended precision";
  one.elsewhere = "Bullet turns by pi/4 a step at most, Jolt by 47 rad/s (measured at lower rates)";
  one.excuses = {
      {{"explicit_euler_velocity", "semi_implicit_velocity"}, Outcome::kInfinite, kTooFar},
      {{"semi_implicit_newton"}, Outcome::kWrong, kTooFar},
      {kFirstOrder, Outcome::kWrong, "bounded as L is kept, but any motion"},
      {{"split2"},
       Outcome::kDrifts,
       "makes m of the attitude: its roundings wander, and 2e6 rad a step show it"},
      {kRungeKutta + Rungs{"adaptive"}, Outcome::kRefused,
       "bear 1, 2 and 200 rad a step, and say how many substeps do"}};
  return one;
}

HardCase millionSteps() {
  HardCase one = {"million_steps", "no error may add up: 1e6 steps, and 1e8 (23 days) with --long",
                  sceneYaml(bodyYaml("top", "1", "0.4, 1, 1", "0.6, 0.1, -0.2")), 1'000'000,
                  100'000'000};
  one.answer = freeTops;
  one.must = toRounding();
  one.source = "closed form; test/long_flight_test.cpp flies bodies of three moments as long";
  one.elsewhere =
      "1e8 steps of Catto's implicit term lose 7 % of E, of Jolt's 25 % (prototypes, measured)";
  one.excuses = onlyExactHolds(Outcome::kWrong, kFiniteOrder);
  return one;
}

HardCase offCentre() {
  HardCase one = {"off_centre",
                  "the link's origin is 1.5 m off the centre of mass, which must go straight on",
                  sceneYaml(bodyYaml("bar", "3", "0.5, 0.9, 1.1", "2, -3, 1",
                                     "com: [1.2, -0.7, 0.6], linear_velocity: [0.3, -0.2, 0.1]")),
                  2'500};
  one.answer = freeFlight;
  one.must = {{Measure::kPosition, 0, "the most that plain sums lose, half an ulp of 32 m a step",
               16 * 0x1p-52},
              {Measure::kMomentum, 0, "nothing acts: not a bit may change"},
              unitLength()};
  one.source = "Newton's first law; Taylor series in extended precision";
  one.elsewhere =
      "MuJoCo, DART and Simbody (semi-explicit) keep the velocity of the link's origin: it strays "
      "by 0.5 m in 10 s (measured)";
  return one;
}

HardCase withoutGyroscopicTerm() {
  HardCase one = {
      "gyroscopic_off",
      "w x I w left out: the rate stays constant in the world, whatever the tensor",
      sceneYaml(bodyYaml("handle", "1", "1, 2, 3", "0.1, 5, 0.1"), "0.02", "gyroscopic: false"),
      5'000};
  one.answer = steadyTurn;
  // From L to w and back: up to three ulps of w a step, always to one side (literal_euler_test:
  // 1.2), and n steps of that turn the body by n^2/2 h |w| of it: 5.6e-10 rad.
  one.must = {{Measure::kAttitude, 0.5 * 5'000 * 5'000 * 0.02 * 5.002 * 2 * 0x1p-52,
               "two ulps of the rate a step, for the rest of the flight"},
              unitLength()};
  one.source = "a turn at a constant rate; what angular momentum does is what is left out";
  one.elsewhere = "what fast engines do: 3.1 rad from the truth after 10 s (measured)";
  return one;
}

}  // namespace

std::vector<HardCase> tumblingCases() {
  return {intermediateAxis(), separatrix(),   exactAxis(), fastSpinner(),
          absurdSpinner(),    millionSteps(), offCentre(), withoutGyroscopicTerm()};
}

}  // namespace rigid_body_sim::reference

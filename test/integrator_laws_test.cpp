// What each row of the registry promises, measured. A new row joins by being there.
#include <cmath>
#include <cstdlib>
#include <functional>

#include "generic.hpp"
#include "reference/flight.hpp"
#include "reference/free_rotation.hpp"
#include "rigid_body_sim/conserved.hpp"

// Every allocation of the process goes through here: Eigen's do not use operator new.
// Sanitizers bring a malloc of their own: gcc says so by macros, clang by features.
#if defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define HAS_OWN_MALLOC
#endif
#endif
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define HAS_OWN_MALLOC
#endif
#if defined(__GLIBC__) && !defined(HAS_OWN_MALLOC)
#define COUNTS_ALLOCATIONS
static long allocation_count = 0;
extern "C" void* __libc_malloc(std::size_t size);
extern "C" void* malloc(std::size_t size) noexcept {
  ++allocation_count;
  return __libc_malloc(size);
}
#endif

namespace rigid_body_sim {

/// For gtest's messages.
static void PrintTo(const IntegratorRow& row, std::ostream* out) { *out << row.name; }

namespace {

/// A push on body 0 that the test can count.
class Push : public Effect {
 public:
  explicit Push(const AppliedWrench& applied) : applied_(applied) {}
  std::string name() const override { return "push"; }
  std::size_t bodyCount() const override { return 1; }
  void addWrenches(const Bodies& bodies, double, Wrenches& wrenches) const override {
    ++evaluations;
    const Wrench wrench = inWorldAboutCom(applied_, bodies.state(0).q_WB);
    wrenches.f_W.row(0) += wrench.f_F;
    wrenches.t_Bcm_W.row(0) += wrench.t_Q_F;
  }

  mutable long evaluations = 0;

 private:
  AppliedWrench applied_;
};

/// A law of the reference as an effect on body 0.
class Obeying : public Effect {
 public:
  explicit Obeying(reference::PushLaw law) : law_(std::move(law)) {}
  std::string name() const override { return "law"; }
  std::size_t bodyCount() const override { return 1; }
  void addWrenches(const Bodies& bodies, double time_s, Wrenches& wrenches) const override {
    const reference::Push push = law_(time_s, reference::extended(bodies.state(0)));
    wrenches.f_W.row(0) += push.f_W.cast<double>();
    wrenches.t_Bcm_W.row(0) += push.t_Bcm_W.cast<double>();
  }

 private:
  reference::PushLaw law_;
};

/// The same push as the reference sees it, from its definition and in long double.
reference::PushLaw lawOf(const AppliedWrench& applied) {
  using Vector = reference::Vector3r;
  const Vector f = applied.wrench.f_F.cast<reference::Real>();
  const Vector t = applied.wrench.t_Q_F.cast<reference::Real>();
  const Vector r = applied.p_BcmQ_B.cast<reference::Real>();
  const bool turns = applied.axes == Axes::kBody;
  return [=](reference::Real, const reference::State& body) {
    const Vector f_W = turns ? Vector(body.q_WB * f) : f;
    const Vector t_W = turns ? Vector(body.q_WB * t) : t;
    return reference::Push{f_W, t_W + Vector(body.q_WB * r).cross(f_W)};
  };
}

Bodies bodiesOf(const reference::Case& one) {
  Bodies bodies(1);
  bodies.mass << one.mass;
  bodies.I_BBcm_B.row(0) = one.I_BBcm_B;
  BodyState start;
  start.q_WB = genericAttitude();
  start.P_WB << 0.3, -0.8, 0.5;
  start.L_WBcm_W = start.q_WB * one.I_BBcm_B.cwiseProduct(one.w_WB_B);
  bodies.setState(0, start);
  return bodies;
}

double energy(const Bodies& bodies) {
  return kineticEnergy(bodies.state(0), bodies.mass(0), bodies.moments(0));
}

/// All that can differ between two states, each part in its own unit.
double distance(const BodyState& a, const BodyState& b) {
  return angleBetween(a.q_WB, b.q_WB) + (a.p_WBcm - b.p_WBcm).norm() + (a.P_WB - b.P_WB).norm() +
         (a.L_WBcm_W - b.L_WBcm_W).norm();
}

class IntegratorLaws : public testing::TestWithParam<IntegratorRow> {
 protected:
  std::unique_ptr<Integrator> make(Gyroscopic gyroscopic = Gyroscopic::kOn) const {
    return GetParam().make({gyroscopic});
  }

  BodyState run(const reference::Case& one, const Effect* effect, double time_s, int steps) const {
    Bodies bodies = bodiesOf(one);
    ActiveEffects effects;
    if (effect) effects.add(effect);
    const auto integrator = make();
    const double h = time_s / steps;
    for (int i = 0; i < steps; ++i) integrator->step(bodies, effects, i * h, h);
    return bodies.state(0);
  }

  /// Attitude error [rad] that rounding may leave after steps of 0.02 s at a constant rate: kEps a
  /// step where L is kept. A method that goes from velocities to L and back each step loses up to
  /// two kEps of the rate, and every later step turns by that much less; measured: 0.7 of the
  /// bound.
  double steadyTurnRounding(int steps, const Vector3d& w_WB_B) const {
    const double own = 2 * steps * kEps;
    if (GetParam().keeps_angular_momentum) return own;
    return own + steps * 0.5 * steps * 0.02 * w_WB_B.norm() * 2 * kEps;
  }

  /// The order as a slope: halves the step until the error is far below one, and stops before
  /// rounding, some 1e-13 here, is a hundredth of it.
  double measuredOrder(const Effect* effect, const reference::PushLaw& law) const {
    const reference::Case& one = reference::caseNamed("tumbling_stone");
    const double time_s = 2;
    const BodyState start = bodiesOf(one).state(0);
    const BodyState exact = reference::fly(start, one.mass, one.I_BBcm_B, law, time_s).end;
    std::vector<double> errors = {kInf};
    for (int steps = 16; steps <= 1 << 14; steps *= 2) {
      const double error = distance(run(one, effect, time_s, steps), exact);
      if (error < 1e-11) break;
      errors.push_back(error);
    }
    EXPECT_GE(errors.size(), 3u);
    EXPECT_LT(errors.back(), 1e-2);
    const double slope = std::log2(errors[errors.size() - 2] / errors.back());
    RecordProperty("slope", std::to_string(slope));
    RecordProperty("error", std::to_string(errors.back() * 1e9) + "e-9");
    return slope;
  }

  void expectOrder(const Effect* effect, const reference::PushLaw& law) const {
    EXPECT_NEAR(measuredOrder(effect, law), GetParam().order, 0.05);
  }
};

TEST_P(IntegratorLaws, OrderOfFreeMotionIsTheOneStated) {
  if (!GetParam().free_flight_is_exact) return expectOrder(nullptr, reference::nothing);
  // In one step, in a few and in many: rounding, a few kEps a step of a turn of some radians.
  const reference::Case& one = reference::caseNamed("tumbling_stone");
  const double time_s = 2;
  const BodyState exact =
      reference::fly(bodiesOf(one).state(0), one.mass, one.I_BBcm_B, reference::nothing, time_s).end;
  for (const int steps : {1, 7, 100})
    EXPECT_LE(distance(run(one, nullptr, time_s, steps), exact), (30 + 4 * steps) * kEps) << steps;
}

TEST_P(IntegratorLaws, OrderUnderABodyAxesPushIsTheOneStated) {
  const AppliedWrench applied = {
      Axes::kBody, {{0.7, -1.2, 0.4}, {0.9, 0.3, -1.6}}, {0.2, 0.5, -0.1}};
  const Push push(applied);
  expectOrder(&push, lawOf(applied));
}

TEST_P(IntegratorLaws, OrderUnderAWorldAxesPushAtABodyPointIsTheOneStated) {
  const AppliedWrench applied = {
      Axes::kWorld, {{1.7, -0.2, 1.4}, {0.1, -0.3, 0.2}}, {0.8, -0.5, 0.6}};
  const Push push(applied);
  expectOrder(&push, lawOf(applied));
}

TEST_P(IntegratorLaws, OrderUnderAPushThatDependsOnTimeIsTheOneStated) {
  using reference::Real, reference::Vector3r;
  const auto law = [](Real t, const reference::State&) {
    return reference::Push{Vector3r(0.7, -1.2, 0.4) * std::cos(2 * t),
                           Vector3r(0.9, 0.3, -1.6) * std::sin(3 * t + 1)};
  };
  const Obeying push(law);
  expectOrder(&push, law);
}

TEST_P(IntegratorLaws, OrderUnderDragIsAtLeastOne) {
  // The stated order leaves out wrenches that depend on velocities: split2 kicks explicitly.
  using reference::Vector3r;
  const reference::Case& one = reference::caseNamed("tumbling_stone");
  const Vector3r I = one.I_BBcm_B.cast<reference::Real>();
  const auto law = [=](reference::Real, const reference::State& body) {
    const Vector3r w_B = (body.q_WB.conjugate() * body.L_WBcm_W).cwiseQuotient(I);
    return reference::Push{-0.8L / one.mass * body.P_WB, -0.8L * (body.q_WB * w_B)};
  };
  const Obeying drag(law);
  const double slope = measuredOrder(&drag, law);
  EXPECT_GE(slope, 0.95);
  if (GetParam().name == "split2") {
    EXPECT_LE(slope, 1.05);  // measured: 1.000
  }
}

TEST_P(IntegratorLaws, SphereTurnsAtAConstantRateToRounding) {
  const reference::Case& sphere = reference::caseNamed("sphere");
  const int steps = 500;
  const auto exact =
      reference::symmetricTop(sphere.I_BBcm_B, {genericAttitude(), sphere.w_WB_B}, steps * 0.02);
  const BodyState end = run(sphere, nullptr, steps * 0.02, steps);
  EXPECT_LE(angleBetween(end.q_WB, exact.q_WB), steadyTurnRounding(steps, sphere.w_WB_B));
}

TEST_P(IntegratorLaws, BodyOnAPrincipalAxisTurnsAtAConstantRateToRounding) {
  reference::Case one = reference::caseNamed("tumbling_stone");
  for (const int axis : {0, 2}) {  // the middle one is unstable
    one.w_WB_B = 4 * Vector3d::Unit(axis);
    const int steps = 500;
    const BodyState end = run(one, nullptr, steps * 0.02, steps);
    const Vector3d turn = steps * 0.02 * 4 * (genericAttitude() * Vector3d::Unit(axis));
    EXPECT_LE(angleBetween(end.q_WB, rotationExp(turn) * genericAttitude()),
              steadyTurnRounding(steps, one.w_WB_B));
  }
}

TEST_P(IntegratorLaws, CentreOfMassOfAFreeBodyMovesInAStraightLine) {
  const reference::Case& one = reference::caseNamed("tumbling_stone");
  const int steps = 500;
  const BodyState end = run(one, nullptr, steps * 0.02, steps);
  const Vector3d expected = steps * 0.02 * Vector3d(0.3, -0.8, 0.5) / one.mass;
  EXPECT_LE(difference(end.p_WBcm, expected), steps * kEps * expected.norm());
}

TEST_P(IntegratorLaws, WithoutTheGyroscopicTermEveryBodyTurnsAtAConstantRate) {
  for (const reference::Case& one : reference::cases()) {
    if (one.name == "thin_rod") continue;  // its spin is lost in the rounding of L
    Bodies bodies = bodiesOf(one);
    const Vector3d w_WB = angularVelocity(bodies.state(0), one.I_BBcm_B);
    const auto integrator = make(Gyroscopic::kOff);
    ActiveEffects none;
    const int steps = 500;
    for (int i = 0; i < steps; ++i) integrator->step(bodies, none, i * 0.02, 0.02);
    EXPECT_LE(difference(angularVelocity(bodies.state(0), one.I_BBcm_B), w_WB),
              steps * 2 * kEps * w_WB.norm())
        << one.name;
    EXPECT_LE(
        angleBetween(bodies.state(0).q_WB, rotationExp(steps * 0.02 * w_WB) * genericAttitude()),
        steps * kEps * 0.02 * steps * w_WB.norm())  // each rate's error turns it ever after
        << one.name;
  }
}

TEST_P(IntegratorLaws, AngularMomentumStaysToTheBitIfSoStated) {
  if (!GetParam().keeps_angular_momentum) return;
  for (const reference::Case& one : reference::cases()) {
    const BodyState end = run(one, nullptr, 5000 * 0.02, 5000);
    EXPECT_TRUE(sameBits(end.L_WBcm_W, bodiesOf(one).state(0).L_WBcm_W)) << one.name;
    EXPECT_NEAR(end.q_WB.squaredNorm(), 1, 4 * kEps) << one.name;
  }
}

TEST_P(IntegratorLaws, EnergyStaysBoundedWithoutATrendIfSoStated) {
  if (!GetParam().bounded_energy) return;
  Bodies bodies = bodiesOf(reference::caseNamed("dzhanibekov"));
  const Vector3d L_W = bodies.L_WBcm_W.row(0);
  const double start = energy(bodies);
  const auto integrator = make();
  ActiveEffects none;
  std::vector<double> worst;  // relative, in each minute of ten
  for (int step = 0; step < 30000; ++step) {
    if (step % 3000 == 0) worst.push_back(0);
    integrator->step(bodies, none, step * 0.02, 0.02);
    worst.back() = std::max(worst.back(), std::abs(energy(bodies) / start - 1));
    const Vector3d L_now = bodies.L_WBcm_W.row(0);
    ASSERT_LE((L_now - L_W).norm(), 1e-12 * L_W.norm());
  }
  RecordProperty("first_minute", std::to_string(worst.front() * 1e6) + "e-6");
  RecordProperty("last_minute", std::to_string(worst.back() * 1e6) + "e-6");
  // The body turns over some twenty times a minute, and the error peaks at each turn: a minute's
  // maximum is the peak, sampled every 0.02 s. A trend would add to it minute by minute. Rounding
  // walks by some kEps a step.
  const auto [least, most] = std::minmax_element(worst.begin(), worst.end());
  EXPECT_LE(*most, 1.1 * *least + 30000 * kEps);
  EXPECT_LE(*most, 2e-4);  // measured for split2: 1.195e-4 in every minute
}

TEST_P(IntegratorLaws, EvaluationsOfTheEffectsAreAsManyAsStated) {
  const Push push({Axes::kBody, {{1, 0, 0}, {0, 1, 0}}, {0, 0, 1}});
  run(reference::caseNamed("tumbling_stone"), &push, 1, 50);
  EXPECT_EQ(push.evaluations, 50 * GetParam().evaluations);
}

TEST_P(IntegratorLaws, StepsAllocateNothingAfterTheFirst) {
#ifndef COUNTS_ALLOCATIONS
  GTEST_SKIP() << "allocations cannot be counted here";
#else
  const long before_any = allocation_count;
  std::make_unique<Bodies>(7)->mass(0) = 1;
  ASSERT_GE(allocation_count, before_any + 7);  // the counter sees new and Eigen

  const Push push({Axes::kBody, {{1, 0, 0}, {0, 1, 0}}, {0, 0, 1}});
  for (const Gyroscopic gyroscopic : {Gyroscopic::kOn, Gyroscopic::kOff}) {
    Bodies bodies = bodiesOf(reference::caseNamed("tumbling_stone"));
    ActiveEffects effects;
    effects.add(&push);
    const auto integrator = make(gyroscopic);
    integrator->step(bodies, effects, 0, 0.02);
    const long before = allocation_count;
    for (int i = 1; i < 100; ++i) integrator->step(bodies, effects, i * 0.02, 0.02);
    EXPECT_EQ(allocation_count, before);
  }

  Scene scene = sceneOf(genericSceneBody("b"), GetParam().name);
  scene.effects.push_back(uniformGravity({0, 0, -9.8}, {0}));
  Simulator simulator(scene);
  WrenchInput input;
  input.applied.wrench.f_F << 1, 2, 3;
  simulator.apply(input);
  simulator.step();
  const long before = allocation_count;
  for (int i = 0; i < 100; ++i) simulator.step();
  EXPECT_EQ(allocation_count, before);
#endif
}

TEST_P(IntegratorLaws, BodiesDoNotKnowOfEachOther) {
  // The same bits alone and in company.
  const reference::Case& one = reference::caseNamed("tumbling_stone");
  Bodies three(3);
  for (int i = 0; i < 3; ++i) {
    const Bodies other = bodiesOf(i == 1 ? one : reference::caseNamed("dzhanibekov"));
    three.mass(i) = other.mass(0);
    three.I_BBcm_B.row(i) = other.I_BBcm_B.row(0);
    three.setState(i, other.state(0));
  }
  ActiveEffects none;
  const auto integrator = make();
  for (int i = 0; i < 100; ++i) integrator->step(three, none, i * 0.02, 0.02);
  EXPECT_TRUE(sameBits(three.state(1), run(one, nullptr, 2, 100)));
}

TEST_P(IntegratorLaws, IsFoundByItsName) {
  EXPECT_EQ(integratorNamed(GetParam().name).name, GetParam().name);
  EXPECT_EQ(integratorNamed(GetParam().name).make, GetParam().make);
  EXPECT_FALSE(GetParam().summary.empty());
}

INSTANTIATE_TEST_SUITE_P(Every, IntegratorLaws, testing::ValuesIn(integrators()),
                         [](const auto& info) { return info.param.name; });

TEST(Split2, GoesBackTheWayItCame) {
  const AppliedWrench applied = {Axes::kWorld, {{1.7, -0.2, 1.4}, {0, 0, 0}}, {0.8, -0.5, 0.6}};
  const Push push(applied);
  Bodies bodies = bodiesOf(reference::caseNamed("dzhanibekov"));
  const BodyState start = bodies.state(0);
  ActiveEffects effects;
  effects.add(&push);
  const auto integrator = integratorNamed("split2").make({});
  const int steps = 500;
  for (int i = 0; i < steps; ++i) integrator->step(bodies, effects, i * 0.02, 0.02);
  EXPECT_GT(distance(bodies.state(0), start), 1);
  for (int i = steps; i > 0; --i) integrator->step(bodies, effects, i * 0.02, -0.02);
  // Rounding, some kEps of numbers up to 50 a step, spread by the unstable axis; measured: 3e-13.
  EXPECT_LE(distance(bodies.state(0), start), 1e-11);
}

TEST(IntegratorNamed, ListsAllThatThereAre) {
  const std::string what = refusal([] { integratorNamed("rk44"); });
  EXPECT_TRUE(contains(what, {"'rk44' is not an integrator"}));
  for (const IntegratorRow& row : integrators()) EXPECT_TRUE(contains(what, {row.name}));
}

}  // namespace
}  // namespace rigid_body_sim

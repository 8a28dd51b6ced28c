// The order of each row of the registry, measured as a slope. A new row joins by being there.
#include "integrator_laws.hpp"

namespace rigid_body_sim {
namespace {

class IntegratorOrder : public IntegratorLaws {
 protected:
  /// The order as a slope: halves the step until the error is far below one, and stops before
  /// rounding, some 1e-13 here, is a hundredth of it; for the highest orders, whose errors fall
  /// from one to rounding within few halvings, a tenth.
  double measuredOrder(const Effect* effect, const reference::PushLaw& law) const {
    const reference::Case& one = reference::caseNamed("tumbling_stone");
    const double time_s = 2;
    const BodyState start = bodiesOf(one).state(0);
    const BodyState exact = reference::fly(start, one.mass, one.I_BBcm_B, law, time_s).end;
    std::vector<double> errors = {kInf};
    const bool is_high = GetParam().order >= 6;
    for (int steps = is_high ? 4 : 16; steps <= 1 << 14; steps *= 2) {
      const double error = distance(run(one, effect, time_s, steps), exact);
      if (error < (is_high ? 1e-12 : 1e-11)) break;
      errors.push_back(error);
    }
    EXPECT_GE(errors.size(), 3u);
    EXPECT_LT(errors.back(), 1e-2);
    const double slope = std::log2(errors[errors.size() - 2] / errors.back());
    RecordProperty("slope", std::to_string(slope));
    RecordProperty("error", std::to_string(errors.back() * 1e9) + "e-9");
    return slope;
  }

  /// Two-sided. What the next orders and rounding leave of the slope grows with the order;
  /// measured: within 0.02 up to order 4, 0.08 for order 6, 7.9 to 8.4 for order 8.
  void expectOrder(int order, const Effect* effect, const reference::PushLaw& law) const {
    EXPECT_NEAR(measuredOrder(effect, law), order, order >= 8 ? 0.45 : order >= 6 ? 0.15 : 0.05);
  }

  void expectOrder(const Effect* effect, const reference::PushLaw& law) const {
    if (GetParam().order == 0) return expectTolerance(effect, law);
    expectOrder(GetParam().order, effect, law);
  }

  /// Of a method that adapts its step: the error keeps what is asked for, and is not far better.
  void expectTolerance(const Effect* effect, const reference::PushLaw& law) const {
    const reference::Case& one = reference::caseNamed("tumbling_stone");
    const double time_s = 2;
    const BodyState start = bodiesOf(one).state(0);
    const BodyState exact = reference::fly(start, one.mass, one.I_BBcm_B, law, time_s).end;
    for (const double tolerance : {1e-5, 1e-7, 1e-9}) {
      Bodies bodies = bodiesOf(one);
      ActiveEffects effects;
      if (effect) effects.add(effect);
      GetParam().make({{}, tolerance})->step(bodies, effects, 0, time_s);
      const double error = distance(bodies.state(0), exact);
      RecordProperty("error_over_tolerance", std::to_string(error / tolerance));
      EXPECT_LE(error, 10 * tolerance);
      EXPECT_GE(error, 1e-5 * tolerance);
    }
  }
};

TEST_P(IntegratorOrder, OrderOfFreeMotionIsTheOneStated) {
  if (!GetParam().free_flight_is_exact) return expectOrder(nullptr, reference::nothing);
  // In one step, in a few and in many: rounding, a few kEps a step of a turn of some radians.
  const reference::Case& one = reference::caseNamed("tumbling_stone");
  const double time_s = 2;
  const BodyState exact =
      reference::fly(bodiesOf(one).state(0), one.mass, one.I_BBcm_B, reference::nothing, time_s)
          .end;
  for (const int steps : {1, 7, 100})
    EXPECT_LE(distance(run(one, nullptr, time_s, steps), exact), (30 + 4 * steps) * kEps) << steps;
}

TEST_P(IntegratorOrder, OrderUnderABodyAxesPushIsTheOneStated) {
  const AppliedWrench applied = {
      Axes::kBody, {{0.7, -1.2, 0.4}, {0.9, 0.3, -1.6}}, {0.2, 0.5, -0.1}};
  const Push push(applied);
  expectOrder(&push, lawOf(applied));
}

TEST_P(IntegratorOrder, OrderUnderAWorldAxesPushAtABodyPointIsTheOneStated) {
  const AppliedWrench applied = {
      Axes::kWorld, {{1.7, -0.2, 1.4}, {0.1, -0.3, 0.2}}, {0.8, -0.5, 0.6}};
  const Push push(applied);
  expectOrder(&push, lawOf(applied));
}

TEST_P(IntegratorOrder, OrderUnderAPushThatDependsOnTimeIsTheOneStated) {
  using reference::Real, reference::Vector3r;
  const auto law = [](Real t, const reference::State&) {
    return reference::Push{Vector3r(0.7, -1.2, 0.4) * std::cos(2 * t),
                           Vector3r(0.9, 0.3, -1.6) * std::sin(3 * t + 1)};
  };
  const Obeying push(law);
  expectOrder(&push, law);
}

TEST_P(IntegratorOrder, OrderUnderDragIsTheOneStated) {
  if (GetParam().order_under_drag == 0 && GetParam().order != 0) return;  // refused at load
  using reference::Vector3r;
  const reference::Case& one = reference::caseNamed("tumbling_stone");
  const Vector3r I = one.I_BBcm_B.cast<reference::Real>();
  const auto law = [=](reference::Real, const reference::State& body) {
    const Vector3r w_B = (body.q_WB.conjugate() * body.L_WBcm_W).cwiseQuotient(I);
    return reference::Push{-0.8L / one.mass * body.P_WB, -0.8L * (body.q_WB * w_B)};
  };
  const Obeying drag(law);
  if (GetParam().order == 0) return expectTolerance(&drag, law);
  expectOrder(GetParam().order_under_drag, &drag, law);
}

INSTANTIATE_TEST_SUITE_P(Every, IntegratorOrder, testing::ValuesIn(integrators()), nameOfRow);

}  // namespace
}  // namespace rigid_body_sim

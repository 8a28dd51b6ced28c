// Wrenches that depend on nothing are worked out once; nobody can tell but by the time it takes.
#include "flown_scenes.hpp"
#include "rigid_body_sim/active_effects.hpp"

namespace rigid_body_sim {
namespace {

const Vector3d kGravity(0.3, -0.2, -9.7);

/// Gravity that counts how often it is asked, and says of itself what it is told to.
class Asked : public Effect {
 public:
  Asked(std::vector<Eigen::Index> bodies, bool is_steady)
      : gravity_(uniformGravity(kGravity, std::move(bodies))), is_steady_(is_steady) {}

  std::string name() const override { return "asked"; }
  std::size_t bodyCount() const override { return gravity_->bodyCount(); }
  bool isSteady() const override { return is_steady_; }
  void addWrenches(const Instant& now, Wrenches& wrenches) const override {
    ++times;
    gravity_->addWrenches(now, wrenches);
  }

  mutable int times = 0;

 private:
  std::shared_ptr<const Effect> gravity_;
  bool is_steady_;
};

Scene twoBodies() {
  return sceneFrom("{bodies: {" + genericBodyNamed("a") + ", " + otherBodyNamed("b") + "}}");
}

WrenchInput push(Eigen::Index body, Axes axes, const Vector3d& point) {
  WrenchInput input;
  input.body = body;
  input.applied = {axes, {{0.4, -0.3, 0.7}, {0.5, 0.2, -0.6}}, point};
  input.ticks = 20;
  return input;
}

/// After 40 ticks under gravity, half of them with a wrench on the second body.
struct Flown {
  Bodies end;
  int times;
};

Flown flownBy(const std::string& integrator, bool is_steady, const WrenchInput& input) {
  Scene scene = twoBodies();
  scene.integrator = integrator;
  const auto asked = std::make_shared<Asked>(std::vector<Eigen::Index>{0, 1}, is_steady);
  scene.effects = {asked};
  Simulator simulator(scene);
  asked->times = 0;
  simulator.apply(input);
  for (int i = 0; i < 40; ++i) simulator.step();
  return {simulator.bodies(), asked->times};
}

TEST(SteadyEffects, MoveTheBodiesByTheSameBitsWithEveryMethod) {
  for (const IntegratorRow& row : integrators()) {
    const WrenchInput input = push(1, Axes::kWorld, Vector3d::Zero());
    const Flown once = flownBy(row.name, true, input), anew = flownBy(row.name, false, input);
    EXPECT_TRUE(sameBits(once.end, anew.end)) << row.name;
    EXPECT_EQ(once.times, 2) << row.name;  // with the wrench, and without it
    EXPECT_GE(anew.times, 40) << row.name;
  }
}

TEST(SteadyEffects, AreAskedAnewBesideOnesThatAreNot) {
  // Forces that turn with the body, or that act at a point that does.
  for (const WrenchInput& input :
       {push(1, Axes::kBody, Vector3d::Zero()), push(1, Axes::kWorld, Vector3d(0.1, -0.2, 0.3))}) {
    const Flown once = flownBy("rk4", true, input), anew = flownBy("rk4", false, input);
    EXPECT_TRUE(sameBits(once.end, anew.end));
    EXPECT_EQ(once.times, 20 * 4 + 1);  // stages of the wrench's ticks, and once after it
  }
}

TEST(SteadyEffects, AreAskedAnewBesideAFlow) {
  Scene scene = twoBodies();
  scene.integrator = "rk4";
  scene.effects = sceneFrom("{bodies: {" + genericBodyNamed("a") + ", " + otherBodyNamed("b") +
                            "}, effects: {damping: {linear: 0.8, angular: 0.5}}}")
                      .effects;
  const auto flown = [&](bool is_steady) {
    Scene both = scene;
    both.effects.push_back(std::make_shared<Asked>(std::vector<Eigen::Index>{0, 1}, is_steady));
    Simulator simulator(both);
    simulator.advance(40);
    return simulator.bodies();
  };
  EXPECT_TRUE(sameBits(flown(true), flown(false)));
}

TEST(SteadyEffects, ForOtherBodiesAreWorkedOutAnew) {
  const Bodies two = Simulator(twoBodies()).bodies();
  const Asked asked({0}, true);
  ActiveEffects active;
  active.add(&asked);
  active.evaluateKicks(two, 0);
  active.evaluateKicks(two, 0);
  EXPECT_EQ(asked.times, 1);
  EXPECT_EQ(active.counts().front().evaluations, 2u);
  Bodies one(1);
  one.mass(0) = 3;
  EXPECT_EQ(Vector3d(active.evaluateKicks(one, 0).f_W.row(0)), Vector3d(3 * kGravity));
}

TEST(SteadyEffects, HaveTheirWorkCounted) {
  // Under a constant force from rest, (f t)^2 / 2 m.
  for (const IntegratorRow& row : integrators()) {
    if (row.order == 1) continue;
    Scene scene = sceneFrom("{energy_audit: true, bodies: {a: {point_mass: 2}}}");
    scene.integrator = row.name;
    Simulator simulator(scene);
    WrenchInput push;
    push.applied.wrench.f_F << 3, 0, -4;
    push.ticks = 50;
    simulator.apply(push);
    simulator.advance(60);
    EXPECT_NEAR(simulator.energy().inputs_J, 25 / 4.0, 1e-12) << row.name;
    EXPECT_NEAR(simulator.energy().unaccounted_J(), 0, 1e-12) << row.name;
  }
}

TEST(SteadyEffects, AreTakenAsSoManyEvaluations) {
  Scene scene = twoBodies();
  scene.integrator = "rk4";
  scene.effects = {uniformGravity(kGravity, {0, 1})};
  Simulator simulator(scene);
  simulator.advance(10);
  EXPECT_EQ(simulator.effectCounts().front().evaluations, 10u * 4 * 2);
}

}  // namespace
}  // namespace rigid_body_sim

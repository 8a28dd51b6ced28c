#include "accuracy_scenes.hpp"
#include "allocation_count.hpp"
#include "core/suitability.hpp"
#include "effect_blocks.hpp"

namespace rigid_body_sim {
namespace {

WrenchInput push(Eigen::Index body, const Wrench& wrench, Tick start = 0, Tick ticks = 0) {
  WrenchInput input;
  input.body = body;
  input.applied = {Axes::kBody, wrench, {0.1, -0.2, 0.3}};
  input.start = start;
  input.ticks = ticks;
  return input;
}

/// Six bodies: the even ones with thrusters, all but the first under gravity.
Scene sixBodies() {
  Scene scene = swarmScene(6).scene;
  scene.effects.push_back(uniformGravity({0.1, 0.2, -9.8}, {1, 2, 3, 4, 5}));
  return scene;
}

Scene oneOf(const Scene& scene, Eigen::Index body) {
  Scene alone = scene;
  alone.methods.clear();
  alone.bodies = {scene.bodies[body]};
  alone.effects = *restrictedTo(scene.effects, {body});
  return alone;
}

/// Pushed from tick 3 to 8.
void pushAndRun(Simulator& simulator, Eigen::Index body) {
  simulator.apply(push(body, {{1, 2, -1}, {0.3, -0.1, 0.2}}, 3, 5));
  for (int k = 0; k < 40; ++k) simulator.step();
}

TEST(Block, MovesItsBodiesAsTheyWouldAloneToTheBit) {
  for (const IntegratorRow& row : integrators()) {
    // The adaptive method's steps are those that its hardest body wants.
    if (row.order == 0) continue;
    Scene scene = sixBodies();
    scene.methods = {{{0, 3, 5}, {row.name, 2}}, {{4, 1}, {row.name, 1}}, {{2}, {"exact", 3}}};
    Simulator together(scene);
    pushAndRun(together, 4);
    for (const MethodOfBodies& part : scene.methods) {
      for (const Eigen::Index body : part.bodies) {
        Scene alone = oneOf(scene, body);
        alone.integrator = part.method.integrator;
        alone.substeps = part.method.substeps;
        Simulator simulator(alone);
        if (body == 4)
          pushAndRun(simulator, 0);
        else
          for (int k = 0; k < 40; ++k) simulator.step();
        EXPECT_TRUE(sameBits(together.state(body), simulator.state(0))) << row.name << " " << body;
      }
    }
  }
}

TEST(Block, OfAllBodiesIsWhatTheSceneWithoutMethodsDoes) {
  Scene scene = sixBodies();
  scene.integrator = "rk4";
  scene.substeps = 3;
  Simulator plain(scene);
  scene.integrator = "split2";
  scene.methods = {{{0, 1, 2, 3, 4, 5}, {"rk4", 3}}};
  Simulator one_group(scene);
  pushAndRun(plain, 2);
  pushAndRun(one_group, 2);
  for (Eigen::Index i = 0; i < 6; ++i)
    EXPECT_TRUE(sameBits(plain.state(i), one_group.state(i))) << i;
}

TEST(Block, GoesBackToTheStartWithTheScene) {
  Scene scene = sixBodies();
  scene.methods = {{{0, 3, 5}, {"exact", 2}}, {{4, 1, 2}, {"rk8"}}};
  Simulator simulator(scene), fresh(scene);
  pushAndRun(simulator, 4);
  simulator.apply(push(1, {{1, 2, -1}, {0.3, -0.1, 0.2}}));
  simulator.step();
  simulator.reset();
  // A run after a reset is at another tick: only free bodies and constant effects do not see it.
  for (int k = 0; k < 20; ++k) simulator.step(), fresh.step();
  for (Eigen::Index i = 0; i < 6; ++i)
    EXPECT_TRUE(sameBits(simulator.state(i), fresh.state(i))) << i;
}

/// So many that they are divided, some without spin.
Scene manyBodies(Eigen::Index count) {
  Scene scene;
  Sampler sample(4);
  std::vector<Eigen::Index> all;
  for (Eigen::Index i = 0; i < count; ++i) {
    const Vector3d w = i % 5 == 0 ? Vector3d::Zero() : Vector3d(2 * sample.vector());
    scene.bodies.push_back(bodyOf("body_" + std::to_string(i), {1, 1.5, 2}, w));
    scene.bodies.back().v_WBcm = sample.vector();
    all.push_back(i);
  }
  scene.effects.push_back(uniformGravity({0.1, 0.2, -9.8}, all));
  return scene;
}

/// Pushes and an impulse that begin and end at different ticks, on bodies of different blocks.
void pushSome(Simulator& simulator) {
  simulator.apply(push(3, {{1, 2, -1}, {0.3, -0.1, 0.2}}, 3, 5));
  simulator.apply(push(299, {{1, 2, -1}, {0.3, -0.1, 0.2}}, 7, 11));
  ImpulseInput knock;
  knock.body = 140;
  knock.start = 9;
  knock.applied.wrench = {{1, 0, 0}, {0, 0.1, 0}};
  simulator.apply(knock);
}

TEST(Block, OfMoreBodiesMovesEachAsItWouldAloneToTheBit) {
  for (const IntegratorRow& row : integrators()) {
    if (row.order == 0) continue;  // the adaptive method's steps are common to all
    Scene scene = manyBodies(300);
    scene.integrator = row.name;
    Simulator together(scene);
    for (int k = 0; k < 20; ++k) together.step();
    for (const Eigen::Index body : {0, 1, 7, 135, 136, 137, 271, 272, 299}) {
      Simulator alone(oneOf(scene, body));
      for (int k = 0; k < 20; ++k) alone.step();
      EXPECT_TRUE(sameBits(together.state(body), alone.state(0))) << row.name << " " << body;
    }
  }
}

TEST(Block, AdvancesByManyTicksAsByOneAtATimeToTheBit) {
  for (const std::string integrator : {"semi_implicit", "rk4", "exact", "adaptive"}) {
    Scene scene = manyBodies(300);
    scene.integrator = integrator;
    Simulator one_by_one(scene), at_once(scene);
    pushSome(one_by_one);
    pushSome(at_once);
    std::size_t ended = 0;
    for (int k = 0; k < 40; ++k) {
      one_by_one.step();
      ended += one_by_one.endedWrenches().size();
    }
    at_once.advance(40);
    EXPECT_EQ(at_once.tick(), 40);
    EXPECT_EQ(ended, 2u);
    EXPECT_EQ(at_once.endedWrenches().size(), 2u);
    for (Eigen::Index i = 0; i < 300; ++i)
      EXPECT_TRUE(sameBits(one_by_one.state(i), at_once.state(i))) << integrator << " " << i;
  }
}

TEST(Block, FreezesABodyAtItsOwnTickWhileItAdvancesByMany) {
  Scene scene = manyBodies(300);
  Simulator one_by_one(scene), at_once(scene);
  for (Simulator* simulator : {&one_by_one, &at_once}) {
    // Of 1e307 kg m/s a second two seconds more than a number can be.
    WrenchInput huge = push(200, {{1e308, 0, 0}, {0, 0, 0}});
    huge.applied.axes = Axes::kWorld;
    simulator->apply(huge);
    huge.body = 20;
    huge.start = 10;
    simulator->apply(huge);
  }
  for (int k = 0; k < 200; ++k) one_by_one.step();
  at_once.advance(200);
  ASSERT_EQ(one_by_one.frozenBodies().size(), 2u);
  ASSERT_EQ(at_once.frozenBodies().size(), 2u);
  for (int k : {0, 1}) {
    EXPECT_EQ(at_once.frozenBodies()[k].body, k == 0 ? 200 : 20);
    EXPECT_EQ(at_once.frozenBodies()[k].tick, one_by_one.frozenBodies()[k].tick);
  }
  for (Eigen::Index i = 0; i < 300; ++i)
    EXPECT_TRUE(sameBits(one_by_one.state(i), at_once.state(i))) << i;
}

#ifdef COUNTS_ALLOCATIONS
TEST(Block, AllocatesNothingInASteadyTick) {
  for (const bool is_divided : {false, true}) {
    Scene scene = sixBodies();
    if (is_divided) scene.methods = {{{0, 3, 5}, {"exact", 2}}, {{4, 1, 2}, {"rk4"}}};
    Simulator simulator(scene);
    simulator.apply(push(4, {{1, 2, -1}, {0.3, -0.1, 0.2}}));
    for (int k = 0; k < 3; ++k) simulator.step();
    const long before = allocation_count;
    for (int k = 0; k < 50; ++k) simulator.step();
    EXPECT_EQ(allocation_count, before) << is_divided;
  }
}

TEST(Block, AllocatesNothingUnderAnyEffectWithItsBooksKept) {
  Sampler sample(99);
  for (auto [name, block] : blocksOf(sample)) {
    for (const char* audit : {"false", "true"}) {
      Simulator simulator(sceneFrom(
          "energy_audit: " + std::string(audit) + "\neffects: {" + name + ": " + block + "}\n" +
          "bodies:\n"
          "  a: {mass: 1.3, inertia: [1.6, 2.1, 1.8], angular_velocity: [0.8, -0.6, 1.1]}\n"
          "  b: {mass: 2.1, inertia: [1.2, 1.9, 2.3], linear_velocity: [0.8, -0.6, 1.1]}\n"));
      simulator.apply(push(0, {{1, 2, -1}, {0.3, -0.1, 0.2}}));
      for (int k = 0; k < 3; ++k) simulator.step();
      const long before = allocation_count;
      for (int k = 0; k < 50; ++k) simulator.step();
      EXPECT_EQ(allocation_count, before) << name << ", audit: " << audit;
    }
  }
}
#endif

TEST(Block, TakesEachBodyOnce) {
  Scene scene = sixBodies();
  scene.methods = {{{0, 1, 2}, {}}, {{2, 3, 4, 5}, {}}};
  EXPECT_TRUE(contains(refusal([&] { Simulator{scene}; }), {"'body_2' has 2 methods"}));
  scene.methods = {{{0, 1, 2}, {}}, {{4, 5}, {}}};
  EXPECT_TRUE(contains(refusal([&] { Simulator{scene}; }), {"'body_3' has 0 methods"}));
  scene.methods = {{{0, 1, 2}, {}}, {{3, 4, 5, 6}, {}}};
  EXPECT_TRUE(contains(refusal([&] { Simulator{scene}; }), {"body 6", "not there"}));
  scene.methods = {{{0, 1, 2, 3, 4, 5}, {}}, {{}, {}}};
  EXPECT_TRUE(contains(refusal([&] { Simulator{scene}; }), {"no body"}));
}

// ---- Methods that do not suit

Scene dragged() { return tenScenes(1)[3].scene; }

TEST(Method, WithStepsBackIsRefusedUnderDrag) {
  for (const IntegratorRow& row : integrators()) {
    Scene scene = dragged();
    scene.integrator = row.name;
    if (row.order > 0 && row.order_under_drag == 0)
      EXPECT_TRUE(contains(refusal([&] { Simulator{scene}; }),
                           {"'" + row.name + "'", "'law'", "velocities", "rk4 or rk8"}));
    else
      EXPECT_NO_THROW(Simulator{scene}) << row.name;
  }
}

TEST(Method, ThatLosesOrdersUnderDragGetsAWarning) {
  for (const IntegratorRow& row : integrators()) {
    if (row.order_under_drag == 0) continue;
    Scene scene = dragged();
    scene.integrator = row.name;
    const std::vector<std::string> warnings = Simulator(scene).scene().warnings;
    if (row.order_under_drag == row.order) {
      EXPECT_TRUE(warnings.empty()) << row.name;
    } else {
      ASSERT_EQ(warnings.size(), 1u) << row.name;
      EXPECT_TRUE(contains(warnings[0], {"law depends on velocities", row.name + " is of order 1",
                                         "gain energy without bound; rk4"}));
    }
    scene.effects.clear();
    EXPECT_TRUE(Simulator(scene).scene().warnings.empty()) << row.name;
  }
}

TEST(Method, IsRefusedForABodyThatTurnsTooFarInAStep) {
  SceneBody fast = bodyOf("top", {1, 2, 2.5}, {30, -80, 50});  // 99 rad/s, 1.98 rad a tick
  Scene scene = sceneOf(fast, "rk4");
  scene.bodies.push_back(bodyOf("slow", {1, 2, 2.5}, {1, 1, 1}));
  EXPECT_TRUE(contains(refusal([&] { Simulator{scene}; }),
                       {"'top'", "98.9949 rad/s", "1.9799 rad a step", "'rk4' bears 1",
                        "2 substeps or more", "exact"}));
  scene.substeps = 2;
  EXPECT_NO_THROW(Simulator{scene});
  scene.methods = {{{0}, {"exact"}}, {{1}, {"rk4"}}};
  EXPECT_NO_THROW(Simulator{scene});
}

TEST(Method, ThatInputsMadeTooFastIsFound) {
  Scene scene = sceneOf(bodyOf("slow", {1, 2, 2.5}, {1, 1, 1}), "exact");
  scene.bodies.push_back(bodyOf("top", {1, 2, 2.5}, {1, 1, 1}));
  scene.methods = {{{0}, {"exact"}}, {{1}, {"rk4"}}};
  Simulator simulator(scene);
  simulator.step();
  EXPECT_FALSE(simulator.overTurnedBody());
  ImpulseInput knock;
  knock.body = 1;
  knock.applied.wrench.t_Q_F << 0, 0, 250;
  simulator.apply(knock);
  simulator.step();
  const auto body = simulator.overTurnedBody();
  ASSERT_TRUE(body);
  EXPECT_EQ(body->body, 1);
  EXPECT_EQ(toText(body->method), "rk4");
  EXPECT_GT(body->turn, 1);
  EXPECT_EQ(body->max_turn, 1);
}

TEST(Method, TakesACountOfSubstepsInItsBounds) {
  for (const int substeps : {0, -1, 10'001}) {
    Scene scene = sixBodies();
    scene.substeps = substeps;
    EXPECT_TRUE(contains(refusal([&] { Simulator{scene}; }),
                         {"substeps", "1 to 10000", std::to_string(substeps)}));
  }
}

// ---- Effects in parts

TEST(Restricted, GravityActsOnTheSameBodiesAtTheirNewPlaces) {
  const auto gravity = uniformGravity({0, 0, -2}, {1, 4, 2});
  const auto part = gravity->restrictedTo({4, 0, 1});
  EXPECT_EQ(part->bodyCount(), 2u);
  Bodies bodies(3);
  bodies.mass << 3, 5, 7;
  Wrenches wrenches = {Column3::Zero(3, 3), Column3::Zero(3, 3)};
  part->addWrenches(Instant(bodies, 0), wrenches);
  EXPECT_EQ(wrenches.f_W.col(2), Eigen::Vector3d(-6, 0, -14));
  EXPECT_EQ(gravity->restrictedTo({0, 3})->bodyCount(), 0u);
}

TEST(Restricted, HeldWrenchesFollowTheirBodies) {
  AppliedWrenches held;
  held.update({push(5, {{1, 0, 0}, {0, 0, 0}}), push(2, {{0, 1, 0}, {0, 0, 0}})}, 0);
  const auto part = held.restrictedTo({5, 3});
  EXPECT_EQ(part->bodyCount(), 1u);
  Bodies bodies(2);
  for (Eigen::Index i : {0, 1}) bodies.setState(i, BodyState());
  Wrenches wrenches = {Column3::Zero(2, 3), Column3::Zero(2, 3)};
  part->addWrenches(Instant(bodies, 0), wrenches);
  EXPECT_EQ(wrenches.f_W.row(0), Eigen::RowVector3d(1, 0, 0));
  EXPECT_EQ(wrenches.f_W.row(1), Eigen::RowVector3d(0, 0, 0));
}

/// Cannot be divided.
class Coupling : public Effect {
 public:
  std::string name() const override { return "coupling"; }
  std::size_t bodyCount() const override { return 6; }
  void addWrenches(const Instant&, Wrenches&) const override {}
};

TEST(Restricted, AnEffectThatCouplesBodiesTakesOneMethodForAll) {
  Scene scene = sixBodies();
  scene.effects.push_back(std::make_shared<Coupling>());
  EXPECT_FALSE(restrictedTo(scene.effects, {0}));
  scene.methods = {{{0, 1, 2}, {}}, {{3, 4, 5}, {"rk4"}}};
  EXPECT_TRUE(contains(refusal([&] { Simulator{scene}; }), {"couples", "same method"}));
  scene.methods = {{{0, 1, 2, 3, 4, 5}, {"rk4"}}};
  EXPECT_NO_THROW(Simulator{scene});
}

}  // namespace
}  // namespace rigid_body_sim

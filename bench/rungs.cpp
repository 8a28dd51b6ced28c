// The rungs of this package as rows of the table: each integrator on bare Bodies, and in a
// Simulator with all that it does around the step (inputs, freezing).
#include <memory>
#include <numeric>

#include "peer.hpp"
#include "rigid_body_sim/simulator.hpp"

namespace rigid_body_sim::bench {
namespace {

/// What a program that pushes its bodies itself would write; as held inputs are.
class Pushes : public Effect {
 public:
  explicit Pushes(Wrenches wrenches) : wrenches_(std::move(wrenches)) {}
  std::string name() const override { return "pushes"; }
  std::size_t bodyCount() const override { return static_cast<std::size_t>(wrenches_.f_W.rows()); }
  bool isSteady() const override { return true; }
  void addWrenches(const Instant&, Wrenches& wrenches) const override {
    wrenches.f_W += wrenches_.f_W;
    wrenches.t_Bcm_W += wrenches_.t_Bcm_W;
  }
  std::shared_ptr<const Effect> restrictedTo(
      const std::vector<Eigen::Index>& bodies) const override {
    Wrenches some;
    some.setZero(static_cast<Eigen::Index>(bodies.size()));
    for (std::size_t k = 0; k < bodies.size(); ++k) {
      const auto row = static_cast<Eigen::Index>(k);
      some.f_W.row(row) = wrenches_.f_W.row(bodies[k]);
      some.t_Bcm_W.row(row) = wrenches_.t_Bcm_W.row(bodies[k]);
    }
    return std::make_shared<Pushes>(std::move(some));
  }

 private:
  Wrenches wrenches_;
};

std::vector<std::shared_ptr<const Effect>> effectsOf(const Scene& scene, bool has_pushes) {
  std::vector<std::shared_ptr<const Effect>> effects;
  if (scene.load.has_gravity) {
    std::vector<Eigen::Index> all(static_cast<std::size_t>(scene.bodies.count()));
    std::iota(all.begin(), all.end(), 0);
    effects.push_back(uniformGravity(scene.g_W, std::move(all)));
  }
  if (has_pushes) effects.push_back(std::make_shared<Pushes>(*scene.wrenches));
  return effects;
}

Motion motionOf(const Bodies& bodies, Eigen::Index i) {
  const BodyState state = bodies.state(i);
  return {state.p_WBcm, state.q_WB, velocity(state, bodies.mass(i)),
          angularVelocity(state, bodies.moments(i))};
}

/// An integrator, its bodies, and what acts on them.
struct Bare {
  Bodies start;
  Bodies bodies;
  std::vector<std::shared_ptr<const Effect>> effects;
  ActiveEffects active;
  std::unique_ptr<Integrator> integrator;
  double step_s;
  double time_s = 0;
};

Peer makeBare(const std::string& name, const Scene& scene) {
  const auto it = std::make_shared<Bare>();
  it->start = it->bodies = scene.bodies;
  it->effects = effectsOf(scene, scene.load.has_wrenches);
  for (const auto& effect : it->effects) it->active.add(effect.get());
  IntegratorOptions options;
  if (scene.load.gyroscopic == Gyroscopic::kOff)
    for (Eigen::Index i = 0; i < scene.bodies.count(); ++i) options.ungyroscopic.push_back(i);
  it->integrator = integratorNamed(name).make(options);
  it->step_s = scene.step_s;
  return {[it] {
            it->bodies = it->start;
            it->time_s = 0;
          },
          [it](int steps) {
            for (int k = 0; k < steps; ++k) {
              it->integrator->step(it->bodies, it->active, it->time_s, it->step_s);
              it->time_s += it->step_s;
            }
          },
          [it](Eigen::Index i) { return motionOf(it->bodies, i); }};
}

Simulator makeSimulator(const std::string& name, const Scene& scene, bool has_pushes) {
  rigid_body_sim::Scene simulated;
  simulated.step_ns = static_cast<std::int64_t>(std::llround(scene.step_s * 1e9));
  simulated.integrator = name;
  simulated.threads = 1;
  simulated.gyroscopic = scene.load.gyroscopic;
  simulated.effects = effectsOf(scene, has_pushes);
  for (Eigen::Index i = 0; i < scene.bodies.count(); ++i) {
    const BodyState state = scene.bodies.state(i);
    SceneBody body;
    body.name = "body" + std::to_string(i);
    body.mass_properties.mass = scene.bodies.mass(i);
    body.mass_properties.I_BBcm_F = scene.bodies.moments(i).asDiagonal();
    body.X_WL.linear() = state.q_WB.toRotationMatrix();
    body.X_WL.translation() = state.p_WBcm;
    body.v_WBcm = scene.v_WBcm(i);
    body.w_WB_L = scene.w_WB_B(i);
    simulated.bodies.push_back(std::move(body));
  }
  return Simulator(std::move(simulated));
}

Peer makeSimulated(const std::string& name, const Scene& scene) {
  const auto it = std::make_shared<Simulator>(makeSimulator(name, scene, scene.load.has_wrenches));
  return {[it] { it->reset(); }, [it](int steps) { it->advance(steps); },
          [it](Eigen::Index i) { return motionOf(it->bodies(), i); }};
}

/// Every wrench as an input of its own, for one tick, as messages bring them.
Peer makeWithInputs(const std::string& name, const Scene& scene) {
  const auto it = std::make_shared<Simulator>(makeSimulator(name, scene, false));
  const std::shared_ptr<const Wrenches> wrenches = scene.wrenches;
  return {[it] { it->reset(); },
          [it, wrenches](int steps) {
            WrenchInput input;
            input.ticks = 1;
            for (int k = 0; k < steps; ++k) {
              for (input.body = 0; input.body < it->bodies().count(); ++input.body) {
                input.applied.wrench = {wrenches->f_W.row(input.body),
                                        wrenches->t_Bcm_W.row(input.body)};
                it->apply(input);
              }
              it->step();
            }
          },
          [it](Eigen::Index i) { return motionOf(it->bodies(), i); }};
}

}  // namespace

std::vector<PeerRow> peerRows() {
  std::vector<PeerRow> rows;
  const std::string engine = "rigid_body_sim";
  for (const IntegratorRow& rung : integrators())
    rows.push_back({engine, rung.name, "the integrator on bare `Bodies`",
                    [name = rung.name](const Scene& scene) { return makeBare(name, scene); }});
  for (const IntegratorRow& rung : integrators())
    rows.push_back({engine, rung.name + ", Simulator", "`Simulator::advance`",
                    [name = rung.name](const Scene& scene) { return makeSimulated(name, scene); }});
  PeerRow inputs = {engine, "exact, Simulator, inputs", "every wrench a `Simulator::apply`",
                    [](const Scene& scene) { return makeWithInputs("exact", scene); }};
  inputs.needs_wrenches = true;
  rows.push_back(inputs);
  return rows;
}

}  // namespace rigid_body_sim::bench

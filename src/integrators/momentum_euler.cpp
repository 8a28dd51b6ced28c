// Euler's methods on the founding text's state (x, q, P, L). As L is kept, and not the angular
// velocity, nothing can become infinite: the energy of a free body stays below |L|^2 / 2 I1.
#include "integrators/drift.hpp"
#include "integrators/families.hpp"
#include "integrators/kick.hpp"

namespace rigid_body_sim {
namespace {

/// The pose moves with the momenta before the kick, at the constant rate of the beginning.
class ExplicitEuler : public Integrator {
 public:
  explicit ExplicitEuler(const IntegratorOptions& options)
      : drift_(batch::kernels().driftAtConstantRate, options) {}

  void step(Bodies& bodies, ActiveEffects& effects, double time_s, double h) override {
    const Wrenches* wrenches =
        effects.hasKicks() ? &effects.evaluateKicks(bodies, time_s, h) : nullptr;
    driftWithFlows(bodies, effects, time_s, h, [&] { drift_(bodies, nullptr, h); });
    if (wrenches) kick(bodies, *wrenches, h);
  }

 private:
  Drift drift_;
};

/// With those after it.
class SemiImplicit : public Integrator {
 public:
  explicit SemiImplicit(const IntegratorOptions& options)
      : drift_(batch::kernels().driftAtConstantRate, options) {}

  void step(Bodies& bodies, ActiveEffects& effects, double time_s, double h) override {
    const Wrenches* wrenches =
        effects.hasKicks() ? &effects.evaluateKicks(bodies, time_s, h) : nullptr;
    if (!effects.hasFlows()) return drift_(bodies, wrenches, h);
    if (wrenches) kick(bodies, *wrenches, h);
    driftWithFlows(bodies, effects, time_s, h, [&] { drift_(bodies, nullptr, h); });
  }

 private:
  Drift drift_;
};

}  // namespace

std::unique_ptr<Integrator> makeExplicitEuler(const IntegratorOptions& options) {
  return std::make_unique<ExplicitEuler>(options);
}

std::unique_ptr<Integrator> makeSemiImplicit(const IntegratorOptions& options) {
  return std::make_unique<SemiImplicit>(options);
}

}  // namespace rigid_body_sim

// Euler's methods on the founding text's state (x, q, P, L). As L is kept, and not the angular
// velocity, nothing can become infinite: the energy of a free body stays below |L|^2 / 2 I1.
#include "integrators/drift.hpp"
#include "integrators/families.hpp"
#include "integrators/kick.hpp"

namespace rigid_body_sim {
namespace {

enum class PoseMovesWith { kOldMomentum, kNewMomentum };

/// At the constant rate of the beginning.
template <PoseMovesWith pose_moves_with>
class MomentumEuler : public Integrator {
 public:
  explicit MomentumEuler(const IntegratorOptions& options)
      : drift_(batch::kernels().driftAtConstantRate, options) {}

  void step(Bodies& bodies, ActiveEffects& effects, double time_s, double h) override {
    constexpr bool kicks_first = pose_moves_with == PoseMovesWith::kNewMomentum;
    const Wrenches* wrenches =
        effects.hasKicks() ? &effects.evaluateKicks(bodies, time_s, h) : nullptr;
    if (kicks_first && !effects.hasFlows()) return drift_(bodies, wrenches, h);
    if (kicks_first && wrenches) kick(bodies, *wrenches, h);
    driftWithFlows(bodies, effects, time_s, h, [&] { drift_(bodies, nullptr, h); });
    if (!kicks_first && wrenches) kick(bodies, *wrenches, h);
  }

 private:
  Drift drift_;
};

}  // namespace

std::unique_ptr<Integrator> makeExplicitEuler(const IntegratorOptions& options) {
  return std::make_unique<MomentumEuler<PoseMovesWith::kOldMomentum>>(options);
}

std::unique_ptr<Integrator> makeSemiImplicit(const IntegratorOptions& options) {
  return std::make_unique<MomentumEuler<PoseMovesWith::kNewMomentum>>(options);
}

}  // namespace rigid_body_sim

// Euler's methods on the founding text's state (x, q, P, L). As L is kept, and not the angular
// velocity, nothing can become infinite: the energy of a free body stays below |L|^2 / 2 I1.
#include "integrators/drift.hpp"
#include "integrators/families.hpp"
#include "integrators/kick.hpp"

namespace rigid_body_sim {
namespace {

/// At the constant rate of the beginning, w = R I^-1 R^T L.
struct ConstantRate {
  Quaterniond operator()(const BodyState& body, const Vector3d& I, double h) const {
    return renormalized(body.q_WB * rotationExp(h * angularVelocityInBody(body, I)));
  }
};

enum class PoseMovesWith { kOldMomentum, kNewMomentum };

template <PoseMovesWith pose_moves_with>
struct MomentumEuler {
  template <Gyroscopic gyroscopic>
  class Method : public Integrator {
   public:
    explicit Method(const IntegratorOptions& options) : ungyroscopic_(options.ungyroscopic) {}

    void step(Bodies& bodies, ActiveEffects& effects, double time_s, double h) override {
      const Wrenches* wrenches =
          effects.hasKicks() ? &effects.evaluateKicks(bodies, time_s, h) : nullptr;
      if (wrenches && pose_moves_with == PoseMovesWith::kNewMomentum) kick(bodies, *wrenches, h);
      driftWithFlows(bodies, effects, time_s, h,
                     [&] { drift<ConstantRate>(bodies, h, ungyroscopic_); });
      if (wrenches && pose_moves_with == PoseMovesWith::kOldMomentum) kick(bodies, *wrenches, h);
    }

   private:
    Ungyroscopic<gyroscopic> ungyroscopic_;
  };
};

template <PoseMovesWith pose_moves_with>
std::unique_ptr<Integrator> make(const IntegratorOptions& options) {
  return makeFor<MomentumEuler<pose_moves_with>::template Method>(options);
}

}  // namespace

std::unique_ptr<Integrator> makeExplicitEuler(const IntegratorOptions& options) {
  return make<PoseMovesWith::kOldMomentum>(options);
}

std::unique_ptr<Integrator> makeSemiImplicit(const IntegratorOptions& options) {
  return make<PoseMovesWith::kNewMomentum>(options);
}

}  // namespace rigid_body_sim

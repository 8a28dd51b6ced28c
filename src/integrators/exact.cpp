#include "integrators/exact_rotation.hpp"
#include "integrators/families.hpp"
#include "integrators/kick_drift_kick.hpp"

namespace rigid_body_sim {
namespace {

/// Without torque right to rounding at any step.
struct ExactRotation {
  Quaterniond operator()(const BodyState& body, const Vector3d& I, double h) const {
    const Vector3d m_B = body.q_WB.conjugate() * body.L_WBcm_W;
    return renormalized(body.q_WB * exactRotation(m_B, I, h).q_BBnext);
  }
};

}  // namespace

std::unique_ptr<Integrator> makeExact(const IntegratorOptions& options) {
  return makeKickDriftKick<ExactRotation>(options);
}

}  // namespace rigid_body_sim

#pragma once

#include "integrators/ungyroscopic.hpp"
#include "rigid_body_sim/rotation.hpp"

namespace rigid_body_sim {

/// Without w x I w the angular velocity keeps its world components; L follows from it. Going from L
/// to w and back each step costs 2.6e-16 of w a step, always to the same side.
inline void freeSpinWithoutGyroscopicTerm(BodyState& body, const Vector3d& I, double h) {
  const Vector3d w_WB = angularVelocity(body, I);
  body.q_WB = renormalized(rotationExp(h * w_WB) * body.q_WB);
  body.L_WBcm_W = body.q_WB * I.cwiseProduct(body.q_WB.conjugate() * w_WB);
}

/// Drift: free motion for h [s], in which P and L do not change. `Rotation` gives the attitude
/// after it, from the state, the principal moments and h.
template <class Rotation, Gyroscopic gyroscopic>
void drift(Bodies& bodies, double h, const Ungyroscopic<gyroscopic>& ungyroscopic) {
  for (Eigen::Index i = 0; i < bodies.count(); ++i) {
    BodyState body = bodies.state(i);
    body.p_WBcm += (h / bodies.mass(i)) * body.P_WB;
    // Without spin, as a point mass always is, there is no rotation to compute.
    if (!body.L_WBcm_W.isZero(0)) {
      if (ungyroscopic.has(i))
        freeSpinWithoutGyroscopicTerm(body, bodies.moments(i), h);
      else
        body.q_WB = Rotation()(body, bodies.moments(i), h);
    }
    bodies.setState(i, body);
  }
}

}  // namespace rigid_body_sim

#pragma once

#include "rigid_body_sim/bodies.hpp"
#include "rigid_body_sim/wrench.hpp"

namespace rigid_body_sim {

/// Kinetic energy [J]: P.P/2m + sum m_i^2/2I_i, with m = R^T L the angular momentum in body axes.
inline double kineticEnergy(const BodyState& body, double mass, const Vector3d& I_BBcm_B) {
  const Vector3d L_B = body.q_WB.conjugate() * body.L_WBcm_W;
  return 0.5 * body.P_WB.squaredNorm() / mass +
         0.5 * L_B.cwiseProduct(L_B).cwiseQuotient(I_BBcm_B).sum();
}

/// Kinetic energy of body i [J], with the mass that it carries along.
inline double kineticEnergy(const Bodies& bodies, Eigen::Index i) {
  const BodyState body = bodies.state(i);
  const Vector3d L_B = body.q_WB.conjugate() * body.L_WBcm_W;
  return 0.5 * body.P_WB.dot(bodies.v_WBcm(i)) +
         0.5 * L_B.cwiseProduct(L_B).cwiseQuotient(bodies.moments(i)).sum();
}

/// Kinetic energy of all bodies [J].
inline double kineticEnergy(const Bodies& bodies) {
  double sum = 0;
  for (Eigen::Index i = 0; i < bodies.count(); ++i) sum += kineticEnergy(bodies, i);
  return sum;
}

/// Angular momentum [kg m^2/s] about the point O at p_WO [m], in W: spin plus p_OBcm x P.
inline Vector3d angularMomentumAboutPoint(const BodyState& body, const Vector3d& p_WO) {
  return body.L_WBcm_W + momentAboutPoint(body.p_WBcm - p_WO, body.P_WB);
}

/// Angular momentum [kg m^2/s] about the axis through O along `direction` (any length but zero):
/// the component along the axis, as a vector.
inline Vector3d angularMomentumAboutAxis(const BodyState& body, const Vector3d& p_WO,
                                         const Vector3d& direction) {
  return angularMomentumAboutPoint(body, p_WO).dot(direction) / direction.squaredNorm() * direction;
}

}  // namespace rigid_body_sim

#pragma once

#include "rigid_body_sim/conventions.hpp"

namespace rigid_body_sim {

/// State of one rigid body: the founding text's own X = (x, q, P, L), of the centre of mass.
struct BodyState {
  Vector3d p_WBcm = Vector3d::Zero();          ///< [m]
  Quaterniond q_WB = Quaterniond::Identity();  ///< unit
  Vector3d P_WB = Vector3d::Zero();            ///< linear momentum [kg m/s]
  Vector3d L_WBcm_W = Vector3d::Zero();        ///< angular momentum about Bcm [kg m^2/s]
  Vector3d p_low = Vector3d::Zero();           ///< what rounding left of p_WBcm, see move() [m]
};

/// p_WBcm += way [m]. Below half an ulp of the position a way would be lost, each step's anew and
/// to the same side: what is left over is kept for the next one, so that p_WBcm is the sum of all
/// ways rounded once (two-sum, D.E. Knuth, The Art of Computer Programming 2, 4.2.2).
inline void move(BodyState& body, const Vector3d& way) {
  const Vector3d all = body.p_low + way;
  const Vector3d sum = body.p_WBcm + all;
  const Vector3d added = sum - body.p_WBcm;
  body.p_low = (body.p_WBcm - (sum - added)) + (all - added);
  body.p_WBcm = sum;
}

/// Velocity of the centre of mass v_WBcm [m/s] = P / m.
inline Vector3d velocity(const BodyState& body, double mass) { return body.P_WB / mass; }

/// Angular velocity w_WB_B [rad/s] in body axes, for principal moments I_BBcm_B [kg m^2].
inline Vector3d angularVelocityInBody(const BodyState& body, const Vector3d& I_BBcm_B) {
  return (body.q_WB.conjugate() * body.L_WBcm_W).cwiseQuotient(I_BBcm_B);
}

/// Angular velocity w_WB [rad/s] in world axes: R I^-1 R^T L.
inline Vector3d angularVelocity(const BodyState& body, const Vector3d& I_BBcm_B) {
  return body.q_WB * angularVelocityInBody(body, I_BBcm_B);
}

/// Velocity v_WQ [m/s] of the body point Q at p_BcmQ_W [m] from the centre of mass:
/// v + w x r (founding text, section 2).
inline Vector3d velocityOfPoint(const Vector3d& v_WBcm, const Vector3d& w_WB,
                                const Vector3d& p_BcmQ_W) {
  return v_WBcm + w_WB.cross(p_BcmQ_W);
}

/// True if every component is finite.
inline bool isFinite(const BodyState& body) {
  return body.p_WBcm.allFinite() && body.q_WB.coeffs().allFinite() && body.P_WB.allFinite() &&
         body.L_WBcm_W.allFinite();
}

}  // namespace rigid_body_sim

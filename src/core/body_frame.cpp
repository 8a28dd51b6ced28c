#include "rigid_body_sim/body_frame.hpp"

#include <stdexcept>

namespace rigid_body_sim {

BodyFrame bodyFrame(const MassProperties& body_L) {
  const std::string why = invalidity(body_L);
  if (!why.empty()) throw std::invalid_argument(why);
  const PrincipalInertia principal = principalInertia(body_L.I_BBcm_F);
  return {body_L.mass, principal.I_BBcm_B, body_L.p_FBcm, principal.q_FB};
}

BodyState stateOfLink(const BodyFrame& frame, const Isometry3d& X_WL, const Vector3d& v_WBcm,
                      const Vector3d& w_WB_L) {
  BodyState body;
  body.p_WBcm = X_WL * frame.p_LBcm;
  body.q_WB = (Quaterniond(X_WL.linear()) * frame.q_LB).normalized();
  body.P_WB = frame.mass * v_WBcm;
  const Vector3d w_WB_B = frame.q_LB.conjugate() * w_WB_L;
  body.L_WBcm_W = body.q_WB * frame.I_BBcm_B.cwiseProduct(w_WB_B);
  return body;
}

LinkMotion linkMotion(const BodyFrame& frame, const BodyState& body) {
  LinkMotion link;
  link.q_WL = body.q_WB * frame.q_LB.conjugate();
  link.p_WL = body.p_WBcm - link.q_WL * frame.p_LBcm;
  link.w_WL_L = frame.q_LB * angularVelocityInBody(body, frame.I_BBcm_B);
  const Vector3d v_WBcm_L = link.q_WL.conjugate() * velocity(body, frame.mass);
  link.v_WL_L = velocityOfPoint(v_WBcm_L, link.w_WL_L, -frame.p_LBcm);
  return link;
}

}  // namespace rigid_body_sim

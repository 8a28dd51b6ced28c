#include "rigid_body_sim/body_frame.hpp"

#include <stdexcept>

namespace rigid_body_sim {

BodyFrame bodyFrame(const MassProperties& body_L, const AddedMass& added_L) {
  const std::string why = invalidity(body_L);
  if (!why.empty()) throw std::invalid_argument(why);
  Matrix3d I_BBcm_L = body_L.I_BBcm_F;
  if (!added_L.isZero()) I_BBcm_L.diagonal() += added_L.angular_F;
  const PrincipalInertia principal = principalInertia(I_BBcm_L);
  BodyFrame frame = {body_L.mass, principal.I_BBcm_B, body_L.p_FBcm, principal.q_FB};
  if (added_L.linear_F.isZero(0)) return frame;
  frame.has_added_mass = true;
  const Vector3d masses_L = Vector3d::Constant(body_L.mass) + added_L.linear_F;
  const Matrix3d R_LB = frame.q_LB.toRotationMatrix();
  if (masses_L == Vector3d::Constant(masses_L(0)))  // to the bit: P and v are parallel then
    frame.mass_matrix_B = masses_L.asDiagonal();
  else
    frame.mass_matrix_B = R_LB.transpose() * masses_L.asDiagonal() * R_LB;
  return frame;
}

BodyState stateOfLink(const BodyFrame& frame, const Isometry3d& X_WL, const Vector3d& v_WBcm,
                      const Vector3d& w_WB_L) {
  BodyState body;
  body.p_WBcm = X_WL * frame.p_LBcm;
  body.q_WB = (Quaterniond(X_WL.linear()) * frame.q_LB).normalized();
  if (frame.has_added_mass)
    body.P_WB = body.q_WB * (frame.mass_matrix_B * (body.q_WB.conjugate() * v_WBcm));
  else
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
  const Vector3d v_WBcm_L =
      frame.has_added_mass ? Vector3d(frame.q_LB * frame.mass_matrix_B.llt().solve(
                                                       body.q_WB.conjugate() * body.P_WB))
                           : Vector3d(link.q_WL.conjugate() * velocity(body, frame.mass));
  link.v_WL_L = velocityOfPoint(v_WBcm_L, link.w_WL_L, -frame.p_LBcm);
  return link;
}

}  // namespace rigid_body_sim

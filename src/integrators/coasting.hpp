#pragma once

#include "integrators/orbit.hpp"

namespace rigid_body_sim {

/// Free rotation in equal steps. All of exactRotation() but the phase depends only on |m|, energy
/// and step: that is worked out once, and a step is one addition theorem of sn, cn, dn and one
/// product of complex numbers, without any trigonometric or elliptic function.
///
/// What is stepped is the phase on the orbit, not the momentum: the map of the momentum is unstable
/// off its own orbit, that of the phase stays on it by construction. Nothing is read back from the
/// attitude, so its rounding does not add up.
class Coasting {
 public:
  /// A body at rest.
  Coasting() = default;

  /// @param q_WB unit; @param m_B angular momentum in body axes [kg m^2/s], not zero; @param I
  /// principal moments, ascending [kg m^2]; @param h the step [s], any sign.
  Coasting(const Quaterniond& q_WB, const Vector3d& m_B, const Vector3d& I, double h);

  /// One step on; gives the attitude after it.
  void step(Quaterniond& q_WB);

  /// Angular momentum in body axes [kg m^2/s].
  Vector3d m_B() const;

 private:
  // Constants. The momentum's axis E is that of body axis d, with the momentum's sign there; with
  // d_ = 1, for bodies that turn about a fixed axis, it is that axis itself.
  int d_ = 1;
  double sign_d_ = 1;
  Vector3d axis_B_ = Vector3d::Zero();
  double G_ = 0;
  Quaterniond q_WE_ = Quaterniond::Identity();
  HalfAngle turn_;                      // a step's about E, but for the angle between the momenta
  double sn_ = 0, cn_ = 1, dn_ = 1;     // of a step
  double k2cn2_ = 0, kc2_ = 0;          // modulus
  double B_d_ = 0, B_c_ = 0, B_2_ = 0;  // momentum = G (B_d dn, B_c cn, B_2 sn), signs included
  double num_ = 0, den_ = 0, cross_ = 0, dot_ = 0;  // of the angle between the momenta

  // What moves.
  double s_ = 0, c_ = 1, d1_ = 1;  // sn, cn, dn of the phase
  HalfAngle psi_;                  // turned about E so far
};

}  // namespace rigid_body_sim

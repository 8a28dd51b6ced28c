#pragma once

#include "integrators/orbit.hpp"

namespace rigid_body_sim {

/// What a torque-free body does in some time.
struct FreeRotation {
  Quaterniond q_BBnext;  ///< attitude after, in the body's axes before: q_WB' = q_WB q_BBnext
  Vector3d m_B;          ///< angular momentum after, in the body's axes after [kg m^2/s]
};

/// The free rotation of a body with the principal moments I1 <= I2 <= I3 [kg m^2] and the angular
/// momentum m_B [kg m^2/s] in its axes, for h [s] (any sign): exact up to rounding, in all cases.
///
/// Jacobi's solution in addition-theorem form: momentum and attitude after h follow from those
/// before and sn, cn, dn of one argument, without ever inverting for the phase. It works on the
/// momentum of unit length, so that nothing over- or underflows, and it has no case that divides by
/// zero: spheres, symmetric bodies, principal axes, the separatrix and rest are limits of the same
/// formulas. Every sum in it is of terms of one sign or of order one, so its error is a few
/// roundings of the inputs' own sensitivity. Elliptic solution: Jacobi 1849; van Zon and Schofield,
/// J. Comput. Phys. 225 (2007) 145; Celledoni, Fasso, Safstrom and Zanna, SIAM J. Sci. Comput. 30
/// (2008) 2084.
FreeRotation exactRotation(const Vector3d& m_B, const Vector3d& I, double h);

/// The same with InverseMoments(I), which need not be worked out each time.
FreeRotation exactRotation(const Vector3d& m_B, const Vector3d& I, const InverseMoments& a,
                           double h);

}  // namespace rigid_body_sim

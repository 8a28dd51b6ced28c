#pragma once

#include <string>
#include <vector>

#include "rigid_body_sim/conventions.hpp"

namespace rigid_body_sim {

/// Mass, centre of mass and inertia tensor of a rigid body, given in a frame F fixed to it.
struct MassProperties {
  double mass = 0;                     ///< [kg]
  Vector3d p_FBcm = Vector3d::Zero();  ///< centre of mass from F's origin [m], in F
  Matrix3d I_BBcm_F =
      Matrix3d::Zero();  ///< about the centre of mass, in F's axes [kg m^2];
                         ///< off-diagonal elements are MINUS the products of inertia
};

/// A point mass at p_FQ [m] in frame F.
struct Particle {
  double mass = 0;  ///< [kg]
  Vector3d p_FQ = Vector3d::Zero();
};

/// Mass properties of rigidly connected particles: sums of m, m p and m (p.p E - p p^T).
/// @throws std::invalid_argument for no particle, or a mass that is not positive and finite.
MassProperties massPropertiesOfParticles(const std::vector<Particle>& particles);

/// Uniform solid box with edges `size` [m] along F's axes, centred at F's origin; density [kg/m^3].
/// @throws std::invalid_argument for a size or density that is not positive and finite.
MassProperties solidBox(const Vector3d& size, double density);

/// Uniform solid sphere of `radius` [m], centred at F's origin; density [kg/m^3].
/// @throws std::invalid_argument for a radius or density that is not positive and finite.
MassProperties solidSphere(double radius, double density);

/// Uniform solid cylinder along F's z axis, of `radius` and `length` [m], centred at F's origin;
/// density [kg/m^3].
/// @throws std::invalid_argument for a dimension or density that is not positive and finite.
MassProperties solidCylinder(double radius, double length, double density);

/// The same body seen from frame G, where X_GF is the pose of F in G.
MassProperties expressedIn(const Isometry3d& X_GF, const MassProperties& body_F);

/// One rigid body made of rigidly connected `parts`, all given in the same frame: masses add, the
/// centre of mass is the weighted mean, tensors are shifted to it (parallel-axis theorem) and add.
/// Parts of zero mass contribute nothing. The result has zero mass if all parts have.
MassProperties combined(const std::vector<MassProperties>& parts);

/// Parallel-axis theorem: inertia tensor about the point Q at p_FQ [m], in F's axes [kg m^2].
Matrix3d inertiaAboutPoint(const MassProperties& body, const Vector3d& p_FQ);

/// Moment of inertia [kg m^2] about the axis through Q at p_FQ [m] along `direction` (any length
/// but zero), in F. @throws std::invalid_argument for a zero or non-finite direction.
double inertiaAboutAxis(const MassProperties& body, const Vector3d& p_FQ,
                        const Vector3d& direction);

/// Perpendicular-axis theorem: a flat lamina's moment about the axis normal to it, from the moments
/// about two perpendicular axes in its plane that meet that axis [kg m^2].
inline double laminaNormalInertia(double in_plane_x, double in_plane_y) {
  return in_plane_x + in_plane_y;
}

/// Principal moments in ascending order, and the principal axes B that belong to them.
struct PrincipalInertia {
  Vector3d I_BBcm_B = Vector3d::Zero();  ///< I1 <= I2 <= I3, the tensor's diagonal in B [kg m^2]
  Quaterniond q_FB = Quaterniond::Identity();  ///< I_BBcm_F = R_FB diag(I_BBcm_B) R_FB^T
};

/// Diagonalises a symmetric tensor [kg m^2]. The moments ascend, which spares the integrators every
/// case distinction; of the sign choices left, the one with the smallest rotation from F is taken.
/// A diagonal tensor in ascending order gives the identity.
PrincipalInertia principalInertia(const Matrix3d& I_BBcm_F);

/// Why no rigid body has these mass properties; empty if one has. Checked: mass finite and > 0,
/// finite centre of mass, finite symmetric tensor, positive principal moments (in a full tensor:
/// above its rounding), and the triangle inequality I1 + I2 >= I3 with a relative slack of 1e-6
/// (URDF files carry rounded numbers).
std::string invalidity(const MassProperties& body);

/// The valid tensor with the same principal axes and the least change of the second moments
/// sum m x^2: those that are negative become zero. Meant as a suggestion in messages.
Matrix3d nearestValidInertia(const Matrix3d& I_BBcm_F);

}  // namespace rigid_body_sim

#pragma once

#include <cmath>

#include "integrators/jacobi.hpp"
#include "rigid_body_sim/conventions.hpp"
#include "rigid_body_sim/rotation.hpp"

namespace rigid_body_sim {

/// What free rotation needs of the principal moments I1 <= I2 <= I3 [kg m^2].
struct InverseMoments {
  double a2;   ///< 1/I2 [1/(kg m^2)]
  double a13;  ///< 1/I1 - 1/I3 [1/(kg m^2)]
  double d12;  ///< (1/I1 - 1/I2) / a13, zero for a sphere
  double d23;  ///< (1/I2 - 1/I3) / a13, zero for a sphere

  explicit InverseMoments(const Vector3d& I);
};

/// Constants of a free rotation, for momentum of unit length and time in units of 1/(a13 |L|), so
/// that they are pure numbers of moderate size. The momentum circles around the body axis d (1 or
/// 3), whose component never changes sign; c is the other outer axis, 2 the middle one.
struct Orbit {
  int d, c;        ///< indices 0 or 2
  double dc, dd;   ///< differences of inverse moments: the middle one's to that of c and of d
  double S;        ///< m1^2 d12 - m3^2 d23: on which side of the separatrix
  double W, R;     ///< conserved; R = 0 on a principal axis
  double lambda;   ///< rate of the elliptic argument
  double k2, kc2;  ///< modulus

  /// A sphere, or a body that spins about a principal axis: it turns about a fixed axis.
  bool isFixedAxis() const { return lambda == 0 || R == 0; }
};

/// Of the direction m of the momentum.
Orbit orbitOf(const Vector3d& m, const InverseMoments& a);

/// Length G of a vector of any size, and its direction.
struct Direction {
  double G;
  Vector3d m;

  explicit Direction(const Vector3d& vector);
};

/// What one step of an orbit takes.
struct OrbitStep {
  double sn, cn, dn;  ///< of its elliptic argument; whole half periods are folded into the signs
  HalfAngle slow;     ///< what the body turns about L beyond a2 |m| h and the angle between momenta
};

/// @param time the step in the orbit's own unit, any sign
OrbitStep orbitStep(const Orbit& orbit, double time);

/// Product of two unit complex numbers.
inline HalfAngle operator*(const HalfAngle& a, const HalfAngle& b) {
  return {a.cos * b.cos - a.sin * b.sin, a.cos * b.sin + a.sin * b.cos};
}

/// The same direction, of unit length.
inline HalfAngle normalized(const HalfAngle& a) {
  const double scale = 1 / std::sqrt(a.cos * a.cos + a.sin * a.sin);
  return {scale * a.cos, scale * a.sin};
}

/// Half of the argument of the complex number (re, im), not zero, but for its length: the direction
/// of the root, which takes no trigonometric function.
inline HalfAngle rootDirection(double re, double im) {
  // sqrt(z) is along z + |z|; where that cancels, along i (|z| - re) + im instead.
  const double sum = std::sqrt(re * re + im * im) + std::abs(re);
  if (re >= 0) return {sum, im};
  return {std::abs(im), std::copysign(sum, im)};
}

}  // namespace rigid_body_sim

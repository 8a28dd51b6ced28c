#pragma once

#include "integrators/batch/vectors.hpp"

// The last part of rk4's step: setRotation() of body_momentum.hpp, for packs and without roots.
namespace rigid_body_sim::batch {
namespace {

/// The momentum R m_B that a step leads to, the one that it is to have, and how well they agree.
template <class S>
struct Agreement {
  Vector<S> now, wanted;
  S cosine;  ///< times both lengths
  typename MaskOf<S>::Type turns;
};

/// As in body_momentum.hpp.
constexpr double kLeastDirected = 1e-290;

/// Within, products of two components keep their digits.
constexpr double kLeastProduct = 1e-280, kLargestProduct = 1e280;

/// Scales the vectors of those that are not `is_ordinary` by powers of two, so that they can be
/// compared; those that cannot be, nor turned, become zero, with the cosine 1. Scaled ones are of
/// about unit length: a cosine below 1e-3 is one of vectors far apart.
template <class M, class S>
[[gnu::cold, gnu::noinline]] Agreement<S> withExtremesScaled(M is_ordinary, Vector<S> before,
                                                             Agreement<S> a) {
  const S now = largest(a.now), wanted = largest(a.wanted);
  const auto is_directed =
      (wanted > 0.1 * largest(before)) & (wanted > kLeastDirected) & (now > kLeastDirected);
  a.now = select(is_ordinary, a.now, inversePower(now) * a.now);
  a.wanted = select(is_ordinary, a.wanted, inversePower(wanted) * a.wanted);
  a.cosine = dot(a.now, a.wanted);
  a.turns = (is_ordinary & a.turns) | ((is_directed & (a.cosine > 1e-3)) & !is_ordinary);
  const auto is_left = !(a.turns | is_ordinary);
  const S none(0.0);
  a.now = select(is_left, {none, none, none}, a.now);
  a.cosine = select(is_left, S(1.0), a.cosine);
  return a;
}

/// q / |q| of a quaternion whose squared length is within 1e-4 of 1.
template <class S>
RBS_INLINE Quaternion<S> normalized(const Quaternion<S>& q) {
  const S e = squaredNorm(q) - 1;
  return scaled(1 + e * (-0.5 + e * (0.375 + e * -0.3125)), q);
}

/// `q_WB`, of unit length but for rounding, turned by the shortest way so that R m comes onto L,
/// and normalised. Not turned where little is left of the momentum before, m1_B, or if it would be
/// more than 0.014 rad.
template <class S>
RBS_INLINE Quaternion<S> aligned(const Quaternion<S>& q_WB, const Vector<S>& m1_B,
                                 const Vector<S>& m_B, const Vector<S>& L_W) {
  Agreement<S> a;
  a.now = rotated(q_WB, m_B);
  a.wanted = L_W;
  a.cosine = dot(a.now, a.wanted);
  a.turns = a.cosine > 0.01 * dot(m1_B, m1_B);
  const auto is_ordinary = (a.cosine > kLeastProduct) & (a.cosine < kLargestProduct);
  if (__builtin_expect(!all(is_ordinary), 0)) a = withExtremesScaled(is_ordinary, m1_B, a);
  // With t = tan(angle): tan(angle / 2) / t = 1 / (1 + root(1 + t^2)), as a series.
  const Vector<S> tangent = (1 / a.cosine) * cross(a.now, a.wanted);
  const S t2 = dot(tangent, tangent);
  const S half = 0.5 + t2 * (-0.125 + t2 * (0.0625 + t2 * -0.0390625));
  const S none(0.0);
  const Vector<S> u = select(a.turns & (t2 < 2e-4), half * tangent, Vector<S>{none, none, none});
  // The product with the quaternion (u, 1).
  return normalized(Quaternion<S>{q_WB.x + (u.x * q_WB.w + u.y * q_WB.z - u.z * q_WB.y),
                                  q_WB.y + (u.y * q_WB.w + u.z * q_WB.x - u.x * q_WB.z),
                                  q_WB.z + (u.z * q_WB.w + u.x * q_WB.y - u.y * q_WB.x),
                                  q_WB.w - (u.x * q_WB.x + u.y * q_WB.y + u.z * q_WB.z)});
}

}  // namespace
}  // namespace rigid_body_sim::batch

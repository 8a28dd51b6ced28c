#pragma once

#include "integrators/batch/functions.hpp"

namespace rigid_body_sim::batch {
namespace {

template <class S>
struct Vector {
  S x, y, z;
};

/// Hamilton's.
template <class S>
struct Quaternion {
  S x, y, z, w;
};

template <class S>
RBS_INLINE Vector<S> operator+(const Vector<S>& a, const Vector<S>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class S>
RBS_INLINE Vector<S> operator-(const Vector<S>& a, const Vector<S>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class S, class T>
RBS_INLINE Vector<S> operator*(T a, const Vector<S>& b) {
  return {a * b.x, a * b.y, a * b.z};
}
template <class S>
RBS_INLINE Vector<S> product(const Vector<S>& a, const Vector<S>& b) {
  return {a.x * b.x, a.y * b.y, a.z * b.z};
}
template <class S>
RBS_INLINE Vector<S> quotient(const Vector<S>& a, const Vector<S>& b) {
  return {a.x / b.x, a.y / b.y, a.z / b.z};
}
template <class S>
RBS_INLINE S dot(const Vector<S>& a, const Vector<S>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class S>
RBS_INLINE Vector<S> cross(const Vector<S>& a, const Vector<S>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class S>
RBS_INLINE auto isZero(const Vector<S>& a) {
  return (a.x == 0) & (a.y == 0) & (a.z == 0);
}
template <class M, class S>
RBS_INLINE Vector<S> select(M mask, const Vector<S>& a, const Vector<S>& b) {
  return {select(mask, a.x, b.x), select(mask, a.y, b.y), select(mask, a.z, b.z)};
}

template <class S>
RBS_INLINE Quaternion<S> operator*(const Quaternion<S>& a, const Quaternion<S>& b) {
  return {
      a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y, a.w * b.y + a.y * b.w + a.z * b.x - a.x * b.z,
      a.w * b.z + a.z * b.w + a.x * b.y - a.y * b.x, a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z};
}
template <class S>
RBS_INLINE Quaternion<S> scaled(S a, const Quaternion<S>& q) {
  return {a * q.x, a * q.y, a * q.z, a * q.w};
}
template <class S>
RBS_INLINE S squaredNorm(const Quaternion<S>& q) {
  return (q.x * q.x + q.y * q.y) + (q.z * q.z + q.w * q.w);
}
template <class M, class S>
RBS_INLINE Quaternion<S> select(M mask, const Quaternion<S>& a, const Quaternion<S>& b) {
  return {select(mask, a.x, b.x), select(mask, a.y, b.y), select(mask, a.z, b.z),
          select(mask, a.w, b.w)};
}

/// As rigid_body_sim::renormalized().
template <class S>
RBS_INLINE Quaternion<S> renormalized(const Quaternion<S>& q) {
  return scaled(1.5 - 0.5 * squaredNorm(q), q);
}

/// R v and R^T v of a unit quaternion, v + 2 w u x v + 2 u x (u x v) with u the vector part
/// (Rodrigues 1840).
template <class S>
RBS_INLINE Vector<S> rotated(const Quaternion<S>& q, const Vector<S>& v) {
  const Vector<S> u = {q.x, q.y, q.z};
  const Vector<S> t = 2 * cross(u, v);
  return v + q.w * t + cross(u, t);
}
template <class S>
RBS_INLINE Vector<S> rotatedBack(const Quaternion<S>& q, const Vector<S>& v) {
  const Vector<S> u = {q.x, q.y, q.z};
  const Vector<S> t = 2 * cross(u, v);
  return v - q.w * t + cross(u, t);
}

/// As rigid_body_sim::rotationExp().
template <class S>
RBS_INLINE Quaternion<S> rotationExp(const Vector<S>& r) {
  const CosSinc<S> f = cosSinc(0.25 * dot(r, r));
  const S half = 0.5 * f.sinc;
  return {half * r.x, half * r.y, half * r.z, f.cos};
}

/// Cosine and sine of half an angle.
template <class S>
struct HalfAngle {
  S cos;
  S sin;
};

template <class S>
RBS_INLINE HalfAngle<S> halfAngle(S angle) {
  const SinCos<S> f = sinCos(0.5 * angle);
  return {f.cos, f.sin};
}

/// The number that is largest in size, without its sign.
template <class S>
RBS_INLINE S largest(const Vector<S>& v) {
  const S x = magnitude(v.x), y = magnitude(v.y), z = magnitude(v.z);
  const S xy = select(x < y, y, x);
  return select(xy < z, z, xy);
}

/// Three or four columns, `stride` apart.
template <class Place>
RBS_INLINE auto loadVector(const Place& at, const double* columns, std::ptrdiff_t stride) {
  return Vector<decltype(at.load(columns))>{at.load(columns), at.load(columns + stride),
                                            at.load(columns + 2 * stride)};
}
template <class Place, class S>
RBS_INLINE void storeVector(const Place& at, double* columns, std::ptrdiff_t stride,
                            const Vector<S>& v) {
  at.store(columns, v.x);
  at.store(columns + stride, v.y);
  at.store(columns + 2 * stride, v.z);
}
template <class Place>
RBS_INLINE auto loadQuaternion(const Place& at, const double* columns, std::ptrdiff_t stride) {
  return Quaternion<decltype(at.load(columns))>{at.load(columns), at.load(columns + stride),
                                                at.load(columns + 2 * stride),
                                                at.load(columns + 3 * stride)};
}
template <class Place, class S>
RBS_INLINE void storeQuaternion(const Place& at, double* columns, std::ptrdiff_t stride,
                                const Quaternion<S>& q) {
  at.store(columns, q.x);
  at.store(columns + stride, q.y);
  at.store(columns + 2 * stride, q.z);
  at.store(columns + 3 * stride, q.w);
}

}  // namespace
}  // namespace rigid_body_sim::batch

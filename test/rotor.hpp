#pragma once

// The batch kernels' exact rotation, of one body.

#include "generic.hpp"
#include "integrators/batch/rotor.hpp"

namespace rigid_body_sim::batch {

inline Vector<double> toBatch(const Vector3d& v) { return {v.x(), v.y(), v.z()}; }
inline Vector3d fromBatch(const Vector<double>& v) { return {v.x, v.y, v.z}; }
inline Quaterniond fromBatch(const Quaternion<double>& q) { return {q.w, q.x, q.y, q.z}; }

/// As batch::FreeRotation.
struct Rotation {
  Quaterniond q_BBnext;
  Vector3d m_B;
};

inline Rotation turned(const Vector3d& m_B, const Vector3d& I, double h) {
  const Vector<double> moments = toBatch(I);
  const FreeRotation<double> f = exactRotation(toBatch(m_B), moments, inverseMoments(moments), h);
  return {fromBatch(f.q_BBnext), fromBatch(f.m_B)};
}

}  // namespace rigid_body_sim::batch

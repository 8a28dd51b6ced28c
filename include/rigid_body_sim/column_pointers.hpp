#pragma once

#include "rigid_body_sim/bodies.hpp"

namespace rigid_body_sim {

/// The columns of a Column3: x[i], y[i], z[i] of body i. For loops that the compiler shall turn
/// into SIMD, as it does not see through a matrix.
template <class Number>
struct Pointers3 {
  Number *x, *y, *z;

  void add(Eigen::Index i, double dx, double dy, double dz) const {
    x[i] += dx;
    y[i] += dy;
    z[i] += dz;
  }
};

inline Pointers3<double> pointersTo(Column3& columns) {
  double* x = columns.data();
  return {x, x + columns.rows(), x + 2 * columns.rows()};
}

inline Pointers3<const double> pointersTo(const Column3& columns) {
  const double* x = columns.data();
  return {x, x + columns.rows(), x + 2 * columns.rows()};
}

/// Three numbers without a class around them, which could keep a loop from becoming SIMD.
struct Triple {
  double x, y, z;

  Triple() = default;
  Triple(double x_, double y_, double z_) : x(x_), y(y_), z(z_) {}
  explicit Triple(const Vector3d& v) : x(v.x()), y(v.y()), z(v.z()) {}

  Vector3d vector() const { return {x, y, z}; }
};

inline bool operator==(const Triple& a, const Triple& b) {
  return a.x == b.x && a.y == b.y && a.z == b.z;
}
inline Triple operator+(const Triple& a, const Triple& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
inline Triple operator-(const Triple& a, const Triple& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline Triple operator*(double s, const Triple& v) { return {s * v.x, s * v.y, s * v.z}; }
inline Triple cross(const Triple& a, const Triple& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline double dot(const Triple& a, const Triple& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

inline Triple at(const Pointers3<const double>& p, Eigen::Index i) {
  return {p.x[i], p.y[i], p.z[i]};
}
inline Triple at(const Pointers3<double>& p, Eigen::Index i) { return {p.x[i], p.y[i], p.z[i]}; }
inline void set(const Pointers3<double>& p, Eigen::Index i, const Triple& v) {
  p.x[i] = v.x;
  p.y[i] = v.y;
  p.z[i] = v.z;
}
inline void add(const Pointers3<double>& p, Eigen::Index i, const Triple& v) {
  p.add(i, v.x, v.y, v.z);
}

/// As move() of body_state.hpp, of p_WBcm and p_low.
inline void move(const Pointers3<double>& p, const Pointers3<double>& low, Eigen::Index i,
                 const Triple& way) {
  const Triple before = at(p, i), all = at(low, i) + way, sum = before + all, added = sum - before;
  set(low, i, (before - (sum - added)) + (all - added));
  set(p, i, sum);
}

/// One rotation matrix, where a body is met more than once.
struct Turn {
  double e[9];  // column by column

  Triple times(const Triple& v) const {
    return {e[0] * v.x + e[3] * v.y + e[6] * v.z, e[1] * v.x + e[4] * v.y + e[7] * v.z,
            e[2] * v.x + e[5] * v.y + e[8] * v.z};
  }
  Triple transposedTimes(const Triple& v) const {
    return {e[0] * v.x + e[1] * v.y + e[2] * v.z, e[3] * v.x + e[4] * v.y + e[5] * v.z,
            e[6] * v.x + e[7] * v.y + e[8] * v.z};
  }
};

/// The columns of a ColumnR, as rotation matrices.
struct RotationPointers {
  const double* first;
  Eigen::Index rows;

  explicit RotationPointers(const ColumnR& columns) : first(columns.data()), rows(columns.rows()) {}

  double operator()(Eigen::Index i, int r, int c) const { return first[(3 * c + r) * rows + i]; }

  Turn of(Eigen::Index i) const {
    const double* p = first + i;
    Turn turn;
    for (int k = 0; k < 9; ++k, p += rows) turn.e[k] = *p;
    return turn;
  }

  /// R v
  Triple times(Eigen::Index i, const Triple& v) const {
    return {(*this)(i, 0, 0) * v.x + (*this)(i, 0, 1) * v.y + (*this)(i, 0, 2) * v.z,
            (*this)(i, 1, 0) * v.x + (*this)(i, 1, 1) * v.y + (*this)(i, 1, 2) * v.z,
            (*this)(i, 2, 0) * v.x + (*this)(i, 2, 1) * v.y + (*this)(i, 2, 2) * v.z};
  }

  /// R^T v
  Triple transposedTimes(Eigen::Index i, const Triple& v) const {
    return {(*this)(i, 0, 0) * v.x + (*this)(i, 1, 0) * v.y + (*this)(i, 2, 0) * v.z,
            (*this)(i, 0, 1) * v.x + (*this)(i, 1, 1) * v.y + (*this)(i, 2, 1) * v.z,
            (*this)(i, 0, 2) * v.x + (*this)(i, 1, 2) * v.y + (*this)(i, 2, 2) * v.z};
  }
};

}  // namespace rigid_body_sim

#include "rigid_body_sim/instant.hpp"

namespace rigid_body_sim {
namespace {

/// The columns of a matrix that has one row a body.
template <class Columns>
auto columnsOf(Columns& columns) {
  return [data = columns.data(), rows = columns.rows()](Eigen::Index k) { return data + k * rows; };
}

/// R A R^T P, where A is the inverse of the mass matrix.
void setVelocitiesWithAddedMass(const Bodies& bodies, Column3& v_WBcm) {
  for (Eigen::Index i = 0; i < bodies.count(); ++i) v_WBcm.row(i) = bodies.v_WBcm(i);
}

}  // namespace

void Instant::set(const Bodies& bodies, double time_s) {
  bodies_ = &bodies;
  time_s_ = time_s;
  has_v_ = has_w_ = has_R_ = false;
}

const Column3& Instant::v_WBcm() const {
  if (has_v_) return v_WBcm_;
  v_WBcm_.resize(bodies_->count(), 3);
  if (bodies_->hasAddedMass())
    setVelocitiesWithAddedMass(*bodies_, v_WBcm_);
  else
    v_WBcm_ = bodies_->P_WB.array().colwise() / bodies_->mass.array();
  has_v_ = true;
  return v_WBcm_;
}

const ColumnR& Instant::R_WB() const {
  if (has_R_) return R_WB_;
  const Eigen::Index count = bodies_->count();
  R_WB_.resize(count, 9);
  const auto q = columnsOf(bodies_->q_WB);
  const auto R = columnsOf(R_WB_);
  const double *qx = q(0), *qy = q(1), *qz = q(2), *qw = q(3);
  double *r0 = R(0), *r1 = R(1), *r2 = R(2), *r3 = R(3), *r4 = R(4), *r5 = R(5), *r6 = R(6),
         *r7 = R(7), *r8 = R(8);
#pragma GCC ivdep
  for (Eigen::Index i = 0; i < count; ++i) {
    const double x = qx[i], y = qy[i], z = qz[i], w = qw[i];
    const double x2 = x + x, y2 = y + y, z2 = z + z;
    r0[i] = 1 - (y2 * y + z2 * z);
    r1[i] = y2 * x + z2 * w;
    r2[i] = z2 * x - y2 * w;
    r3[i] = y2 * x - z2 * w;
    r4[i] = 1 - (x2 * x + z2 * z);
    r5[i] = z2 * y + x2 * w;
    r6[i] = z2 * x + y2 * w;
    r7[i] = z2 * y - x2 * w;
    r8[i] = 1 - (x2 * x + y2 * y);
  }
  has_R_ = true;
  return R_WB_;
}

const Column3& Instant::w_WB() const {
  if (has_w_) return w_WB_;
  const Eigen::Index count = bodies_->count();
  w_WB_.resize(count, 3);
  const auto R = columnsOf(R_WB());
  const auto L = columnsOf(bodies_->L_WBcm_W);
  const auto I = columnsOf(bodies_->I_BBcm_B);
  const auto w = columnsOf(w_WB_);
  const double *r0 = R(0), *r1 = R(1), *r2 = R(2), *r3 = R(3), *r4 = R(4), *r5 = R(5), *r6 = R(6),
               *r7 = R(7), *r8 = R(8);
  const double *Lx = L(0), *Ly = L(1), *Lz = L(2), *I1 = I(0), *I2 = I(1), *I3 = I(2);
  double *wx = w(0), *wy = w(1), *wz = w(2);
#pragma GCC ivdep
  for (Eigen::Index i = 0; i < count; ++i) {
    const double w1 = (r0[i] * Lx[i] + r1[i] * Ly[i] + r2[i] * Lz[i]) / I1[i];
    const double w2 = (r3[i] * Lx[i] + r4[i] * Ly[i] + r5[i] * Lz[i]) / I2[i];
    const double w3 = (r6[i] * Lx[i] + r7[i] * Ly[i] + r8[i] * Lz[i]) / I3[i];
    wx[i] = r0[i] * w1 + r3[i] * w2 + r6[i] * w3;
    wy[i] = r1[i] * w1 + r4[i] * w2 + r7[i] * w3;
    wz[i] = r2[i] * w1 + r5[i] * w2 + r8[i] * w3;
  }
  has_w_ = true;
  return w_WB_;
}

}  // namespace rigid_body_sim

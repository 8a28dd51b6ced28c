#pragma once

#include <cstddef>

namespace rigid_body_sim::batch {

/// Some of the bodies: from `begin` up to, but without, `end`.
struct Range {
  std::ptrdiff_t begin;
  std::ptrdiff_t end;
};

/// The columns of Bodies. Those of one quantity are `stride` numbers apart.
struct BodyColumns {
  std::ptrdiff_t stride;
  const double* mass;  ///< [kg]
  const double* I_BBcm_B;
  double* p_WBcm;
  double* q_WB;
  double* P_WB;
  double* L_WBcm_W;
};

/// The columns of Wrenches.
struct WrenchColumns {
  std::ptrdiff_t stride;
  const double* f_W;
  const double* t_Bcm_W;
};

}  // namespace rigid_body_sim::batch

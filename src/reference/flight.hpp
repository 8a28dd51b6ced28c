#pragma once

#include <functional>

#include "rigid_body_sim/body_state.hpp"

namespace rigid_body_sim::reference {

using Real = long double;
using Vector3r = Eigen::Matrix<Real, 3, 1>;
using Quaternionr = Eigen::Quaternion<Real>;

/// BodyState in extended precision.
struct State {
  Vector3r p_WBcm;
  Quaternionr q_WB;
  Vector3r P_WB;
  Vector3r L_WBcm_W;
};

State extended(const BodyState& body);
BodyState rounded(const State& body);

/// Force [N] and torque about the centre of mass [N m], in world axes.
struct Push {
  Vector3r f_W = Vector3r::Zero();
  Vector3r t_Bcm_W = Vector3r::Zero();
};

/// What acts on a body at a time [s] in a state; smooth.
using PushLaw = std::function<Push(Real time_s, const State& body)>;

inline Push nothing(Real, const State&) { return {}; }

/// Where a flight ends, and how far that is to be trusted.
struct Flight {
  BodyState end;
  State extended_end;  ///< to go on from without rounding
  double doubt;  ///< the largest difference of any component to the same flight in half as many
                 ///< steps, relative to the size of its vector or to one, whichever is larger
};

/// The body after `time_s` [s] under a law, from time 0: the equations of motion themselves,
/// x' = P/m, q' = w q/2, P' = f, L' = t (founding text, section 7), the last one in body axes, by
/// the extrapolated midpoint rule of order 16 in long double (Gragg 1965; Hairer, Norsett and
/// Wanner, Solving Ordinary Differential Equations I, II.9). It shares no formula with the
/// integrators. The number of steps doubles until the end changes by less than 1e-12, which leaves
/// 1e-12 / 2^16 of truncation, and rounding of some 1e-16 times how much the motion spreads small
/// differences; or until the change no longer falls because of that rounding.
/// @throws std::runtime_error if the change stays above 1e-9.
Flight fly(const State& start, double mass, const Vector3d& I_BBcm_B, const PushLaw& law,
           double time_s);

inline Flight fly(const BodyState& start, double mass, const Vector3d& I_BBcm_B, const PushLaw& law,
                  double time_s) {
  return fly(extended(start), mass, I_BBcm_B, law, time_s);
}

}  // namespace rigid_body_sim::reference

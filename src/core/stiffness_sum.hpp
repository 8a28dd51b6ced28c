#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "core/suitability.hpp"

// What the effects on a body make of it together, to be held against what a method bears.
namespace rigid_body_sim {

/// The methods on velocities kick between the flows, and then a swing w h is bounded up to
/// (w h)^2 = 2 (1 + exp(-x)) under a friction of x a step: 2 without, the root of 2 with any.
constexpr double kSwingWithinFriction = 1.41;

inline bool kicksWithinFlows(const IntegratorRow& row) {
  return row.has_drifts && !row.keeps_angular_momentum;
}

inline bool isFriction(const Effect& effect) {
  return effect.hasStableFlow() && !effect.hasReversibleFlow();
}

/// What several effects make of a body together: squares of frequencies add, and so do rates of
/// decay.
struct Sum {
  double most_swing = std::numeric_limits<double>::infinity();  // [rad] a step, beside the row's
  double squares = 0;                                           // [1/s^2]
  double decays = 0;                                            // [1/s]
  bool is_swing_linear = true, is_decay_linear = true;
  std::string names;

  void add(const Effect& effect, const Stiffness& stiff) {
    if (stiff.oscillation == 0 && stiff.decay == 0) return;
    squares += stiff.oscillation * stiff.oscillation;
    decays += stiff.decay;
    is_swing_linear = is_swing_linear && (stiff.is_linear || stiff.oscillation == 0);
    is_decay_linear = is_decay_linear && (stiff.is_linear || stiff.decay == 0);
    names += (names.empty() ? "'" : " and '") + effect.name() + "'";
  }
  bool isOfMany() const { return names.find(" and ") != std::string::npos; }

  double longest(const IntegratorRow& row) const {
    const double max_swing =
        std::min(most_swing, is_swing_linear ? row.max_swing : row.max_large_swing);
    // Both at once bear less than each alone: an ellipse lies within the regions of stability.
    const double decay = decays == 0 ? 0 : decays / row.max_decay;
    return 1 / std::hypot(std::sqrt(squares) / max_swing, decay);
  }
};

/// Of body i alone; effects that cannot be divided count with their stiffest body.
Sum sumOn(Eigen::Index i, Sum sum, const EffectList& forces, const Instant& now);

}  // namespace rigid_body_sim

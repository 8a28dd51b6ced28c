#pragma once

#include "core/part.hpp"

namespace rigid_body_sim {

/// Evaluations of the effects that the second flight of a tick takes at most: 64 steps of rk8.
/// Where these would be unstable for friction it takes more: up to what the friction is faster than
/// the tick, about.
constexpr int kMostEvaluations = 64 * 12;

/// The part after a tick, by a method far better than the one that is used.
Bodies flyTickTruly(const Part& before, const Method& used);

/// How far a tick took the bodies from where it should have, at worst: the tick is flown again by a
/// far better method, from the same state.
/// @param before at the tick's beginning, with impulses given
/// @param after what `used` made of it
Deviation localError(const Part& before, const Bodies& after, const Method& used);

/// What a tick's local error may be of rounding alone: 20 ulps of a position; of an attitude, and
/// of how far a body turns about its axis of the smallest moment when its momentum is rounded.
Deviation roundingOfTick(const Bodies& bodies, double tick_s);

}  // namespace rigid_body_sim

#pragma once

#include <string>

#include "rigid_body_sim/effect.hpp"

namespace rigid_body_sim {

/// Whether an effect has a flow and depends on velocities. Methods that go kick - drift - kick are
/// then stable at any step, and look right beyond what they can follow: friction that is fast for a
/// step locks a body, and a frame that turns fast shows it the same face at each kick. In half
/// steps they err alike, so they are no witnesses against themselves.
bool haveFlows(const EffectList& effects);

/// How fast effects let a body slow down.
struct Decay {
  double rate = 0;         ///< [1/s], of all together; not finite where the state is not
  Eigen::Index body = 0;   ///< the one that slows down fastest by one of them
  std::string names = {};  ///< of those that do it, quoted
};

/// An upper bound of the fastest: each effect may have another body for its own.
Decay fastestDecay(const EffectList& effects, const Instant& now);

/// In how many pieces of a tick `adaptive` can follow a decay that takes `decays` = rate times the
/// tick: it goes on in thousandths of a piece where it would want less, and rk8, which it takes
/// steps of, is stable up to 6.38; half of that here.
int piecesFor(double decays);

/// The most pieces that are worth their time.
constexpr int kMostPieces = 256;

}  // namespace rigid_body_sim

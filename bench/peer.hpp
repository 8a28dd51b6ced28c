#pragma once

#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "scene.hpp"

namespace rigid_body_sim::bench {

/// How a body of an engine moves.
struct Motion {
  Vector3d p_WBcm;  ///< [m]
  Quaterniond q_WB;
  Vector3d v_WBcm;  ///< [m/s]
  Vector3d w_WB;    ///< [rad/s]
};

/// An engine with a scene in it.
struct Peer {
  std::function<void()> reset;                   ///< back to the start
  std::function<void(int steps)> step;           ///< advances all bodies
  std::function<Motion(Eigen::Index)> motionOf;  ///< of a body
  std::function<bool()> has_started_anew = {};   ///< by itself; an engine that never does has none
};

/// Of anything with the first three functions.
template <class Engine>
Peer peerOf(const std::shared_ptr<Engine>& engine) {
  return {[engine] { engine->reset(); }, [engine](int steps) { engine->step(steps); },
          [engine](Eigen::Index i) { return engine->motionOf(i); }};
}

/// A way of stepping that an engine offers.
struct PeerRow {
  std::string engine;  ///< with its version: `Bullet 3.24 f32`
  std::string way;     ///< `world`
  std::string about;   ///< in a few words, for the table
  std::function<Peer(const Scene&)> make;
  Eigen::Index most_bodies = std::numeric_limits<Eigen::Index>::max();
  std::string limit = {};              ///< why no more
  bool is_gyroscopic_optional = true;  ///< false: the engine cannot leave that term out
  bool needs_wrenches = false;         ///< without them it is like another row
  std::string hard_cases = {};  ///< the name to fly the gallery by; empty: another row does as well
};

/// All ways of the one engine that a program is linked with: each engine's file defines it.
std::vector<PeerRow> peerRows();

/// Flights start again after so many steps, before anything can run away.
constexpr int kLongestFlight = 1000;

/// Steps a peer for at least `least_ns` [ns] of the processor's time, which other programs do not
/// count in, and returns what a step took [ns]. Resets are not counted.
double timeStep(const Peer& peer, Eigen::Index bodies, double least_ns);

}  // namespace rigid_body_sim::bench

#pragma once

#include <functional>
#include <iosfwd>
#include <string>
#include <vector>

#include "reference/gallery.hpp"

namespace rigid_body_sim::hard_cases {

/// What becomes of a case with another engine: as with our rungs, or one of those below.
enum class Fate {
  kHolds,
  kDrifts,
  kWrong,
  kInfinite,
  kAnew,     ///< the engine begins again by itself
  kThrows,   ///< the engine throws on the way
  kEnds,     ///< the engine ends its process
  kSlow,     ///< not there after Peers::longest_s
  kRefused,  ///< the engine does not take the scene
  kUnasked,  ///< the case cannot be told to it
};

const char* nameOf(Fate fate);

/// One case flown with one engine.
struct PeerCell {
  const reference::HardCase* one;
  std::string engine;
  Fate fate = Fate::kEnds;
  reference::Verdict verdict = {};  ///< but for the outcome
};

struct Peers {
  std::string folder;      ///< with the programs peer_*, which bench/ builds
  double longest_s = 300;  ///< of wall time for a case
};

/// The engines that are there, by the names that their programs give. @throws std::invalid_argument
/// if there are none
std::vector<std::string> engineNames(const Peers& peers);

/// Flies all; case by case, engines in the order of engineNames(). Each flight is a process of its
/// own, so that an engine that ends it ends nothing else.
/// @param progress what, and the part done
std::vector<PeerCell> flyPeers(
    const Peers& peers, const std::vector<std::string>& cases,
    const std::function<void(const std::string& what, double part)>& progress);

/// What a cell says: the error where it holds or drifts, else what happens.
std::string inACell(const PeerCell& cell);

/// A row a case, a column an engine.
void print(const std::vector<PeerCell>& cells, std::ostream& out);

/// peers.csv: a line a case and engine, for scripts/plot_hard_cases.
void writeCsv(const std::vector<PeerCell>& cells, const std::string& folder);

}  // namespace rigid_body_sim::hard_cases

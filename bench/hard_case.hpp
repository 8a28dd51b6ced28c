#pragma once

#include <string>

#include "peer.hpp"
#include "reference/gallery.hpp"

namespace rigid_body_sim::bench {

/// Flies a hard case with an engine, and judges it by the bounds that our own rungs have to keep.
/// In a line for hard_cases (src/tools/hard_cases/peers.cpp), fields by tabs:
///   FATE END_S ENERGY_CHANGE MOMENTUM_ERROR COUNT ERROR... BOUND... WHY
/// FATE is an outcome of the gallery (`refused` if the engine did not take the scene), `anew` if
/// the engine began again by itself, `throws` if it threw on the way, or `unasked` if the case
/// cannot be told to it; COUNT is that of the errors.
std::string flyHardCase(const PeerRow& row, const reference::HardCase& one);

}  // namespace rigid_body_sim::bench

#pragma once

#include <optional>

#include "core/suitability.hpp"

namespace rigid_body_sim {

/// What the methods of a scene will not bear, though they do at its start.
struct Trouble {
  double time_s;  ///< when
  Fault fault;
};

/// Flies the beginning of the scene, as much as takes a tenth of a second (not with `adaptive`,
/// whose steps may be many), and looks at every tick: forces at the start say nothing of a pendulum
/// on a spring that is not stretched yet, of a fall past a heavy centre, or of the drag of a body
/// dropped from rest.
/// @param bodies as they are at the start
/// @returns what comes first, but not what is there from the beginning
std::optional<Trouble> firstTrouble(const Scene& scene, const Bodies& bodies);

/// In a line, with the body's name.
std::string toText(const Trouble& trouble, const Scene& scene);

}  // namespace rigid_body_sim

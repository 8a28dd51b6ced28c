#pragma once

#include <vector>

#include "integrators/batch/columns.hpp"

// The steps of the integrators for many bodies at once. Each body gets the same bits whatever the
// instruction set, and whichever bodies are beside it.
namespace rigid_body_sim::batch {

/// The functions of one instruction set. They work in place, on the bodies of a range.
struct Kernels {
  const char* name;
  int width;  ///< numbers in a register

  /// P += h f, L += h t.
  void (*kick)(const BodyColumns&, const WrenchColumns&, double h, Range);

  // Free flight for h [s]. A body without angular momentum keeps its attitude to the bit. Where
  // there are wrenches, a kick with them comes first, in the same pass over memory; null for none.
  void (*driftPositions)(const BodyColumns&, double h, Range);
  void (*driftAtConstantRate)(const BodyColumns&, const WrenchColumns*, double h, Range);
  void (*driftBySplitting)(const BodyColumns&, const WrenchColumns*, double h, Range);
  void (*driftWithoutGyroscopicTerm)(const BodyColumns&, double h, Range);
};

/// Those that this processor has, from the narrowest to the widest; the first is plain C++.
const std::vector<Kernels>& availableKernels();

/// The widest of them, or the one whose name the environment variable RIGID_BODY_SIM_KERNELS has.
/// Chosen once. @throws std::runtime_error if there is none of that name.
const Kernels& kernels();

}  // namespace rigid_body_sim::batch

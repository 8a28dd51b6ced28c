#pragma once

#include <vector>

#include "integrators/batch/columns.hpp"

// The steps of the integrators for many bodies at once. Each body gets the same bits whatever the
// instruction set, and whichever bodies are beside it.
namespace rigid_body_sim::batch {

/// The functions of one instruction set. They work in place, on the bodies of a range.
struct Kernels {
  const char* name;
  int width;  ///< bodies that are worked on side by side

  /// Whether all numbers of the states are finite.
  bool (*areFinite)(const BodyColumns&, Range);

  /// P += h f, L += h t.
  void (*kick)(const BodyColumns&, const WrenchColumns&, double h, Range);

  // Free flight for h [s]. A body without angular momentum keeps its attitude to the bit. Where
  // there are wrenches, a kick with them comes first, in the same pass over memory; null for none.
  void (*driftPositions)(const BodyColumns&, double h, Range);
  void (*driftAtConstantRate)(const BodyColumns&, const WrenchColumns*, double h, Range);
  void (*driftBySplitting)(const BodyColumns&, const WrenchColumns*, double h, Range);
  void (*driftWithoutGyroscopicTerm)(const BodyColumns&, double h, Range);

  /// From the wrenches at stage `stage`, 0 to 3, to the state of the next in `stages`, or to the
  /// step's end in `bodies`, which stay at its beginning until then. The first stage is at
  /// `bodies`. `stages` needs no mass and no moments; `tiles` are of kRk4Numbers. The stages'
  /// angular momenta are worked out only by rk4StageWithVelocity, for effects that depend on
  /// velocities.
  using Rk4Stage = void (*)(const BodyColumns& bodies, const BodyColumns& stages,
                            const WrenchColumns&, double* tiles, int stage, double h, Range);
  Rk4Stage rk4Stage, rk4StageWithVelocity, rk4StageWithoutGyroscopicTerm;

  /// The whole step under wrenches that are the same at each stage, with the bits of the stages;
  /// null for none, and positions are then those of driftPositions.
  using Rk4Steady = void (*)(const BodyColumns&, const WrenchColumns*, double h, Range);
  Rk4Steady rk4Steady, rk4SteadyWithoutGyroscopicTerm;

  // Kicks and exact free flight, with `tiles` of kSpinNumbers. All take up first the bodies whose
  // attitude or angular momentum somebody else has changed.
  void (*kickSpins)(const BodyColumns&, const WrenchColumns&, double* tiles, double h, Range);
  void (*driftSpins)(const BodyColumns&, double* tiles, double h, Range);
  /// A kick of `before_s`, a drift of h and, unless it is 0, a kick of `after_s` with the same
  /// wrenches, in one pass over memory.
  void (*flySpins)(const BodyColumns&, const WrenchColumns&, double* tiles, double before_s,
                   double h, double after_s, Range);
};

/// Those that this processor has, from the narrowest to the widest; the first is plain C++.
const std::vector<Kernels>& availableKernels();

/// The widest of them, or the one whose name the environment variable RIGID_BODY_SIM_KERNELS has.
/// Chosen once. @throws std::runtime_error if there is none of that name.
const Kernels& kernels();

}  // namespace rigid_body_sim::batch

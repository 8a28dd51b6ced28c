#pragma once

#include "integrators/batch/drift.hpp"
#include "integrators/batch/kernels.hpp"

namespace rigid_body_sim::batch {
namespace {

template <class S, class Rotation>
void kickAndDrift(const BodyColumns& bodies, const WrenchColumns* wrenches, double h, Range range) {
  if (wrenches)
    drift<S, Rotation, First::kKick>(bodies, wrenches, h, range);
  else
    drift<S, Rotation, First::kNothing>(bodies, nullptr, h, range);
}

template <class S>
void fillTable(Kernels& table) {
  table.width = kWidth<S>;
  table.kick = kick<S>;
  table.driftPositions = driftPositions<S>;
  table.driftAtConstantRate = kickAndDrift<S, ConstantRate>;
  table.driftBySplitting = kickAndDrift<S, Split>;
  table.driftWithoutGyroscopicTerm = driftWithoutGyroscopicTerm<S>;
}

}  // namespace
}  // namespace rigid_body_sim::batch

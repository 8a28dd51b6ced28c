#pragma once

#include "integrators/batch/drift.hpp"
#include "integrators/batch/kernels.hpp"
#include "integrators/batch/rk4_steady.hpp"
#include "integrators/batch/spins.hpp"

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
  table.areFinite = areFinite<S>;
  table.kick = kick<S>;
  table.driftPositions = driftPositions<S>;
  table.driftAtConstantRate = kickAndDrift<S, ConstantRate>;
  table.driftBySplitting = kickAndDrift<S, Split>;
  table.driftWithoutGyroscopicTerm = driftWithoutGyroscopicTerm<S>;
  table.rk4Stage = rk4Stage<S, true, EffectsSee::kPose>;
  table.rk4StageWithVelocity = rk4Stage<S, true, EffectsSee::kVelocityToo>;
  table.rk4StageWithoutGyroscopicTerm = rk4Stage<S, false, EffectsSee::kVelocityToo>;
  table.rk4Steady = rk4Steady<S, true>;
  table.rk4SteadyWithoutGyroscopicTerm = rk4Steady<S, false>;
  table.kickSpins = kickSpins<S>;
  table.driftSpins = driftSpins<S>;
  table.flySpins = flySpins<S>;
}

}  // namespace
}  // namespace rigid_body_sim::batch

#pragma once

#include "rigid_body_sim/effect_row.hpp"

// An effect of your own, in a package of your own. Write a class after rigid_body_sim::Effect and a
// function that makes it from its block in a scene file, and end the source file, outside of all
// namespaces, with
//
//   RIGID_BODY_SIM_EFFECT("rate_damping", BlockLayout::kMap, makeRateDamping)
//
// Build it as a shared library named rigid_body_sim_effect_<name>, one effect a library, and have
// it on the dynamic linker's path, as sourcing a catkin workspace does. A scene then lists
// `rate_damping` below `effects` as any other. The library is found by the effect's name alone,
// which is of small letters, digits and underscores: no parameter and no message can name a path.
// test/effect_package is such a package.
namespace rigid_body_sim {

/// Changes whenever a plug-in has to be compiled anew.
constexpr int kEffectPluginVersion = 3;

/// What a plug-in's library offers.
struct EffectPlugin {
  int version;
  /// How Eigen aligns matrices [bytes]. Flags such as -march=native change it, and with it where
  /// the members of Bodies lie.
  int alignment;
  EffectRow row;
};

}  // namespace rigid_body_sim

extern "C" __attribute__((visibility("default"))) const rigid_body_sim::EffectPlugin*
rigidBodySimEffect();

/// Offers an effect; see above. `make` as EffectRow::make.
#define RIGID_BODY_SIM_EFFECT(name, layout, make)                                                 \
  const ::rigid_body_sim::EffectPlugin* rigidBodySimEffect() {                                    \
    static const ::rigid_body_sim::EffectPlugin plugin = {::rigid_body_sim::kEffectPluginVersion, \
                                                          EIGEN_MAX_STATIC_ALIGN_BYTES,           \
                                                          {name, layout, make}};                  \
    return &plugin;                                                                               \
  }

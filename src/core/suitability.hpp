#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "rigid_body_sim/integrator.hpp"
#include "rigid_body_sim/method.hpp"
#include "rigid_body_sim/simulator.hpp"

namespace rigid_body_sim {

/// The effects on some of the bodies alone, without those that act on none of them; nothing if one
/// of them cannot be divided.
std::optional<EffectList> restrictedTo(const EffectList& effects,
                                       const std::vector<Eigen::Index>& bodies);

/// Whether an effect cannot be divided for some of the `count` bodies: then they are planned for,
/// and looked at, as a whole.
bool areCoupled(const EffectList& effects, Eigen::Index count);

/// The rows of `bodies` with these indices.
Bodies rowsOf(const Bodies& bodies, const std::vector<Eigen::Index>& indices);

/// The largest |w| [rad/s] of the bodies, and whose it is.
struct FastestBody {
  Eigen::Index body = 0;
  double rate = 0;
};
FastestBody fastestOf(const Bodies& bodies);

/// The order of the method under the effect; 0: it is refused.
int orderUnder(const IntegratorRow& row, const Effect& effect);

/// Why the method must not step bodies under these effects; empty if it may.
std::string objection(const Method& method, const EffectList& effects);

/// A body on which effects act as they must not.
struct Fault {
  Eigen::Index body;
  std::string why;  ///< names the effects, and the longest stable step if they are too stiff
};

/// Whether an effect's wrench, energy or stiffness is not finite at `now`.
std::optional<Fault> notFinite(const EffectList& effects, const Instant& now);

/// Whether ticks of `tick_s` [s] are too long for the method to be stable under one of these
/// effects by itself; judged at `now`.
std::optional<Fault> oneTooStiff(const Method& method, const EffectList& effects,
                                 const Instant& now, double tick_s);

/// The same of each by itself and of all of a body's together.
std::optional<Fault> tooStiff(const Method& method, const EffectList& effects, const Instant& now,
                              double tick_s);

/// Why the method must not step bodies that turn at `rate` [rad/s], in ticks of `tick_s` [s].
std::string objection(const Method& method, double rate, double tick_s);

/// What a user of the method should know of it under these effects; empty if nothing.
std::string caution(const Method& method, const EffectList& effects);

/// A body that friction stops within a step: what else acts on it moves it too slowly then.
std::optional<Fault> stoppedAtOnce(const Method& method, const EffectList& effects,
                                   const Instant& now, double tick_s);

/// What is falsified by effects whose flow turns far in a step; empty if nothing.
std::string turnsTooFar(const Method& method, const EffectList& effects, const Instant& now,
                        double tick_s);

/// Effects on the bodies of a part of the scene, no bodies meaning all.
/// @throws std::invalid_argument if an effect cannot be divided among the parts
EffectList effectsOn(const MethodOfBodies& part, const Scene& scene);

/// The methods of a scene; no bodies means all of them.
std::vector<MethodOfBodies> methodsOf(const Scene& scene);

/// Cautions, one line each; none under a budget, whose bill says what the methods get wrong.
/// @throws std::invalid_argument naming body or effect, if a method of the scene must not step its
/// bodies, or a body has no method or several
std::vector<std::string> requireSuitableMethods(const Scene& scene, const Bodies& bodies,
                                                double time_s = 0);

}  // namespace rigid_body_sim

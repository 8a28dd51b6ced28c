#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "rigid_body_sim/instant.hpp"

namespace rigid_body_sim {

/// What acts on the bodies: row i on body i, at its centre of mass, in world axes.
struct Wrenches {
  Column3 f_W;      ///< [N]
  Column3 t_Bcm_W;  ///< [N m]

  /// No wrench on any of `count` bodies.
  void setZero(Eigen::Index count);
};

/// The fastest that an effect can make a body swing or slow down: what decides which steps are
/// stable.
struct Stiffness {
  double oscillation = 0;  ///< [rad/s]
  double decay = 0;        ///< [1/s]
  Eigen::Index body = 0;   ///< the stiffest one
  bool is_linear = false;  ///< swings or speeds of any size have this rate
};

/// A cause of forces and torques on some of the bodies. Effects do not change once made.
///
/// The methods that go kick - drift - kick take an effect in one of two ways. Most are kicks: their
/// wrenches give momentum between the drifts. One that has a flow is part of the drift instead: it
/// moves the bodies by itself before and after each drift, by a formula that is right at any step.
/// So friction never turns a velocity round, however large it is. The Runge-Kutta methods take the
/// wrenches of all.
class Effect {
 public:
  virtual ~Effect() = default;

  /// In messages and counts.
  virtual std::string name() const = 0;

  /// As in scene files, and what it is switched by: of several effects that one block makes, the
  /// block's.
  virtual std::string blockName() const { return name(); }

  /// How many bodies it acts on.
  virtual std::size_t bodyCount() const = 0;

  /// Adds its wrenches at this instant to `wrenches`.
  virtual void addWrenches(const Instant& now, Wrenches& wrenches) const = 0;

  /// Whether its wrenches depend on velocities, as drag and damping do. Some integrators have a
  /// lower order then, or refuse it, unless it has a flow; and to an effect that says no, rk4 does
  /// not tell the angular momenta within its steps: they are no numbers there.
  virtual bool dependsOnVelocity() const { return false; }

  /// Whether its wrenches depend neither on the bodies' states nor on time. Where all that act are
  /// so, they are worked out once, and not at every step.
  virtual bool isSteady() const { return false; }

  /// Whether all its work comes out of its potential energy.
  virtual bool isConservative() const { return false; }

  /// Potential energy of all bodies [J], of a conservative effect.
  virtual double potentialEnergy(const Instant&) const { return 0; }

  /// The order that kick - drift - kick methods keep with its flow; 0: it has none, and kicks.
  virtual int flowOrder() const { return 0; }

  /// Whether the flow can be run back in time; methods of high order do.
  virtual bool hasReversibleFlow() const { return false; }

  /// Its flow, before and after a drift of h [s]. Both together are the effect's own motion for h.
  /// @param now the bodies as they are then: at the drift's beginning, or at its end
  virtual void beforeDrift(Bodies&, const Instant& /*now*/, double /*h*/) const {}
  virtual void afterDrift(Bodies&, const Instant& /*now*/, double /*h*/) const {}

  /// Whether the flow stands next to the drift, within all others: that of an effect that changes
  /// what a drift is, as a turning frame does, and not what acts. The others see the bodies as they
  /// are between the steps.
  virtual bool hasInnermostFlow() const { return false; }

  /// Whether the flow turns bodies, and does not only change their momenta and positions.
  virtual bool hasTurningFlow() const { return false; }

  /// Whether it is right only with w x I w in the equations of motion of all bodies.
  virtual bool needsGyroscopicTerm() const { return false; }

  /// Whether it can end and begin again; what the state's own meaning depends on cannot.
  virtual bool isSwitchable() const { return true; }

  /// Zero if its wrenches cannot make any step unstable. Of an oscillation, the frequency of the
  /// smallest swing.
  virtual Stiffness stiffness(const Instant&) const { return {}; }

  /// Whether a flow, if it has one, is stable at any step.
  virtual bool hasStableFlow() const { return flowOrder() > 0; }

  /// Time of an evaluation on one body, in torque-free steps of `semi_implicit`: what the choice of
  /// a method for an accuracy budget reckons with.
  virtual double cost() const { return 0.5; }

  /// The same effect on some of the bodies alone, whose places in the list become their new
  /// indices. It acts on those of them that it acts on here; that may be none (bodyCount() 0).
  /// Null, as by default, if it cannot be divided: its bodies act on each other.
  virtual std::shared_ptr<const Effect> restrictedTo(const std::vector<Eigen::Index>&) const {
    return nullptr;
  }
};

using EffectList = std::vector<std::shared_ptr<const Effect>>;

/// Uniform gravity g_W [m/s^2] on the bodies with the given indices: f = m g.
std::shared_ptr<const Effect> uniformGravity(const Vector3d& g_W, std::vector<Eigen::Index> bodies);

}  // namespace rigid_body_sim

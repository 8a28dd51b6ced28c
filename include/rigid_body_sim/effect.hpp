#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "rigid_body_sim/bodies.hpp"

namespace rigid_body_sim {

/// What acts on the bodies: row i on body i, at its centre of mass, in world axes.
struct Wrenches {
  Column3 f_W;      ///< [N]
  Column3 t_Bcm_W;  ///< [N m]
};

/// A cause of forces and torques on some of the bodies. Effects do not change once made.
class Effect {
 public:
  virtual ~Effect() = default;

  /// As in scene files.
  virtual std::string name() const = 0;

  /// How many bodies it acts on.
  virtual std::size_t bodyCount() const = 0;

  /// Adds its wrenches at `time_s` [s] to `wrenches`.
  virtual void addWrenches(const Bodies& bodies, double time_s, Wrenches& wrenches) const = 0;

  /// Whether its wrenches depend on velocities, as drag and damping do. Some integrators have a
  /// lower order then, or refuse it.
  virtual bool dependsOnVelocity() const { return false; }

  /// Time of an evaluation on one body, in torque-free steps of `semi_implicit`: what the choice of
  /// a method for an accuracy budget reckons with.
  virtual double cost() const { return 0.5; }

  /// The same effect on some of the bodies alone, whose places in the list become their new
  /// indices. It acts on those of them that it acts on here; that may be none (bodyCount() 0). Null,
  /// as by default, if it cannot be divided: its bodies act on each other.
  virtual std::shared_ptr<const Effect> restrictedTo(const std::vector<Eigen::Index>&) const {
    return nullptr;
  }
};

/// Uniform gravity g_W [m/s^2] on the bodies with the given indices: f = m g.
std::shared_ptr<const Effect> uniformGravity(const Vector3d& g_W, std::vector<Eigen::Index> bodies);

/// The effects that act now. One virtual call an effect and evaluation; an effect that is not in
/// the list costs nothing at all.
class ActiveEffects {
 public:
  void add(const Effect* effect) { effects_.push_back(effect); }
  void remove(const Effect* effect);
  bool empty() const { return effects_.empty(); }

  /// The sum of all effects at `time_s` [s]; valid until the next call.
  const Wrenches& evaluate(const Bodies& bodies, double time_s);

 private:
  std::vector<const Effect*> effects_;
  Wrenches sum_;
};

}  // namespace rigid_body_sim

#pragma once

#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "rigid_body_sim/active_effects.hpp"

namespace rigid_body_sim {

/// Advances the bodies by one step.
class Integrator {
 public:
  virtual ~Integrator() = default;

  /// From `time_s` to `time_s + step_s` [s] under the active effects.
  virtual void step(Bodies& bodies, ActiveEffects& effects, double time_s, double step_s) = 0;
};

/// Whether w x I w is part of the equations of motion. Without it the angular velocity of a
/// torque-free body is constant in the world, which is right for spherical bodies only.
enum class Gyroscopic { kOn, kOff };

struct IntegratorOptions {
  /// The bodies without the gyroscopic term, by index; of spherical ones it is not asked, as they
  /// have none.
  std::vector<Eigen::Index> ungyroscopic = {};
  double tolerance = 1e-12;  ///< error a step of 1 s may have, for methods that adapt their step:
                             ///< of the attitude [rad] and relative to each momentum and position;
                             ///< such a method's steps are common to all bodies that it steps
};

/// A method one can choose, and what it promises; test/integrator_laws_test.cpp measures each
/// promise.
struct IntegratorRow {
  std::string name;
  int order;  ///< of the global error, under wrenches that depend on time and pose; 0: the method
              ///< adapts its own steps to a tolerance
  int order_under_drag;  ///< under wrenches that depend on velocities and have no flow; 0: refused,
                         ///< as the method has steps back in time, which turn dissipation into
                         ///< growth
  bool has_drifts;       ///< takes effects with a flow as part of its drift
  bool free_flight_is_exact;  ///< without torque the error is rounding at any step, not of `order`
  bool keeps_angular_momentum;  ///< L of a torque-free body stays the same to the bit
  bool bounded_energy;          ///< no trend of a torque-free body's energy, however long
  bool is_reversible;           ///< a step of -h undoes a step of h, to rounding
  double max_turn;   ///< largest |w| h [rad] of a step; beyond, errors grow without bound, or a
                     ///< method that adapts its steps takes larger ones than it wants
  double max_swing;  ///< largest (angular frequency) h of an oscillation that stays stable; with
                     ///< explicit Euler all grow: where they do by a thousandth a step
  double max_large_swing;  ///< the same where a large swing is not like a small one, as that of a
                           ///< pendulum; h times the frequency of the small one
  double max_decay;    ///< largest (rate) h of a decay by wrenches that stays stable; of effects
                       ///< with a flow only Runge-Kutta methods ask
  int evaluations;     ///< of the effects, a step; 0: as many as it needs
  double cost;         ///< time of a step of one body on which no effect acts, in those of
                       ///< `semi_implicit`; measured, see README
  double forced_cost;  ///< the same with a torque, without the time that the effects take
  bool is_cheap_without_torque;  ///< a torque-free body costs `cost` also while effects act; else
                                 ///< `forced_cost`, unless the method is exact in free flight and
                                 ///< the body never turns
  std::string summary;
  std::unique_ptr<Integrator> (*make)(const IntegratorOptions&);
};

/// All methods, from the crudest to the most accurate.
const std::vector<IntegratorRow>& integrators();

/// The row with this name. @throws std::invalid_argument naming all that there are.
const IntegratorRow& integratorNamed(const std::string& name);

}  // namespace rigid_body_sim

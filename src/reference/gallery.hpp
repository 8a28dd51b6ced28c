#pragma once

#include <functional>
#include <string>
#include <vector>

#include "reference/answers.hpp"
#include "rigid_body_sim/simulator.hpp"

namespace rigid_body_sim::reference {

/// What is measured at the end of a flight, of the body that is worst.
enum class Measure {
  kAttitude,         ///< angle to the answer [rad]
  kPosition,         ///< of the centre of mass [m]
  kMomentum,         ///< P, relative
  kAngularMomentum,  ///< L, relative; in free flight at any of 32 moments
  kEnergy,           ///< kinetic, relative; in free flight at any of 32 moments
  kLength,           ///< of the quaternion, from one
};

/// At most `most`, and `a_tick` for each, and `ulps` times what the last bit of the start's angular
/// momentum turns the answer by: no method can be asked for more than its input says.
struct Bound {
  Measure measure;
  double most;
  std::string why;  ///< where the number comes from
  double a_tick = 0;
  double ulps = 0;
};

/// How a flight ends.
enum class Outcome {
  kHolds,     ///< within all bounds
  kDrifts,    ///< not the answer, but energy and angular momentum are within a hundredth
  kWrong,     ///< finite, but another motion
  kInfinite,  ///< the body is frozen before its state is no longer finite
  kRefused,   ///< the simulator says at the start that the method does not bear the scene
};

const char* nameOf(Outcome outcome);

/// Of some rungs that do not hold: what happens to them instead, and why.
struct Excuse {
  std::vector<std::string> rungs;
  Outcome outcome;
  std::string why;
};

/// What a case does to its first body in a tick, in world axes.
struct TorqueInput {
  Vector3d t_W = Vector3d::Zero();  ///< torque for the tick [N m]
  Vector3d J_W = Vector3d::Zero();  ///< angular impulse at its beginning [N m s]
};

/// Rungs that raise floating-point exceptions on the way, and why that is no harm.
struct Untrapped {
  std::vector<std::string> rungs = {};
  std::string why = {};
};

/// A hard case: one row of the gallery. Every rung that is not excused has to keep the bounds.
struct HardCase {
  std::string name;
  std::string what;              ///< what is hard, in a line
  std::string scene;             ///< YAML, as the simulator takes it but for the integrator
  Tick ticks = 0;                ///< how long
  Tick long_ticks = 0;           ///< if asked to take its time; 0: as always
  AnswerOf answer = {};          ///< what is true at the end
  std::vector<Bound> must = {};  ///< the first one is the figure to show
  std::string source = {};       ///< of the case and of its answer
  std::string elsewhere = {};    ///< how other engines fail on it, and who measured it
  std::vector<Excuse> excuses = {};
  std::function<TorqueInput(Tick)> input = {};  ///< none: a flight without inputs
  std::string urdf = {};                        ///< text whose bodies join the scene's
  Untrapped untrapped = {};
};

/// All of them.
const std::vector<HardCase>& gallery();

/// The case with this name. @throws std::invalid_argument if there is none.
const HardCase& hardCaseNamed(const std::string& name);

/// The scene as one rung flies it.
Scene sceneOf(const HardCase& one, const std::string& rung);

/// What is claimed of a rung; kHolds without an excuse.
struct Claim {
  Outcome outcome = Outcome::kHolds;
  std::string why = {};
};
Claim claimOf(const HardCase& one, const std::string& rung);

/// What came out.
struct Verdict {
  Outcome outcome = Outcome::kHolds;
  std::vector<double> errors = {};  ///< beside each bound; none if refused or infinite
  std::vector<double> bounds = {};  ///< in numbers
  double end_s = 0;                 ///< when the flight ended [s]
  double energy_change = 0;         ///< relative, where it was largest; of the body that is worst
  double momentum_error = 0;        ///< of L, relative, the same
  std::string why = {};             ///< of a refusal, in the simulator's words
};

/// Whether that is what is claimed. A rung that is excused for drifting may come close to a bound,
/// as what rounding makes depends on the order of operations; but one that keeps a quarter of every
/// bound needs no excuse.
bool keeps(const Claim& claim, const Verdict& verdict);

/// What flies a case: one of our rungs, or another engine.
struct Flyer {
  Bodies start;
  double step_s;
  bool is_free;                           ///< nothing acts: energy and L are looked at on the way
  std::function<void(Tick tick)> step;    ///< with the case's input
  std::function<const Bodies&()> bodies;  ///< as they are now
  std::function<bool()> is_lost;          ///< there is no going on
};

/// Flies the case and judges the end.
Verdict judge(const HardCase& one, const Flyer& flyer, Tick ticks);

/// How long a case is flown: as its row says, or its long way.
Tick ticksOf(const HardCase& one, bool takes_its_time);

/// Flies the case with a rung of the registry, one step a tick, and judges it.
Verdict judge(const HardCase& one, const std::string& rung, bool takes_its_time = false);

/// A tick of the simulator with the case's input.
void stepCase(const HardCase& one, Simulator& simulator);

}  // namespace rigid_body_sim::reference

#pragma once

#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "tools/accuracy_report/effect_costs.hpp"
#include "tools/accuracy_report/errors.hpp"

namespace rigid_body_sim::report {

/// What is to be flown, and how often it is timed.
struct Plan {
  std::string name;  ///< of the case or scene
  Scene scene;
  double over_s = 60;
  std::vector<int> substeps;             ///< ascending
  std::vector<double> tolerances;        ///< descending; for methods that adapt their step
  std::vector<std::string> rungs;        ///< names of integrators; empty: all
  bool says_own_method = false;          ///< the scene is a file: say what it flies by itself
  int repeats = 7;                       ///< timed runs of each method
  double longest_s = 10;                 ///< of wall time that one flight may take
  StepCommand count_instructions_with;   ///< empty: instructions are not counted
  EffectStepCommand count_effects_with;  ///< the same of single effects
};

enum class Outcome { kFlown, kRefused, kInfinite, kSkipped };

/// What one method makes of the scene, and what that costs.
struct Row {
  Method method;
  bool adapts = false;  ///< has a tolerance instead of substeps
  Outcome outcome = Outcome::kFlown;
  std::string why;      ///< if not flown: `refused: |w| h is 2 rad, at most 0.5`
  FlightErrors flight;  ///< empty if refused or skipped
  double evaluations = std::numeric_limits<double>::quiet_NaN();   ///< of the effects, a tick
  double instructions = std::numeric_limits<double>::quiet_NaN();  ///< a body and tick; NaN: not
                                                                   ///< counted
  Cost cost;                                                       ///< of a body's tick
  bool is_on_front = false;                                        ///< see markFront
};

struct Report {
  std::string name;
  Scene scene;
  bool says_own_method = false;
  double over_s = 0;  ///< a whole number of ticks
  Tick ticks = 0;
  TrueTrajectory truth;
  bool rotates = true;     ///< errors are judged in rad; else, as all bodies are points, in m
  Eigen::Index shown = 0;  ///< the body that is drawn: see worstBody
  std::vector<Row> rows;
  std::optional<EffectCosts> effects;  ///< if the scene has any
};

/// Told of what is being done, and how much of it is.
using Progress = std::function<void(const std::string& what, double part)>;

/// Flies all of it. @throws std::invalid_argument for a scene or rung that is none.
Report make(const Plan& plan, const Progress& progress);

/// The error that a row is judged by: the largest of the attitude [rad], or of the position [m].
double errorOf(const Report& report, const Row& row);

/// How far the true flight itself is to be trusted, in the same unit.
double doubtOf(const Report& report);

/// Costs that differ by less than this factor count as equal: the noise of the clock beside other
/// programs, with which equal steps were seen to differ by a ninth.
constexpr double kSameCost = 1.2;

/// Whether `by` is at least as accurate and as cheap, and better in one; of equals, the first of
/// the rows. Errors count as equal if they differ by no more than the doubt, or are below it.
bool isBeaten(const Report& report, const Row& row, const Row& by);

/// The body that is farthest off where a rung of middling quality flies with its largest steps.
/// Of equals the first; at least one that rotates if any does.
Eigen::Index worstBody(const Report& report);

/// Marks the rows that no other of the front beats. Rows that are off by more than a radian have
/// lost the attitude and do not count.
void markFront(Report& report);

/// `rk4`, `rk4 x 3`, `adaptive 1e-08`.
std::string nameOf(const Row& row);

/// Simulated seconds a second of the processor, of all bodies together.
double realTimeFactor(const Report& report, const Row& row);

/// A case of the library as a scene.
/// @throws std::invalid_argument naming all cases.
Scene sceneOfCase(const std::string& name);

}  // namespace rigid_body_sim::report

#pragma once

#include <iosfwd>
#include <limits>
#include <string>
#include <vector>

#include "tools/accuracy_report/cost.hpp"

namespace rigid_body_sim::report {

/// What an effect costs, beyond a tick without any effects.
struct EffectCost {
  std::string name;
  std::size_t bodies = 0;  ///< on which it acts
  double time_ns = 0;      ///< of a body's tick; a body of the scene, whether it acts on it or not
  double instructions = std::numeric_limits<double>::quiet_NaN();  ///< the same; NaN: not counted
};

struct EffectCosts {
  Method method;
  EffectCost none;                ///< all of a tick without effects
  std::vector<EffectCost> alone;  ///< each effect by itself, above `none`
  EffectCost together;            ///< all of them, above `none`
};

/// The command line of a program that does stepAsCounted() with these effects alone, and ends.
using EffectStepCommand = std::function<std::vector<std::string>(
    const std::vector<Method>& methods, const std::vector<std::string>& effects)>;

/// Names of the scene's effects, each once.
std::vector<std::string> effectNamesOf(const Scene& scene);

/// The scene with these of its effects alone.
Scene withEffects(Scene scene, const std::vector<std::string>& names);

/// Timed in turn, medians of `repeats` runs; counted if there is a command.
/// @param tell is told before each count what comes: `none`, an effect, `together`
EffectCosts effectCosts(const Scene& scene, const Method& method, int repeats,
                        const EffectStepCommand& command,
                        const std::function<void(const std::string&)>& tell);

/// A table, a line an effect.
void print(const EffectCosts& costs, std::ostream& out);

/// The same as CSV: effect,bodies,time_ns,instructions.
void writeCsv(const EffectCosts& costs, std::ostream& file);

}  // namespace rigid_body_sim::report

#pragma once

#include <functional>
#include <string>
#include <vector>

#include "rigid_body_sim/trajectory.hpp"

namespace rigid_body_sim::report {

/// Processor time of a body's tick, all that a Simulator does in it included.
struct Cost {
  double median_ns = 0;
  double least_ns = 0;
};

/// A method to be timed over the first `ticks` of the scene.
struct Timed {
  Method method;
  Tick ticks;
};

/// Times the methods in turn, `repeats` times over, so that whatever slows the machine for a while
/// slows all of them. Each run takes at least 3 ms, from the start of the scene as often as it
/// takes.
/// @param progress is told after each run how many are done
std::vector<Cost> costsOf(const Scene& scene, const std::vector<Timed>& methods, int repeats,
                          const std::function<void(std::size_t done)>& progress);

/// How often the effects are evaluated in a tick, counted while one acts; the mean of 50 ticks.
double evaluationsATick(const Scene& scene, const Method& method);

/// Steps the scene by each of these methods in turn, for instructionsATick() to count: fewer ticks
/// of those with many substeps.
void stepAsCounted(const Scene& scene, const std::vector<Method>& methods);

/// The command line of a program that does stepAsCounted() with these methods of one rung, and
/// ends.
using StepCommand = std::function<std::vector<std::string>(const std::vector<Method>& methods)>;

/// Instructions of a body's tick by each of the methods, which are of one rung: the mean of 300
/// ticks after the first, or of fewer, but at least 4, if that were more than 4000 steps. By
/// valgrind's callgrind, all in one process, whose start takes longer than the counting. NaN if
/// there is no valgrind or it fails.
std::vector<double> instructionsATick(std::size_t bodies, const std::vector<Method>& methods,
                                      const StepCommand& command);

}  // namespace rigid_body_sim::report

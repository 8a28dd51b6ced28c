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

/// Steps the scene so often, and nothing else.
void step(const Scene& scene, const Method& method, Tick ticks);

/// The command line of a program that steps the scene by `method` so often and ends.
using StepCommand = std::function<std::vector<std::string>(const Method& method, Tick ticks)>;

/// Instructions of a body's tick, by valgrind's callgrind: 300 ticks more than 100, so that what
/// the program does besides is not in it. NaN if there is no valgrind or it fails.
double instructionsATick(std::size_t bodies, const Method& method, const StepCommand& command);

}  // namespace rigid_body_sim::report

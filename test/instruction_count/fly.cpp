// Flies a scene, for callgrind to count the instructions of flyTicks(). Built twice: with all
// effects, and with gravity alone in the registry and in the binary.
#include <cstdlib>
#include <iostream>

#include "rigid_body_sim/simulator.hpp"

using namespace rigid_body_sim;

/// What is counted; by this name, and never inlined.
extern "C" __attribute__((noinline)) void flyTicks(Simulator& simulator, int ticks) {
  for (int i = 0; i < ticks; ++i) simulator.step();
}

/// fly SCENE TICKS: prints `effect evaluations` of each effect, all ticks together.
int main(int, char** argv) try {
  Simulator simulator(readSceneFile(argv[1]));
  for (int i = 0; i < 3; ++i) simulator.step();  // the first allocate
  flyTicks(simulator, std::atoi(argv[2]));
  for (const EffectCount& count : simulator.effectCounts())
    std::cout << count.name << " " << count.evaluations << "\n";
} catch (const std::exception& error) {
  std::cerr << error.what() << "\n";
  return 1;
}

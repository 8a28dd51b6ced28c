/// Prints what the simulator reads from a URDF: bodies, mass properties, frames, warnings.

#include <cstring>
#include <exception>
#include <iostream>
#include <string>

#include "rigid_body_sim/urdf.hpp"

namespace {

constexpr const char* kUsage = "usage: inspect_urdf [--lock-joints] FILE";
constexpr const char* kHelp =
    "Prints the bodies of a URDF as the simulator reads them: mass properties, lumped frames and\n"
    "warnings. A problem is one line on stderr and exit code 1.\n"
    "  --lock-joints  freeze joints that are neither fixed nor floating at zero, as if fixed\n"
    "  FILE           plain URDF; from xacro: xacro body.urdf.xacro | inspect_urdf /dev/stdin\n";

int failUsage() {
  std::cerr << kUsage << std::endl;
  return 1;
}

}  // namespace

int main(int argc, char** argv) {
  using rigid_body_sim::MovableJoints;
  MovableJoints movable = MovableJoints::kRefuse;
  const char* path = nullptr;
  for (int i = 1; i < argc; ++i) {
    if (std::strcmp(argv[i], "--help") == 0) {
      std::cout << kUsage << '\n' << kHelp;
      return 0;
    }
    if (std::strcmp(argv[i], "--lock-joints") == 0)
      movable = MovableJoints::kLock;
    else if (path != nullptr || argv[i][0] == '-')
      return failUsage();
    else
      path = argv[i];
  }
  if (path == nullptr) return failUsage();
  try {
    std::cout << rigid_body_sim::importReport(rigid_body_sim::readUrdfFile(path, movable))
              << std::flush;
    if (std::cout) return 0;
    std::cerr << path << ": the report cannot be written" << std::endl;
  } catch (const std::exception& error) {
    std::cerr << error.what() << std::endl;
  }
  return 1;
}

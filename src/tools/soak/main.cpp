/// Flies for a hundred million steps, and says whether rounding drifts to one side.

#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <iostream>
#include <string>
#include <vector>

#include "tools/soak/soak.hpp"

namespace rigid_body_sim::soak {
namespace {

int run(double steps, const std::vector<std::string>& chosen) {
  std::vector<Report> reports;
  bool is_as_measured = true;
  for (const std::string& rung : chosen.empty() ? rungs() : chosen) {
    reports.push_back(fly(rung, static_cast<Tick>(steps), [&](double part) {
      if (isatty(STDERR_FILENO) == 1)
        std::fprintf(stderr, "\r%-8s %3d %% ", rung.c_str(), static_cast<int>(100 * part));
    }));
    is_as_measured &= reports.back().isAsMeasured();
  }
  if (isatty(STDERR_FILENO) == 1) std::fprintf(stderr, "\r%*s\r", 20, "");
  print(reports, std::cout);
  return is_as_measured ? 0 : 1;
}

}  // namespace
}  // namespace rigid_body_sim::soak

int main(int argc, char** argv) try {
  double steps = 1e8;
  std::vector<std::string> rungs;
  CLI::App app(
      "Flies 32 bodies for a hundred million steps by exact, split2 and rk4, and says what "
      "rounding "
      "does to |q|, |L| and energy; 1 if that is more than was measured.");
  app.add_option("--steps", steps, "default 1e8, which takes some minutes")
      ->check(CLI::Range(64.0, 1e12));
  app.add_option("--integrators", rungs, "these of exact, split2, rk4")->delimiter(',');
  CLI11_PARSE(app, argc, argv);
  return rigid_body_sim::soak::run(steps, rungs);
} catch (const std::exception& error) {
  std::cerr << error.what() << std::endl;
  return 1;
}

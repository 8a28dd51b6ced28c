#include <time.h>

#include <algorithm>

#include "peer.hpp"

namespace rigid_body_sim::bench {
namespace {

/// The caches hold the scene again, and `exact` has begun to coast, which takes it twice a step's
/// time in the second and the third step: 160 ns instead of 80.
constexpr int kWarmUp = 3;

/// Of many bodies, too: a tenth of a second of simulated time is 5.
constexpr int kFewest = 5;

/// [ns] of all threads of this process, if an engine should have more than one.
double processorTime() {
  timespec now;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return 1e9 * static_cast<double>(now.tv_sec) + static_cast<double>(now.tv_nsec);
}

}  // namespace

double timeStep(const Peer& peer, Eigen::Index bodies, double least_ns) {
  // A look at the clock takes some 0.3 us, a step of the fastest engine some 40 ns: a thousand
  // steps between two looks make that less than a hundredth.
  const int chunk =
      static_cast<int>(std::clamp<Eigen::Index>(kLongestFlight / bodies, kFewest, kLongestFlight));
  double spent = 0;
  long steps = 0;
  for (int flown = kLongestFlight; spent < least_ns; flown += chunk) {
    if (flown + chunk > kLongestFlight) {
      peer.reset();
      peer.step(kWarmUp);
      flown = kWarmUp;
    }
    const double start = processorTime();
    peer.step(chunk);
    spent += processorTime() - start;
    steps += chunk;
  }
  return spent / static_cast<double>(steps);
}

}  // namespace rigid_body_sim::bench

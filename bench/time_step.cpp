#include <time.h>

#include <algorithm>

#include "peer.hpp"

namespace rigid_body_sim::bench {
namespace {

/// The caches hold the scene again, and `exact` has begun to coast, which takes it twice a step's
/// time in the second and the third step: 160 ns instead of 80.
constexpr int kWarmUp = 3;

/// Of many bodies, too: a third of a second of simulated time. An engine that takes its bodies in
/// blocks may keep each in the cache for so long.
constexpr int kFewest = 16;

/// Steps of one body between two looks at the clock: of the fastest engine a tenth of a
/// millisecond.
constexpr Eigen::Index kBetweenLooks = 20000;

/// [ns] of all threads of this process, if an engine should have more than one.
double processorTime() {
  timespec now;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return 1e9 * static_cast<double>(now.tv_sec) + static_cast<double>(now.tv_nsec);
}

/// What a look at the clock takes [ns], some 0.3 to 1.5 us: of a thousand steps of one body a
/// twentieth.
double timeOfLook() {
  double least = 1e9;
  for (int i = 0; i < 100; ++i) {
    const double start = processorTime();
    least = std::min(least, processorTime() - start);
  }
  return least;
}

}  // namespace

double timeStep(const Peer& peer, Eigen::Index bodies, double least_ns) {
  const int chunk =
      static_cast<int>(std::clamp<Eigen::Index>(kBetweenLooks / bodies, kFewest, kLongestFlight));
  const double look = timeOfLook();
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
    spent += processorTime() - start - look;
    steps += chunk;
  }
  return spent / static_cast<double>(steps);
}

}  // namespace rigid_body_sim::bench

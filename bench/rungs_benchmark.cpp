// Time of a step of one body, of every integrator of this package, in nanoseconds: on bare Bodies
// and in a Simulator, for bodies on which nothing acts, on which gravity acts, and on which gravity
// and a wrench each act; 1 to 65,536 bodies, with --million a million, too.
//
//   rungs_benchmark [--million] [--benchmark_filter=exact/ ...]   names: integrator/load/bodies
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstring>

#include "peer.hpp"

namespace rigid_body_sim::bench {
namespace {

constexpr double kRound = 2e6;  // [ns] thousands of times the clock's resolution
constexpr int kRounds = 7;

void run(benchmark::State& state, const PeerRow& row, Load load) {
  const auto count = static_cast<Eigen::Index>(state.range(0));
  load.gyroscopic = Gyroscopic::kOn;
  const Peer peer = row.make(makeScene(load, count, 0.02));
  std::vector<double> steps;
  for ([[maybe_unused]] auto _ : state) {
    steps.push_back(timeStep(peer, count, kRound));
    state.SetIterationTime(steps.back() * 1e-9);
  }
  std::sort(steps.begin(), steps.end());
  state.counters["ns_per_body_step"] = steps[steps.size() / 2] / static_cast<double>(count);
}

void registerAll(bool is_million_wanted) {
  static const std::vector<PeerRow> rows = peerRows();
  for (const PeerRow& row : rows) {
    for (const char* load : {"free", "gravity", "wrench"}) {
      if (row.needs_wrenches && !loadNamed(load).has_wrenches) continue;
      auto* one = benchmark::RegisterBenchmark(
          (row.way + "/" + load).c_str(),
          [&row, load](benchmark::State& state) { run(state, row, loadNamed(load)); });
      one->UseManualTime()->Unit(benchmark::kNanosecond)->Iterations(kRounds);
      for (const Eigen::Index count : {1, 16, 256, 4096, 65536, 1'000'000})
        if (count <= row.most_bodies && (is_million_wanted || count < 1'000'000)) one->Arg(count);
    }
  }
}

}  // namespace
}  // namespace rigid_body_sim::bench

int main(int argc, char** argv) {
  bool is_million_wanted = false;
  if (argc > 1 && std::strcmp(argv[1], "--million") == 0) {
    is_million_wanted = true;
    argv[1] = argv[0];
    ++argv;
    --argc;
  }
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  rigid_body_sim::bench::registerAll(is_million_wanted);
  benchmark::RunSpecifiedBenchmarks();
}

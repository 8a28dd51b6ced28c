// Time of a step of one body in a batch [ns], by kernel, instruction set and number of bodies.
#include "integrators/batch/kernels.hpp"

#include <benchmark/benchmark.h>

#include <random>
#include <string>

namespace rigid_body_sim::batch {
namespace {

/// Bodies that tumble at some 1 rad/s, pushed by wrenches that leave them about as they are.
struct Scene {
  std::ptrdiff_t count;
  std::vector<double> mass, I, p, q, P, L, f, t;

  explicit Scene(std::ptrdiff_t n)
      : count(n), mass(n), I(3 * n), p(3 * n), q(4 * n), P(3 * n), L(3 * n), f(3 * n), t(3 * n) {
    std::mt19937 engine(1);
    const auto number = [&] { return engine() * 0x1p-31 - 1; };
    for (std::ptrdiff_t i = 0; i < n; ++i) {
      mass[i] = 1.5 + number();
      const double a = 1.5 + 0.5 * number(), b = 0.2 + 0.1 * number();
      for (int k = 0; k < 3; ++k) {
        I[i + k * n] = a + k * b;
        p[i + k * n] = number();
        P[i + k * n] = number();
        L[i + k * n] = number();
        f[i + k * n] = 1e-3 * number();
        t[i + k * n] = 1e-3 * number();
      }
      q[i + 3 * n] = 1;
    }
  }

  BodyColumns bodies() {
    return {count, mass.data(), I.data(), p.data(), q.data(), P.data(), L.data()};
  }
  WrenchColumns wrenches() const { return {count, f.data(), t.data()}; }
};

constexpr double kStep = 0.02;

/// How many bodies go through a step together: their state stays in the nearest cache.
constexpr std::ptrdiff_t kBlock = 128;

template <class Step>
void measure(benchmark::State& state, const Step& step) {
  Scene scene(state.range(0));
  const BodyColumns bodies = scene.bodies();
  const WrenchColumns wrenches = scene.wrenches();
  for (auto _ : state) {
    for (std::ptrdiff_t i = 0; i < scene.count; i += kBlock)
      step(bodies, wrenches, Range{i, std::min(i + kBlock, scene.count)});
    benchmark::ClobberMemory();
  }
  state.counters["body"] =
      benchmark::Counter(static_cast<double>(state.iterations() * scene.count) * 1e-9,
                         benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

template <class Step>
void add(const std::string& name, const Step& step) {
  benchmark::RegisterBenchmark(name.c_str(), [step](benchmark::State& s) { measure(s, step); })
      ->Arg(1)
      ->Arg(16)
      ->Arg(256)
      ->Arg(4096)
      ->Arg(65536);
}

void addAll(const Kernels& k) {
  const std::string name = k.name;
  add("kick/" + name, [&k](const auto& b, const auto& w, Range r) { k.kick(b, w, kStep, r); });
  add("constant_rate/" + name,
      [&k](const auto& b, const auto&, Range r) { k.driftAtConstantRate(b, nullptr, kStep, r); });
  add("semi_implicit/" + name,
      [&k](const auto& b, const auto& w, Range r) { k.driftAtConstantRate(b, &w, kStep, r); });
  add("split2/" + name, [&k](const auto& b, const auto& w, Range r) {
    k.driftBySplitting(b, nullptr, kStep, r);
    k.kick(b, w, kStep, r);
  });
  add("no_gyro/" + name,
      [&k](const auto& b, const auto&, Range r) { k.driftWithoutGyroscopicTerm(b, kStep, r); });
}

}  // namespace
}  // namespace rigid_body_sim::batch

int main(int argc, char** argv) {
  for (const auto& one : rigid_body_sim::batch::availableKernels())
    rigid_body_sim::batch::addAll(one);
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
}

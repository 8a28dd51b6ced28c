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
  std::vector<double> mass, I, p, p_low, q, P, L, f, t;
  std::vector<double> p_stage, q_stage, P_stage, L_stage, tiles, spins;

  explicit Scene(std::ptrdiff_t n)
      : count(n),
        mass(n),
        I(3 * n),
        p(3 * n),
        p_low(3 * n),
        q(4 * n),
        P(3 * n),
        L(3 * n),
        f(3 * n),
        t(3 * n),
        p_stage(3 * n),
        q_stage(4 * n),
        P_stage(3 * n),
        L_stage(3 * n),
        tiles(tileSize(n, kRk4Numbers)),
        spins(tileSize(n, kSpinNumbers)) {
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
    return {count, mass.data(), I.data(), p.data(), q.data(), P.data(), L.data(), p_low.data()};
  }
  BodyColumns stages() {
    return {count,          nullptr,        nullptr,        p_stage.data(),
            q_stage.data(), P_stage.data(), L_stage.data(), nullptr};
  }
  WrenchColumns wrenches() const { return {count, f.data(), t.data()}; }
};

constexpr double kStep = 0.02;

/// How many bodies go through a step together: their state stays in the nearest cache.
constexpr std::ptrdiff_t kBlock = 128;

template <class Step>
void measure(benchmark::State& state, const Step& step) {
  Scene scene(state.range(0));
  for (auto _ : state) {
    for (std::ptrdiff_t i = 0; i < scene.count; i += kBlock)
      step(scene, Range{i, std::min(i + kBlock, scene.count)});
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
  add("kick/" + name, [&k](Scene& s, Range r) { k.kick(s.bodies(), s.wrenches(), kStep, r); });
  add("constant_rate/" + name,
      [&k](Scene& s, Range r) { k.driftAtConstantRate(s.bodies(), nullptr, kStep, r); });
  add("semi_implicit/" + name, [&k](Scene& s, Range r) {
    const WrenchColumns wrenches = s.wrenches();
    k.driftAtConstantRate(s.bodies(), &wrenches, kStep, r);
  });
  add("split2/" + name, [&k](Scene& s, Range r) {
    const WrenchColumns wrenches = s.wrenches();
    k.driftBySplitting(s.bodies(), &wrenches, kStep, r);
    k.kick(s.bodies(), wrenches, kStep, r);
  });
  add("no_gyro/" + name,
      [&k](Scene& s, Range r) { k.driftWithoutGyroscopicTerm(s.bodies(), kStep, r); });
  add("rk4_free/" + name, [&k](Scene& s, Range r) { k.rk4Steady(s.bodies(), nullptr, kStep, r); });
  add("rk4_steady/" + name, [&k](Scene& s, Range r) {
    const WrenchColumns wrenches = s.wrenches();
    k.rk4Steady(s.bodies(), &wrenches, kStep, r);
  });
  add("rk4/" + name, [&k](Scene& s, Range r) {
    for (int stage = 0; stage < 4; ++stage)
      k.rk4Stage(s.bodies(), s.stages(), s.wrenches(), s.tiles.data(), stage, kStep, r);
  });
  add("coasting/" + name,
      [&k](Scene& s, Range r) { k.driftSpins(s.bodies(), s.spins.data(), kStep, r); });
  add("exact/" + name, [&k](Scene& s, Range r) {
    double* spins = s.spins.data();
    k.kickSpins(s.bodies(), s.wrenches(), spins, 0.5 * kStep, r);
    k.driftSpins(s.bodies(), spins, kStep, r);
    k.kickSpins(s.bodies(), s.wrenches(), spins, 0.5 * kStep, r);
  });
  add("exact_steady/" + name, [&k](Scene& s, Range r) {
    k.flySpins(s.bodies(), s.wrenches(), s.spins.data(), 0.5 * kStep, kStep, 0.5 * kStep, r);
  });
}

}  // namespace
}  // namespace rigid_body_sim::batch

int main(int argc, char** argv) {
  for (const auto& one : rigid_body_sim::batch::availableKernels())
    rigid_body_sim::batch::addAll(one);
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
}

// The same scene and the same inputs give the same bits, in the core alone.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>

#include "accuracy_scenes.hpp"
#include "integrators/batch/kernels.hpp"

namespace rigid_body_sim {
namespace {

/// FNV-1a over the bits of the states (Fowler, Noll, Vo; offset and prime of the 64-bit variant).
std::uint64_t hashOf(const Simulator& simulator) {
  std::uint64_t hash = 14695981039346656037u;
  const auto add = [&](double number) {
    std::uint64_t bits;
    std::memcpy(&bits, &number, sizeof bits);
    for (int shift = 0; shift < 64; shift += 8)  // the same on machines of either byte order
      hash = (hash ^ ((bits >> shift) & 0xff)) * 1099511628211u;
  };
  for (Eigen::Index i = 0; i < simulator.bodies().count(); ++i) {
    const BodyState body = simulator.state(i);
    for (int k = 0; k < 3; ++k) add(body.p_WBcm(k));
    for (int k = 0; k < 4; ++k) add(body.q_WB.coeffs()(k));
    for (int k = 0; k < 3; ++k) add(body.P_WB(k));
    for (int k = 0; k < 3; ++k) add(body.L_WBcm_W(k));
  }
  return hash;
}

/// Bodies whose frames need no eigenvalue solver and no trigonometric function at the start, so
/// that the golden hash below depends on the loop alone.
Scene scene(const std::string& integrator) {
  Scene scene;
  scene.integrator = integrator;
  for (const char* name : {"dzhanibekov", "tumbling_stone", "prolate_top"}) {
    SceneBody body = sceneBodyOf(reference::caseNamed(name));
    body.X_WL.linear() = Quaterniond(0.5, -0.5, 0.5, 0.5).toRotationMatrix();
    body.X_WL.translation() << 1.25, -0.7, 2.1;
    body.mass_properties.p_FBcm << 0.1, -0.2, 0.3;
    body.v_WBcm << 0.4, -1.1, 0.6;
    scene.bodies.push_back(body);
  }
  scene.effects.push_back(uniformGravity({0.1, 0.2, -9.80665}, {0, 2}));
  return scene;
}

struct Inputs {
  std::vector<WrenchInput> wrenches;
  std::vector<ImpulseInput> impulses;
};

Inputs inputs() {
  Inputs inputs;
  Sampler sample(37);
  for (std::uint64_t i = 0; i < 12; ++i) {
    WrenchInput wrench;
    wrench.body = static_cast<Eigen::Index>(i % 3);
    wrench.applied = {
        i % 2 ? Axes::kBody : Axes::kWorld, {sample.vector(), sample.vector()}, sample.vector()};
    wrench.start = static_cast<Tick>(10 * i);
    wrench.ticks = static_cast<Tick>(i % 3 ? 25 : 0);
    wrench.replaces = i % 4 == 0;
    wrench.origin = {i % 2 ? "one" : "two", i, 0};
    inputs.wrenches.push_back(wrench);
    ImpulseInput impulse;
    impulse.body = wrench.body;
    impulse.applied = wrench.applied;
    impulse.start = wrench.start;
    impulse.origin = wrench.origin;
    inputs.impulses.push_back(impulse);
  }
  return inputs;
}

std::uint64_t hashAfter(Simulator& simulator, const Inputs& inputs, int ticks) {
  for (WrenchInput input : inputs.wrenches) {
    input.start += simulator.tick();
    simulator.apply(input);
  }
  for (ImpulseInput input : inputs.impulses) {
    input.start += simulator.tick();
    simulator.apply(input);
  }
  for (int i = 0; i < ticks; ++i) simulator.step();
  return hashOf(simulator);
}

std::uint64_t hashAfter(const std::string& integrator, const Inputs& inputs, int ticks = 300) {
  Simulator simulator(scene(integrator));
  return hashAfter(simulator, inputs, ticks);
}

TEST(Determinism, TwoRunsGiveTheSameHash) {
  for (const IntegratorRow& row : integrators())
    EXPECT_EQ(hashAfter(row.name, inputs()), hashAfter(row.name, inputs())) << row.name;
}

TEST(Determinism, TheOrderOfApplyingDoesNotCount) {
  for (const IntegratorRow& row : integrators()) {
    const std::uint64_t expected = hashAfter(row.name, inputs());
    Inputs shuffled = inputs();
    std::mt19937 shuffler(41);
    for (int round = 0; round < 5; ++round) {
      std::shuffle(shuffled.wrenches.begin(), shuffled.wrenches.end(), shuffler);
      std::shuffle(shuffled.impulses.begin(), shuffled.impulses.end(), shuffler);
      EXPECT_EQ(hashAfter(row.name, shuffled), expected) << row.name;
    }
  }
}

TEST(Determinism, AResetRunsTheSameAgain) {
  for (const IntegratorRow& row : integrators()) {
    Simulator simulator(scene(row.name));
    const std::uint64_t first = hashAfter(simulator, inputs(), 300);
    simulator.reset();
    EXPECT_EQ(hashAfter(simulator, inputs(), 300), first) << row.name;
  }
}

TEST(Determinism, TheHashSeesASingleBit) {
  Inputs changed = inputs();
  double& number = changed.impulses.back().applied.wrench.f_F.x();
  number = std::nextafter(number, 2);
  EXPECT_NE(hashAfter("split2", changed), hashAfter("split2", inputs()));
  EXPECT_NE(hashAfter("split2", inputs(), 299), hashAfter("split2", inputs(), 300));
}

TEST(Determinism, GoldenHashOfSplit2) {
  // Holds wherever doubles are IEEE 754's and nothing is fused (-ffp-contract=off): found equal for
  // gcc 12.2 and clang 14 at -O0, -O2, -O3 and -O3 -march=native, on x86-64.
  // A change of the loop's arithmetic changes it; then it is to be changed here, knowingly. The
  // turns of a step stay below the switch to the C library's sine, so that one is not in it.
  Simulator simulator(scene("split2"));
  hashAfter(simulator, inputs(), 0);
  for (int tick = 0; tick < 300; ++tick) {
    simulator.step();
    for (Eigen::Index i = 0; i < 3; ++i)
      EXPECT_LT(simulator.state(i).L_WBcm_W.norm() / simulator.bodies().moments(i)(1) * 0.02, 0.6);
  }
  EXPECT_EQ(hashOf(simulator), 3432473673245249502u);
}

/// Bodies of many kinds under gravity, and a wrench on every fifth.
std::uint64_t hashOfCrowd(const std::string& integrator, Eigen::Index count, int threads) {
  Scene scene;
  scene.integrator = integrator;
  scene.threads = threads;
  Sampler sample(5);
  std::vector<Eigen::Index> all;
  for (Eigen::Index i = 0; i < count; ++i) {
    all.push_back(i);
    const Vector3d I(1, 1.1 + 0.4 * std::abs(sample.number()), 1.6);
    scene.bodies.push_back(bodyOf("b" + std::to_string(i), I,
                                  i % 7 == 0 ? Vector3d::Zero() : Vector3d(2 * sample.vector())));
    scene.bodies.back().v_WBcm = sample.vector();
  }
  scene.effects.push_back(uniformGravity({0.1, 0.2, -9.8}, all));
  Simulator simulator(scene);
  for (Eigen::Index i = 0; i < count; i += 5) {
    WrenchInput push;
    push.body = i;
    push.applied.wrench = {sample.vector(), sample.vector()};
    push.start = i % 3;
    simulator.apply(push);
  }
  simulator.advance(12);
  return hashOf(simulator);
}

TEST(Determinism, AnyNumberOfThreadsGivesTheSameBits) {
  for (const std::string integrator : {"semi_implicit", "rk4", "exact"})
    for (const int threads : {2, 3, 8})
      EXPECT_EQ(hashOfCrowd(integrator, 2500, threads), hashOfCrowd(integrator, 2500, 1))
          << integrator << " " << threads;
}

/// Run by the next test, in a process of its own.
TEST(Determinism, DISABLED_HashesOfCrowds) {
  for (const IntegratorRow& row : integrators())
    for (const Eigen::Index count : {1, 2, 3, 7, 150})
      std::printf("HASH %s %ld %lx\n", row.name.c_str(), static_cast<long>(count),
                  static_cast<unsigned long>(hashOfCrowd(row.name, count, 1)));
}

/// What that test prints with the kernels of this name.
std::string hashesWith(const std::string& kernels) {
  const std::string program = std::filesystem::read_symlink("/proc/self/exe");
  const std::string command = "RIGID_BODY_SIM_KERNELS=" + kernels + " '" + program +
                              "' --gtest_also_run_disabled_tests"
                              " --gtest_filter='*DISABLED_HashesOfCrowds' | grep HASH";
  std::string text;
  FILE* pipe = popen(command.c_str(), "r");
  for (int c = 0; (c = std::fgetc(pipe)) != EOF;) text += static_cast<char>(c);
  pclose(pipe);
  return text;
}

TEST(Determinism, EveryInstructionSetGivesTheSameBits) {
  const std::string plain = hashesWith("plain");
  EXPECT_EQ(std::count(plain.begin(), plain.end(), '\n'), 5 * integrators().size());
  for (const batch::Kernels& one : batch::availableKernels())
    EXPECT_EQ(hashesWith(one.name), plain) << one.name;
  EXPECT_EQ(hashesWith("of_no_processor"), "");
}

}  // namespace
}  // namespace rigid_body_sim

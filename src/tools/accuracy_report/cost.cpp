#include "tools/accuracy_report/cost.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <limits>
#include <memory>

#include "rigid_body_sim/simulator.hpp"
#include "tools/accuracy_report/errors.hpp"

extern char** environ;

namespace rigid_body_sim::report {
namespace {

constexpr double kRunS = 3e-3;  // [s] thousands of times the clock's resolution

/// Acts on nothing, and counts how often it is asked.
class Counter : public Effect {
 public:
  explicit Counter(long& count) : count_(count) {}
  std::string name() const override { return "counter"; }
  std::size_t bodyCount() const override { return 1; }
  void addWrenches(const Instant&, Wrenches&) const override { ++count_; }

 private:
  long& count_;
};

/// [ns] a tick, of one run. The processor's time: what other programs take of it is not counted.
double timeTick(const Scene& scene, Tick ticks) {
  double spent_s = 0;
  Tick done = 0;
  while (spent_s < kRunS) {
    Simulator simulator(scene);
    const std::clock_t start = std::clock();
    for (Tick i = 0; i < ticks; ++i) simulator.step();
    spent_s += static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
    done += ticks;
  }
  return spent_s * 1e9 / static_cast<double>(done);
}

/// Runs a program without a word of it. Its exit code, or -1.
int runSilently(std::vector<std::string> command) {
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
  std::vector<char*> arguments;
  for (std::string& word : command) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  pid_t child = 0;
  const int error =
      posix_spawnp(&child, arguments[0], &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  int status = 0;
  if (error != 0 || waitpid(child, &status, 0) != child || !WIFEXITED(status)) return -1;
  return WEXITSTATUS(status);
}

/// The line `totals: 123` of callgrind's file.
double totalIn(const std::string& path) {
  std::ifstream file(path);
  const std::string key = "totals: ";
  for (std::string line; std::getline(file, line);)
    if (line.rfind(key, 0) == 0) return std::strtod(line.c_str() + key.size(), nullptr);
  return std::numeric_limits<double>::quiet_NaN();
}

/// Ticks enough for a mean, as long as they are not too many steps: callgrind takes some 0.1 s for
/// 10,000 of one body.
Tick countedTicks(const Method& method) {
  constexpr Tick kMost = 300, kLeast = 4, kMostSteps = 4000;
  return std::min(kMost, std::max<Tick>(kLeast, kMostSteps / method.substeps));
}

}  // namespace

std::vector<Cost> costsOf(const Scene& scene, const std::vector<Timed>& methods, int repeats,
                          const std::function<void(std::size_t)>& progress) {
  std::vector<std::vector<double>> times(methods.size());
  std::size_t done = 0;
  for (int repeat = 0; repeat < repeats; ++repeat) {
    for (std::size_t k = 0; k < methods.size(); ++k) {
      times[k].push_back(timeTick(withMethod(scene, methods[k].method), methods[k].ticks));
      progress(++done);
    }
  }
  std::vector<Cost> costs;
  const auto bodies = static_cast<double>(scene.bodies.size());
  for (std::vector<double>& of_one : times) {
    std::sort(of_one.begin(), of_one.end());
    costs.push_back({of_one[of_one.size() / 2] / bodies, of_one.front() / bodies});
  }
  return costs;
}

double evaluationsATick(const Scene& scene, const Method& method) {
  constexpr Tick kTicks = 50;
  long count = 0;
  Scene counted = withMethod(scene, method);
  counted.effects.push_back(std::make_shared<Counter>(count));
  Simulator simulator(counted);
  count = 0;  // at the start the scene was looked at
  for (Tick i = 0; i < kTicks; ++i) simulator.step();
  return static_cast<double>(count) / kTicks;
}

/// What callgrind counts.
extern "C" __attribute__((noinline)) void stepTicks(Simulator& simulator, Tick ticks) {
  for (Tick i = 0; i < ticks; ++i) simulator.step();
}

void stepAsCounted(const Scene& scene, const std::vector<Method>& methods) {
  for (const Method& method : methods) {
    Simulator simulator(withMethod(scene, method));
    simulator.step();  // the first allocates
    stepTicks(simulator, countedTicks(method));
  }
}

std::vector<double> instructionsATick(std::size_t bodies, const std::vector<Method>& methods,
                                      const StepCommand& command) {
  namespace fs = std::filesystem;
  std::string folder = (fs::temp_directory_path() / "callgrind.XXXXXX").string();
  std::vector<double> counts(methods.size(), std::numeric_limits<double>::quiet_NaN());
  if (!mkdtemp(folder.data())) return counts;
  const std::string path = folder + "/out";
  std::vector<std::string> words = {"valgrind", "--tool=callgrind", "--toggle-collect=stepTicks",
                                    "--dump-after=stepTicks", "--callgrind-out-file=" + path};
  const std::vector<std::string> program = command(methods);
  words.insert(words.end(), program.begin(), program.end());
  if (runSilently(words) == 0)
    for (std::size_t k = 0; k < methods.size(); ++k)  // a file for each call, from 1 on
      counts[k] = totalIn(path + "." + std::to_string(k + 1)) /
                  static_cast<double>(countedTicks(methods[k])) / static_cast<double>(bodies);
  fs::remove_all(folder);
  return counts;
}

}  // namespace rigid_body_sim::report

/// Flies a case or a scene with every integrator and step size, and says what accuracy costs.

#include <unistd.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <sstream>
#include <string>
#include <vector>

#include "reference/cases.hpp"
#include "tools/accuracy_report/output.hpp"
#include "tools/csv.hpp"

namespace rigid_body_sim::report {
namespace {

struct Arguments {
  std::string scene_file;
  std::string case_name;
  std::string output;
  bool has_no_plots = false;
  bool counts_instructions = false;
  bool lists_cases = false;
  bool only_counts = false;
  std::vector<std::string> only_effects;
  Plan plan;
};

/// A number within bounds; says so with its unit when it is not.
CLI::Validator within(double least, double most, const std::string& unit, bool is_whole = false) {
  std::ostringstream range;
  range.precision(12);
  range << (is_whole ? "a whole number" : "a number") << " from " << least << " to " << most
        << (unit.empty() ? "" : " ") << unit;
  const std::string wanted = range.str();
  return {[=](std::string& text) -> std::string {
            char* end = nullptr;
            const double number = std::strtod(text.c_str(), &end);
            const bool is_number = !text.empty() && *end == '\0';
            if (is_number && number >= least && number <= most &&
                !(is_whole && text.find_first_not_of("+0123456789") != std::string::npos))
              return {};
            return "'" + text + "' is not " + wanted;
          },
          "(" + wanted + ")"};
}

std::string ownPath() { return std::filesystem::read_symlink("/proc/self/exe").string(); }

void listCases() {
  for (const reference::Case& one : reference::cases())
    std::cout << one.name << "\n    I = (" << one.I_BBcm_B.transpose() << ") kg m^2, w = ("
              << one.w_WB_B.transpose() << ") rad/s\n    " << one.source << '\n';
}

/// How this program is run again under valgrind.
StepCommand stepCommand(const Arguments& arguments) {
  const std::string scene = arguments.scene_file;
  const std::string name = arguments.case_name;
  return [scene, name](const std::vector<Method>& methods) {
    std::ostringstream substeps, tolerances;
    for (const Method& method : methods) {
      const char* comma = &method == &methods.front() ? "" : ",";
      substeps << comma << method.substeps;
      tolerances << comma << method.tolerance;
    }
    // The scene first: an option that takes a list would swallow it.
    return std::vector<std::string>{ownPath(),
                                    scene.empty() ? "--case=" + name : scene,
                                    "--only-count",
                                    "--integrators=" + methods.front().integrator,
                                    "--substeps=" + substeps.str(),
                                    "--tolerances=" + tolerances.str()};
  };
}

EffectStepCommand effectStepCommand(const StepCommand& command) {
  return [command](const std::vector<Method>& methods, const std::vector<std::string>& effects) {
    std::string names;
    for (const std::string& effect : effects) names += (names.empty() ? "" : ",") + effect;
    std::vector<std::string> words = command(methods);
    words.push_back("--only-effects=" + (names.empty() ? "none" : names));
    return words;
  };
}

/// Where a bar would not do: a line every now and then, none in a run that is done before.
void tellProgress(const std::string& what, double part) {
  using Clock = std::chrono::steady_clock;
  constexpr std::chrono::seconds kEvery(5);
  static Clock::time_point last = Clock::now();
  if (Clock::now() - last < kEvery) return;
  last = Clock::now();
  std::fprintf(stderr, "%3d %%: %s\n", static_cast<int>(100 * part), what.c_str());
}

/// A bar on a terminal, else lines.
void showProgress(const std::string& what, double part) {
  static const bool is_terminal = isatty(STDERR_FILENO) == 1;
  constexpr int kWidth = 40;
  if (!is_terminal) return part < 1 ? tellProgress(what, part) : void();
  const int done = static_cast<int>(part * kWidth);
  const std::string bar = std::string(done, '#') + std::string(kWidth - done, '.');
  std::fprintf(stderr, "\r[%s] %3d %% %-40.40s", bar.c_str(), static_cast<int>(100 * part),
               what.c_str());
  if (part >= 1) std::fprintf(stderr, "\r%*s\r", kWidth + 50, "");
}

void addOptions(CLI::App& app, Arguments& arguments) {
  Plan& plan = arguments.plan;
  app.add_option("scene", arguments.scene_file, "YAML file of a scene, as the simulator takes it");
  app.add_option("--case", arguments.case_name, "a case of the library instead of a scene");
  app.add_flag("--list", arguments.lists_cases, "list the cases and end");
  app.add_option("--over", plan.over_s, "simulated time [s], default 60")
      ->check(within(1e-6, 1e9, "s"));
  app.add_option("--substeps", plan.substeps,
                 "numbers of substeps a tick, ascending, default 1,2,4,8,16,32,64,256,1024,4096; a "
                 "rung stops at the first that the reference cannot tell from the truth")
      ->delimiter(',')
      ->check(within(1, 1 << 24, "", true));
  app.add_option("--tolerances", plan.tolerances,
                 "of rungs that adapt their step, default 1e-4,1e-6,1e-8,1e-10,1e-12")
      ->delimiter(',')
      ->check(within(1e-16, 1, ""));
  app.add_option("--integrators", plan.rungs, "the rungs, default all")->delimiter(',');
  app.add_option("--repeats", plan.repeats, "timed runs of each row, the median counts; default 7")
      ->check(within(1, 1000, "", true));
  app.add_option("--longest", plan.longest_s, "wall time a flight may take [s], default 10")
      ->check(within(1e-3, 1e6, "s"));
  app.add_flag("--instructions", arguments.counts_instructions,
               "count instructions with valgrind; some seconds a rung");
  const auto output =
      app.add_option("--output", arguments.output, "folder for CSV files and plots; default none");
  app.add_flag("--no-plots", arguments.has_no_plots, "write the CSV files only")->needs(output);
  app.add_flag(
      "--only-count", arguments.only_counts,
      "step one rung as --instructions counts it and end, for valgrind or perf to look at: "
      "4 to 300 ticks of each row, in stepTicks()");
  app.add_option("--only-effects", arguments.only_effects,
                 "step with these of the scene's effects alone, or `none`")
      ->delimiter(',');
}

void readScene(Arguments& arguments) {
  if (arguments.scene_file.empty() == arguments.case_name.empty())
    throw std::invalid_argument("give either a scene file or --case; --list names the cases");
  if (!arguments.case_name.empty()) {
    arguments.plan.name = arguments.case_name;
    arguments.plan.scene = sceneOfCase(arguments.case_name);
  } else {
    const std::filesystem::path path = std::filesystem::absolute(arguments.scene_file);
    arguments.plan.name = path.stem().string();
    arguments.plan.scene = readSceneFile(path.string());
    arguments.plan.says_own_method = true;
  }
}

void fillDefaults(Plan& plan) {
  if (plan.substeps.empty()) plan.substeps = {1, 2, 4, 8, 16, 32, 64, 256, 1024, 4096};
  if (plan.tolerances.empty()) plan.tolerances = {1e-4, 1e-6, 1e-8, 1e-10, 1e-12};
}

void onlyCount(const Arguments& arguments) {
  const Plan& plan = arguments.plan;
  if (plan.rungs.size() != 1) throw std::invalid_argument("--only-count wants one integrator");
  const Scene scene =
      arguments.only_effects.empty() ? plan.scene : withEffects(plan.scene, arguments.only_effects);
  const bool adapts = integratorNamed(plan.rungs.front()).order == 0;
  std::vector<Method> methods;
  for (std::size_t k = 0; k < (adapts ? plan.tolerances.size() : plan.substeps.size()); ++k)
    methods.push_back({plan.rungs.front(), adapts ? 1 : plan.substeps[k],
                       adapts ? plan.tolerances[k] : Method().tolerance});
  stepAsCounted(scene, methods);
}

/// Hands over to the script, which stands beside this program; it says where the pictures are.
int plot(const std::string& folder) {
  const std::string script = std::filesystem::path(ownPath()).replace_filename("plot_accuracy");
  execl(script.c_str(), script.c_str(), folder.c_str(), nullptr);
  std::cerr << "no plots: " << script << " cannot be run" << std::endl;
  return 1;
}

int run(Arguments& arguments) {
  if (arguments.lists_cases) return listCases(), 0;
  readScene(arguments);
  fillDefaults(arguments.plan);
  if (arguments.only_counts) return onlyCount(arguments), 0;
  if (arguments.counts_instructions) {
    arguments.plan.count_instructions_with = stepCommand(arguments);
    arguments.plan.count_effects_with = effectStepCommand(stepCommand(arguments));
  }
  const bool has_output = !arguments.output.empty();
  const std::string folder = has_output ? std::filesystem::absolute(arguments.output).string() : "";
  if (has_output) prepareFolder(folder);  // before the flights: they may take minutes
  const Report report = make(arguments.plan, showProgress);
  showProgress("", 1);
  print(report, std::cout);
  if (!has_output) return 0;
  writeCsv(report, folder);
  std::cout << "\nNumbers: " << folder << "/*.csv" << std::endl;
  return arguments.has_no_plots ? 0 : plot(folder);
}

/// roslaunch gives every program ROS's own arguments, `__name:=...`; this one is no node.
std::vector<const char*> withoutRos(int argc, char** argv) {
  std::vector<const char*> words;
  for (int i = 0; i < argc; ++i) {
    const std::string word = argv[i];
    if (word.rfind("__", 0) != 0 || word.find(":=") == std::string::npos) words.push_back(argv[i]);
  }
  return words;
}

}  // namespace
}  // namespace rigid_body_sim::report

int main(int argc, char** argv) try {
  rigid_body_sim::report::Arguments arguments;
  CLI::App app(
      "Flies a scene with every integrator and several step sizes, and says what accuracy costs in "
      "time.");
  rigid_body_sim::report::addOptions(app, arguments);
  const std::vector<const char*> words = rigid_body_sim::report::withoutRos(argc, argv);
  try {
    app.parse(static_cast<int>(words.size()), words.data());
  } catch (const CLI::ParseError& error) {
    return app.exit(error);
  }
  return run(arguments);
} catch (const std::exception& error) {
  std::cerr << error.what() << std::endl;
  return 1;
}

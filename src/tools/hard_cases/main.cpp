/// Flies the gallery of hard cases with every integrator, and says which of them bears what.

#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <string>

#include "tools/csv.hpp"
#include "tools/hard_cases/matrix.hpp"
#include "tools/hard_cases/peers.hpp"

namespace rigid_body_sim::hard_cases {
namespace {

struct Arguments {
  Plan plan;
  Peers peers;
  std::string output;
  bool has_no_plot = false;
  bool lists_cases = false;
};

void addOptions(CLI::App& app, Arguments& arguments) {
  app.add_option("--case", arguments.plan.cases, "these cases, default all")->delimiter(',');
  app.add_option("--integrators", arguments.plan.rungs, "the rungs, default all")->delimiter(',');
  const auto is_long =
      app.add_flag("--long", arguments.plan.takes_its_time,
                   "1e8 steps, a year, six hours where a row has such a way; many minutes");
  app.add_option(
         "--peers", arguments.peers.folder,
         "other engines beside: folder of their programs, which scripts/compare_hard_cases builds; "
         "some minutes")
      ->excludes(is_long);
  app.add_flag("--list", arguments.lists_cases,
               "list the cases, what must hold, and how others fail on them");
  const auto output =
      app.add_option("--output", arguments.output, "folder for CSV files and the picture");
  app.add_flag("--no-plot", arguments.has_no_plot, "write the CSV files only")->needs(output);
}

void listCases() {
  for (const reference::HardCase& one : reference::gallery()) {
    std::cout << one.name << ": " << one.what << "\n    " << one.ticks
              << " ticks; the answer: " << one.source << "\n    elsewhere: " << one.elsewhere
              << '\n';
    for (const auto& bound : one.must) std::cout << "    must hold: " << bound.why << '\n';
    for (const auto& excuse : one.excuses) {
      std::cout << "    " << nameOf(excuse.outcome) << ":";
      for (const std::string& rung : excuse.rungs) std::cout << ' ' << rung;
      std::cout << ": " << excuse.why << '\n';
    }
  }
}

/// A bar on a terminal; nothing into files.
void showProgress(const std::string& what, double part) {
  static const bool is_terminal = isatty(STDERR_FILENO) == 1;
  if (!is_terminal) return;
  std::fprintf(stderr, "\r%3d %% %-60.60s", static_cast<int>(100 * part), what.c_str());
  if (part >= 1) std::fprintf(stderr, "\r%*s\r", 70, "");
}

/// Hands over to the script, which stands beside this program; it says where the picture is.
int plot(const std::string& folder) {
  const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe");
  const std::string script = std::filesystem::path(self).replace_filename("plot_hard_cases");
  execl(script.c_str(), script.c_str(), folder.c_str(), nullptr);
  std::cerr << "no picture: " << script << " cannot be run" << std::endl;
  return 1;
}

int run(const Arguments& arguments) {
  if (arguments.lists_cases) return listCases(), 0;
  if (!arguments.peers.folder.empty()) engineNames(arguments.peers);  // refused before the flights
  const bool has_output = !arguments.output.empty();
  const std::string folder = has_output ? std::filesystem::absolute(arguments.output).string() : "";
  if (has_output) prepareFolder(folder);
  const std::vector<Cell> cells = fly(arguments.plan, showProgress);
  showProgress("", 1);
  print(cells, std::cout);
  std::vector<PeerCell> peers;
  if (!arguments.peers.folder.empty()) {
    peers = flyPeers(arguments.peers, arguments.plan.cases, showProgress);
    showProgress("", 1);
    print(peers, std::cout);
  }
  const bool is_kept =
      std::all_of(cells.begin(), cells.end(), [](const Cell& cell) { return cell.keepsClaim(); });
  if (has_output) {
    writeCsv(cells, folder);
    std::filesystem::remove(folder + "/peers.csv");  // of an earlier flight
    if (!peers.empty()) writeCsv(peers, folder);
    std::cout << "\nNumbers: " << folder << "/*.csv" << std::endl;
    if (!arguments.has_no_plot && is_kept) return plot(folder);
  }
  return is_kept ? 0 : 1;
}

}  // namespace
}  // namespace rigid_body_sim::hard_cases

int main(int argc, char** argv) try {
  rigid_body_sim::hard_cases::Arguments arguments;
  CLI::App app(
      "Flies the gallery of hard cases with every integrator; 1 if one is not as claimed.");
  rigid_body_sim::hard_cases::addOptions(app, arguments);
  CLI11_PARSE(app, argc, argv);
  return rigid_body_sim::hard_cases::run(arguments);
} catch (const std::exception& error) {
  std::cerr << error.what() << std::endl;
  return 1;
}

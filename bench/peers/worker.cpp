// The program around one engine: makes it fly when told to on its standard input. A process of its
// own for each, as two builds of an engine (Bullet's) have the same symbols, and as an engine may
// end its process.
//
//   list                      the rows of this engine, fields by tabs
//   error ROW LOAD STEP TIME  attitude error [rad] after TIME [s] in steps of STEP [s]
//   open ROW LOAD BODIES      answers with a handle
//   time HANDLE NS            steps for NS [ns]; answers with the time of a step of one body [ns]
//   close HANDLE
//   names                     of the rows that fly hard cases
//   hard NAME CASE            what becomes of a case of the gallery; see hard_case.hpp
//
// A line with a dot ends every answer. With words on its command line it answers these and ends.
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <exception>
#include <iostream>
#include <map>
#include <sstream>

#include "hard_case.hpp"
#include "peer.hpp"

namespace rigid_body_sim::bench {
namespace {

struct Opened {
  Peer peer;
  Eigen::Index bodies;
};

class Worker {
 public:
  std::string answer(const std::string& line) {
    std::istringstream words(line);
    std::string verb;
    words >> verb;
    std::ostringstream text;
    text.precision(9);
    if (verb == "list") list(text);
    if (verb == "error") text << error(words);
    if (verb == "open") text << open(words);
    if (verb == "time") text << time(words);
    if (verb == "close") {
      int handle = 0;
      words >> handle;
      opened_.erase(handle);
    }
    if (verb == "names")
      for (const PeerRow& row : rows_)
        if (!row.hard_cases.empty()) text << row.hard_cases << '\n';
    if (verb == "hard") text << hard(words);
    return text.str();
  }

 private:
  void list(std::ostream& text) const {
    for (const PeerRow& row : rows_)
      text << row.engine << '\t' << row.way << '\t' << row.about << '\t' << row.most_bodies << '\t'
           << row.limit << '\t' << row.is_gyroscopic_optional << '\t' << row.needs_wrenches << '\n';
  }

  double error(std::istream& words) const {
    std::size_t row = 0;
    std::string load;
    double step_s = 0, time_s = 0;
    words >> row >> load >> step_s >> time_s;
    const Scene scene = makeScene(loadNamed(load), 1, step_s);
    const Peer peer = rows_.at(row).make(scene);
    peer.reset();
    peer.step(static_cast<int>(std::lround(time_s / step_s)));
    return attitudeError(scene, peer.motionOf(0).q_WB, time_s);
  }

  std::string hard(std::istream& words) const {
    std::string name, one;
    std::getline(words >> std::ws, name, '\t');
    words >> one;
    for (const PeerRow& row : rows_)
      if (row.hard_cases == name && !name.empty())
        return flyHardCase(row, reference::hardCaseNamed(one));
    throw std::invalid_argument("no row flies hard cases by the name '" + name + "'");
  }

  int open(std::istream& words) {
    std::size_t row = 0;
    std::string load;
    Eigen::Index bodies = 0;
    words >> row >> load >> bodies;
    constexpr double kStep = 0.02;  // [s] the package's default
    opened_[++last_] = {rows_.at(row).make(makeScene(loadNamed(load), bodies, kStep)), bodies};
    return last_;
  }

  double time(std::istream& words) {
    int handle = 0;
    double least_ns = 0;
    words >> handle >> least_ns;
    const Opened& one = opened_.at(handle);
    return timeStep(one.peer, one.bodies, least_ns) / static_cast<double>(one.bodies);
  }

  std::vector<PeerRow> rows_ = peerRows();
  std::map<int, Opened> opened_;
  int last_ = 0;
};

}  // namespace
}  // namespace rigid_body_sim::bench

int main(int argc, char** argv) try {
  // What an engine prints of its own goes to the error output.
  std::FILE* answers = fdopen(dup(STDOUT_FILENO), "w");
  dup2(STDERR_FILENO, STDOUT_FILENO);
  rigid_body_sim::bench::Worker worker;
  std::string line;
  for (int k = 1; k < argc; ++k) line += (k == 1 ? "" : k == 2 ? " " : "\t") + std::string(argv[k]);
  if (argc > 1) {
    std::fprintf(answers, "%s\n.\n", worker.answer(line).c_str());
    return 0;
  }
  while (std::getline(std::cin, line)) {
    std::fprintf(answers, "%s\n.\n", worker.answer(line).c_str());
    std::fflush(answers);
  }
} catch (const std::exception& error) {
  std::cerr << error.what() << "\n";
  return 1;
}

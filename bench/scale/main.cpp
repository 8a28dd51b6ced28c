// How many bodies the node carries; scripts/scale has a master for it, and says what to give it.
#include <ros/ros.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <sstream>
#include <stdexcept>

#include "scale/run.hpp"
#include "scale/subscriber.hpp"

namespace rigid_body_sim::scale {
namespace {

struct Row {
  Load load;
  double most_cpu;   ///< that the node may take, of one core
  bool is_punctual;  ///< no tick may be a period late
};

/// The bodies' own topics of odometry at every tick are there to be compared with: 50,000 messages
/// a second, each a system call of its own in roscpp. All odometry is in `states` too.
std::vector<Row> rows(bool is_quick) {
  const double long_s = is_quick ? 10 : 60;
  return {{{100, {"tf", "states", "odom"}, 1, false, 10}, 0.15, true},
          {{1000, {"tf", "states"}, 1, false, 10}, 0.15, true},
          {{1000, {"tf", "states", "odom"}, 5, false, 10}, 0.15, true},
          {{1000, {"tf", "states", "odom"}, 1, false, 10}, 1, false},
          {{10000, {"tf", "states"}, 1, true, long_s}, 1, true}};
}

/// What of a row's targets is missed; empty if nothing is.
std::string missed(const Row& row, const Result& result) {
  std::string text;
  const auto want = [&](bool is_met, const std::string& what) {
    if (!is_met) text += (text.empty() ? "" : ", ") + what;
  };
  want(result.cpu <= row.most_cpu, "too much processor time");
  want(!row.is_punctual || result.overruns == 0, "overruns");
  want(result.messages >= 0.99 * result.expected, "messages are missing");
  want(std::abs(result.real_time_factor - 1) <= 0.02, "not real time");
  return text;
}

std::string join(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

std::string describe(const Load& load) {
  return join(load.topics) + (load.every > 1 ? " every " + std::to_string(load.every) : "");
}

void printHead() {
  std::printf(
      "| bodies | topics | node | start | messages/s | of wanted | real time | overruns | latest "
      "| memory | subscribers |\n| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- "
      "| --- |\n");
}

void print(const Load& load, const Result& result) {
  std::printf(
      "| %d | %s | %.1f %% | %.1f s | %.0f | %.1f %% | %.3f | %ld | %.1f ms | %ld MB | %.1f %% |\n",
      load.bodies, describe(load).c_str(), 100 * result.cpu, result.start_s, result.messages,
      100 * result.messages / result.expected, result.real_time_factor, result.overruns,
      result.latest_ms, result.resident_kB / 1000, 100 * result.subscribers_cpu);
  std::fflush(stdout);
}

std::vector<std::string> split(const std::string& text) {
  std::istringstream stream(text);
  std::vector<std::string> words;
  for (std::string word; std::getline(stream, word, ',');) words.push_back(word);
  return words;
}

/// BODIES TOPIC,TOPIC SECONDS [EVERY]
Load loadOf(char** words, int count) {
  Load load;
  load.bodies = std::stoi(words[0]);
  load.topics = split(words[1]);
  load.seconds = std::stod(words[2]);
  if (count > 3) load.every = std::stoi(words[3]);
  load.is_lean = load.bodies > 1000;
  return load;
}

}  // namespace
}  // namespace rigid_body_sim::scale

int main(int argc, char** argv) try {
  using namespace rigid_body_sim::scale;
  if (argc > 1 && std::string(argv[1]) == "--subscribe")
    return subscribe(std::vector<std::string>(argv + 2, argv + argc));
  const std::string self = argv[0];
  const std::string node = self.substr(0, self.rfind('/') + 1) + "rigid_body_sim_node";
  setenv("ROSCONSOLE_STDOUT_LINE_BUFFERED", "1", 1);  // the node's lines, as they come
  ros::init(argc, argv, "scale", ros::init_options::AnonymousName);
  const ros::NodeHandle nh;
  printHead();
  if (argc > 3) {
    const Load load = loadOf(argv + 1, argc - 1);
    print(load, measure(load, node, self));
    return 0;
  }
  int failures = 0;
  for (const Row& row : rows(argc > 1)) {
    const Result result = measure(row.load, node, self);
    print(row.load, result);
    const std::string why = missed(row, result);
    if (why.empty()) continue;
    std::printf("MISSED: %s\n", why.c_str());
    ++failures;
  }
  return failures == 0 ? 0 : 1;
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}

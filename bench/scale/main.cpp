// How many bodies the node carries; see scripts/scale.
#include <ros/ros.h>

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
  double most_cpu;  ///< that the node may take, of one core
};

/// Of bodies beyond some hundred, topics of their own cost more to register than to fill: a scene
/// of ten thousand leaves them out.
const char kAllTogether[] =
    "body_inputs: false\npublish_every: {twist: 0, odom: 0, applied_wrench: 0}\n";

std::vector<Row> rows(bool is_quick) {
  const double long_s = is_quick ? 10 : 60;
  return {{{100, {"tf", "states", "odom"}, "", 10}, 0.15},
          {{1000, {"tf", "states"}, "", 10}, 0.15},
          {{1000, {"tf", "states", "odom"}, "publish_every: {odom: 5}\n", 10}, 0.15},
          {{1000, {"tf", "states", "odom"}, "", 10}, 1},
          {{10000, {"tf", "states"}, kAllTogether, long_s}, 1}};
}

std::string join(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
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
      load.bodies, join(load.topics).c_str(), 100 * result.cpu, result.start_s, result.messages,
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

/// BODIES TOPIC,TOPIC SECONDS [YAML]
Load loadOf(char** words, int count) {
  Load load;
  load.bodies = std::stoi(words[0]);
  load.topics = split(words[1]);
  load.seconds = std::stod(words[2]);
  if (count > 3) load.node_parameters = std::string(words[3]) + "\n";
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
  for (const Row& row : rows(argc > 1)) print(row.load, measure(row.load, node, self));
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}

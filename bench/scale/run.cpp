#include "scale/run.hpp"

#include <diagnostic_msgs/DiagnosticArray.h>
#include <ros/callback_queue.h>
#include <ros/ros.h>

#include <algorithm>
#include <fstream>
#include <functional>
#include <map>
#include <memory>
#include <sstream>
#include <stdexcept>

#include "tools/child_process.hpp"
#include "../../test/xml_rpc_tree.hpp"

namespace rigid_body_sim::scale {
namespace {

const std::string kSpace = "/scale";
constexpr double kRate = 50;  // ticks a second

std::string nameOf(int body) { return "body_" + std::to_string(body); }

/// What the kernel tells of a process.
double processorTime(pid_t pid) {
  std::ifstream file("/proc/" + std::to_string(pid) + "/stat");
  std::string line;
  std::getline(file, line);
  std::istringstream fields(line.substr(line.rfind(')') + 1));
  std::string skipped;
  for (int i = 0; i < 11; ++i) fields >> skipped;  // state .. cmajflt
  double user = 0, system = 0;
  if (!(fields >> user >> system)) throw std::runtime_error("a process is no more");
  return (user + system) / static_cast<double>(sysconf(_SC_CLK_TCK));
}

long residentMemory(pid_t pid) {
  std::ifstream file("/proc/" + std::to_string(pid) + "/status");
  for (std::string line; std::getline(file, line);)
    if (line.rfind("VmRSS:", 0) == 0) return std::stol(line.substr(6));
  return 0;
}

/// The node's own account, from /diagnostics.
class Account {
 public:
  Account() : subscriber_(ros::NodeHandle().subscribe("/diagnostics", 100, &Account::take, this)) {}

  double value(const std::string& key) const {
    const auto found = values_.find(key);
    return found == values_.end() ? 0 : std::stod(found->second);
  }

  void waitForNext(double timeout_s) {
    const int before = count_;
    const ros::SteadyTime end = ros::SteadyTime::now() + ros::WallDuration(timeout_s);
    while (count_ == before && ros::SteadyTime::now() < end)
      ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(0.01));
    if (count_ == before) throw std::runtime_error("the node sends no diagnostics");
    latest_ms_ = std::max(latest_ms_, value("latest tick [ms]"));
  }

  void forgetLatest() { latest_ms_ = 0; }
  double latest() const { return latest_ms_; }

 private:
  void take(const diagnostic_msgs::DiagnosticArray::ConstPtr& array) {
    for (const diagnostic_msgs::DiagnosticStatus& one : array->status) {
      if (one.name.find(": simulation") == std::string::npos) continue;
      for (const diagnostic_msgs::KeyValue& value : one.values) values_[value.key] = value.value;
      ++count_;
    }
  }

  ros::Subscriber subscriber_;
  std::map<std::string, std::string> values_;
  int count_ = 0;
  double latest_ms_ = 0;
};

struct Subscriber : ChildProcess {
  using ChildProcess::ChildProcess;

  /// How many messages it has received.
  double received() {
    signal(SIGUSR1);
    ++asked_;
    const std::function<std::size_t()> answers = [this] {
      std::size_t count = 0;
      for (std::size_t at = 0; (at = said().find("received ", at)) != std::string::npos; ++at)
        if (said().find('\n', at) != std::string::npos) ++count;
      return count;
    };
    while (answers() < asked_)
      if (!saysMore()) throw std::runtime_error("a subscriber does not answer");
    return std::stod(said().substr(said().rfind("received ") + 9));
  }

 private:
  std::size_t asked_ = 0;
};

bool isOfAll(const std::string& topic) { return topic == "tf" || topic == "states"; }

/// One process for each topic of all bodies, and one for those of single ones of each kind.
std::vector<std::vector<std::string>> topicsOfSubscribers(const Load& load) {
  std::vector<std::vector<std::string>> all;
  for (const std::string& topic : load.topics) {
    if (isOfAll(topic)) {
      all.push_back({topic == "tf" ? "/tf" : kSpace + "/" + topic});
      continue;
    }
    all.emplace_back();
    for (int i = 0; i < load.bodies; ++i)
      all.back().push_back(kSpace + "/" + nameOf(i) + "/" + topic);
  }
  return all;
}

double messagesATick(const Load& load) {
  double sum = 0;
  for (const std::string& topic : load.topics)
    sum += isOfAll(topic) ? 1 : static_cast<double>(load.bodies) / load.every;
  return sum;
}

std::string nodeParameters(const Load& load) {
  std::string every;
  for (const std::string topic : {"twist", "odom", "applied_wrench"}) {
    const auto& wanted = load.topics;
    const bool is_wanted = std::find(wanted.begin(), wanted.end(), topic) != wanted.end();
    const int ticks = is_wanted ? load.every : load.is_lean ? 0 : 1;
    every += (every.empty() ? "" : ", ") + topic + ": " + std::to_string(ticks);
  }
  return "publish_every: {" + every + "}\nbody_inputs: " + (load.is_lean ? "false" : "true") + "\n";
}

}  // namespace

std::string sceneText(const Load& load) {
  std::ostringstream text;
  text << "step_s: " << 1 / kRate << "\n"
       << nodeParameters(load) << "effects: {gravity: {acceleration: [0, 0, -1.0]}}\nbodies:\n";
  for (int i = 0; i < load.bodies; ++i) {
    const double u = (i % 97) / 97.0, v = (i % 89) / 89.0;
    text << "  " << nameOf(i) << ": {mass: " << 1 + u << ", inertia: [" << 0.1 + 0.01 * u << ", "
         << 0.2 + 0.02 * v << ", 0.25], com: [0.01, 0, " << 0.01 * v << "], position: ["
         << 2.0 * (i % 100) << ", " << 2.0 * (i / 100) << ", 0.0], angular_velocity: [" << 0.1 + v
         << ", " << 2 + u << ", 0.1]}\n";
  }
  return text.str();
}

namespace {

using Subscribers = std::vector<std::unique_ptr<Subscriber>>;

/// Starts them and waits until each has got something on each of its topics.
Subscribers subscribersTo(const Load& load, const std::string& self) {
  Subscribers subscribers;
  for (const std::vector<std::string>& topics : topicsOfSubscribers(load)) {
    std::vector<std::string> command = {self, "--subscribe"};
    command.insert(command.end(), topics.begin(), topics.end());
    subscribers.push_back(std::make_unique<Subscriber>(command));
  }
  for (const auto& subscriber : subscribers)
    if (!subscriber->says("ready\n", 120))
      throw std::runtime_error("a subscriber got nothing of some topic: " + subscriber->said());
  return subscribers;
}

/// Counters that only grow.
struct Counters {
  ros::SteadyTime time = ros::SteadyTime::now();
  double node_s, subscribers_s = 0, messages = 0, ticks, overruns;

  Counters(const ChildProcess& node, const Subscribers& subscribers, const Account& account)
      : node_s(processorTime(node.pid())),
        ticks(account.value("tick")),
        overruns(account.value("overruns")) {
    for (const auto& subscriber : subscribers) {
      messages += subscriber->received();
      subscribers_s += processorTime(subscriber->pid());
    }
  }
};

}  // namespace

Result measure(const Load& load, const std::string& node_path, const std::string& self) {
  const std::string node_name = kSpace + "/sim";
  ros::param::set(node_name, toXmlRpc(readYaml(sceneText(load), "scene")));
  Account account;
  ChildProcess node({node_path, "__ns:=" + kSpace, "__name:=sim"});
  Result result;
  if (!node.says("step 0.02 s", 120)) throw std::runtime_error("the node says: " + node.said());
  result.start_s = node.secondsSinceStart();
  const Subscribers subscribers = subscribersTo(load, self);

  account.waitForNext(5);
  account.waitForNext(5);
  account.forgetLatest();
  const Counters before(node, subscribers, account);
  while ((ros::SteadyTime::now() - before.time).toSec() < load.seconds) account.waitForNext(5);
  const Counters after(node, subscribers, account);

  const double wall_s = (after.time - before.time).toSec();
  result.cpu = (after.node_s - before.node_s) / wall_s;
  result.subscribers_cpu = (after.subscribers_s - before.subscribers_s) / wall_s;
  result.messages = (after.messages - before.messages) / wall_s;
  result.expected = kRate * messagesATick(load);
  result.real_time_factor = (after.ticks - before.ticks) / kRate / wall_s;
  result.overruns = static_cast<long>(after.overruns - before.overruns);
  result.latest_ms = account.latest();
  result.resident_kB = residentMemory(node.pid());

  node.signal(SIGINT);
  if (node.exitCode(60) != 0) throw std::runtime_error("the node does not end well");
  ros::param::del(kSpace);
  return result;
}

}  // namespace rigid_body_sim::scale

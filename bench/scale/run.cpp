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

#include "../../test/child_process.hpp"
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

/// One for each topic of all bodies, one for each hundred topics of single ones.
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
  for (const std::string& topic : load.topics) sum += isOfAll(topic) ? 1 : load.bodies;
  return sum;
}

}  // namespace

std::string sceneText(const Load& load) {
  std::ostringstream text;
  text << "step_s: " << 1 / kRate << "\n"
       << load.node_parameters << "effects:\n  gravity: {acceleration: [0, 0, -1.0]}\nbodies:\n";
  for (int i = 0; i < load.bodies; ++i) {
    const double u = (i % 97) / 97.0, v = (i % 89) / 89.0;
    text << "  " << nameOf(i) << ": {mass: " << 1 + u << ", inertia: [" << 0.1 + 0.01 * u << ", "
         << 0.2 + 0.02 * v << ", 0.25], com: [0.01, 0, " << 0.01 * v << "], position: ["
         << 2.0 * (i % 100) << ", " << 2.0 * (i / 100) << ", 0.0], angular_velocity: [" << 0.1 + v
         << ", " << 2 + u << ", 0.1]}\n";
  }
  return text.str();
}

Result measure(const Load& load, const std::string& node_path, const std::string& self) {
  const std::string node_name = kSpace + "/sim";
  ros::param::set(node_name, toXmlRpc(readYaml(sceneText(load), "scene")));
  Account account;
  ChildProcess node({node_path, "__ns:=" + kSpace, "__name:=sim"});
  Result result;
  if (!node.says("step 0.02 s", 120)) throw std::runtime_error("the node says: " + node.said());
  result.start_s = node.secondsSinceStart();

  std::vector<std::unique_ptr<Subscriber>> subscribers;
  for (const std::vector<std::string>& topics : topicsOfSubscribers(load)) {
    std::vector<std::string> command = {self, "--subscribe"};
    command.insert(command.end(), topics.begin(), topics.end());
    subscribers.push_back(std::make_unique<Subscriber>(command));
  }
  for (const auto& subscriber : subscribers)
    if (!subscriber->says("ready\n", 120))
      throw std::runtime_error("a subscriber got nothing of some topic: " + subscriber->said());

  account.waitForNext(5);
  account.waitForNext(5);
  account.forgetLatest();
  const auto all = [&](const auto& of) {
    double sum = 0;
    for (const auto& subscriber : subscribers) sum += of(*subscriber);
    return sum;
  };
  const auto received = [](Subscriber& one) { return one.received(); };
  const auto time = [](const Subscriber& one) { return processorTime(one.pid()); };
  const double overruns = account.value("overruns"), tick = account.value("tick");
  const double messages = all(received), others_s = all(time), cpu_s = processorTime(node.pid());
  const ros::SteadyTime start = ros::SteadyTime::now();
  while ((ros::SteadyTime::now() - start).toSec() < load.seconds) account.waitForNext(5);
  const double wall_s = (ros::SteadyTime::now() - start).toSec();
  result.cpu = (processorTime(node.pid()) - cpu_s) / wall_s;
  result.subscribers_cpu = (all(time) - others_s) / wall_s;
  result.messages = (all(received) - messages) / (ros::SteadyTime::now() - start).toSec();
  result.expected = kRate * messagesATick(load);
  result.real_time_factor = (account.value("tick") - tick) / kRate / wall_s;
  result.overruns = static_cast<long>(account.value("overruns") - overruns);
  result.latest_ms = account.latest();
  result.resident_kB = residentMemory(node.pid());

  node.signal(SIGINT);
  if (node.exitCode(30) != 0) throw std::runtime_error("the node does not end well");
  ros::param::del(kSpace);
  return result;
}

}  // namespace rigid_body_sim::scale

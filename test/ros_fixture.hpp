#pragma once

// What rostests need to talk to a node under test. Nothing here sleeps: everything waits for a
// condition, with a deadline.

#include <XmlRpc.h>
#include <diagnostic_msgs/DiagnosticArray.h>
#include <gtest/gtest.h>
#include <rigid_body_sim/BodyStates.h>
#include <rigid_body_sim/Step.h>
#include <ros/callback_queue.h>
#include <ros/master.h>
#include <ros/network.h>
#include <ros/ros.h>
#include <std_srvs/SetBool.h>
#include <std_srvs/Trigger.h>

#include <cstring>
#include <functional>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

namespace rigid_body_sim {

/// Runs callbacks until `is_true` or for `timeout_s` of wall time; returns `is_true`.
inline bool waitFor(const std::function<bool()>& is_true, double timeout_s = 10) {
  const ros::SteadyTime end = ros::SteadyTime::now() + ros::WallDuration(timeout_s);
  while (!is_true()) {
    if (!ros::ok() || ros::SteadyTime::now() > end) return false;
    ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(0.001));
  }
  return true;
}

/// As waitFor, for what a test cannot go on without.
inline void need(const std::string& what, const std::function<bool()>& is_true,
                 double timeout_s = 10) {
  if (!waitFor(is_true, timeout_s)) throw std::runtime_error("waited in vain for " + what);
}

inline bool sameBits(const BodyStates& a, const BodyStates& b) {
  return a.names == b.names && a.poses.size() == b.poses.size() &&
         a.twists.size() == b.twists.size() &&
         std::memcmp(a.poses.data(), b.poses.data(), a.poses.size() * sizeof(a.poses[0])) == 0 &&
         std::memcmp(a.twists.data(), b.twists.data(), a.twists.size() * sizeof(a.twists[0])) == 0;
}

/// The status of the simulation in /diagnostics.
struct Status {
  int level = -1;
  std::string message;
  std::map<std::string, std::string> values;

  std::uint64_t count(const std::string& key) const { return std::stoull(values.at(key)); }
};

/// The XML-RPC server that roscpp gives to every node: what it is connected to.
class NodeApi {
 public:
  explicit NodeApi(const std::string& node) : node_(node) {
    XmlRpc::XmlRpcValue request, response, uri;
    request[0] = ros::this_node::getName();
    request[1] = node_;
    need("node " + node,
         [&] { return ros::master::execute("lookupNode", request, response, uri, false); });
    ros::network::splitURI(uri, host_, port_);
  }

  /// Messages that the node has taken off its connection to the one publisher of `topic`; roscpp
  /// tells of one. They are in its callback queue by the time that it looks at a service call made
  /// after this; without asking, a call may overtake a message, as they come by two connections.
  int received(const std::string& topic) { return messages(1, topic, 2); }

  /// Messages that the node has handed to the network for its one subscriber to `topic`.
  int sent(const std::string& topic) { return messages(0, topic, 3); }

  /// Whether it sends `topic` to the node `peer`.
  bool sends(const std::string& topic, const std::string& peer) {
    XmlRpc::XmlRpcValue all = ask("getBusInfo")[2];  // id, peer, direction, transport, topic, ...
    for (int i = 0; i < all.size(); ++i)
      if (all[i][2] == XmlRpc::XmlRpcValue("o") && all[i][4] == XmlRpc::XmlRpcValue(topic) &&
          all[i][1] == XmlRpc::XmlRpcValue(peer))
        return true;
    return false;
  }

  bool sendsHere(const std::string& topic) { return sends(topic, ros::this_node::getName()); }

  int pid() { return ask("getPid")[2]; }

 private:
  XmlRpc::XmlRpcValue ask(const char* method) {
    XmlRpc::XmlRpcClient client(host_.c_str(), static_cast<int>(port_), "/");
    XmlRpc::XmlRpcValue request, response;
    request[0] = ros::this_node::getName();
    if (!client.execute(method, request, response) || client.isFault())
      throw std::runtime_error(node_ + " does not answer");
    return response;
  }

  /// Published topics are list 0, subscribed ones list 1.
  int messages(int list, const std::string& topic, int column) {
    XmlRpc::XmlRpcValue statistics = ask("getBusStats");  // roscpp leaves out code and message here
    XmlRpc::XmlRpcValue& topics = statistics[list];
    for (int i = 0; i < topics.size(); ++i) {
      if (static_cast<std::string>(topics[i][0]) != topic) continue;
      XmlRpc::XmlRpcValue& links = topics[i][1];
      return links.size() == 0 ? 0 : static_cast<int>(links[0][column]);
    }
    return 0;
  }

  std::string node_;
  std::string host_;
  std::uint32_t port_ = 0;
};

/// A simulator node, as its users see it.
class Sim {
 public:
  explicit Sim(const std::string& node = "/rigid_body_sim")
      : node_(node),
        step_(service<Step>("step")),
        pause_(service<std_srvs::SetBool>("pause")),
        reset_(service<std_srvs::Trigger>("reset")),
        api(node) {}

  const std::string& node() const { return node_; }
  ros::NodeHandle& nodeHandle() { return nh_; }

  Step::Response tryStep(std::uint32_t ticks) {
    Step call;
    call.request.ticks = ticks;
    if (!step_.call(call)) throw std::runtime_error("~step failed");
    return call.response;
  }

  /// Simulates `ticks` ticks; the states after the last.
  BodyStates step(std::uint32_t ticks = 1) {
    const Step::Response response = tryStep(ticks);
    EXPECT_TRUE(response.success) << response.message;
    EXPECT_EQ(response.message, "");
    return response.states;
  }

  void pause(bool paused = true) {
    std_srvs::SetBool call;
    call.request.data = paused;
    if (!pause_.call(call) || !call.response.success) throw std::runtime_error("~pause failed");
  }
  void unpause() { pause(false); }

  void reset() {
    std_srvs::Trigger call;
    if (!reset_.call(call) || !call.response.success) throw std::runtime_error("~reset failed");
  }

  /// Waits for a status that fulfils `wanted`; the latest one if none does.
  Status diagnostics(const std::function<bool(const Status&)>& wanted, double timeout_s = 5) {
    Status status;
    bool is_found = false;
    const auto take = [&](const diagnostic_msgs::DiagnosticArray::ConstPtr& array) {
      if (!is_found && read(*array, status)) is_found = wanted(status);
    };
    const ros::Subscriber subscriber =
        nh_.subscribe<diagnostic_msgs::DiagnosticArray>("/diagnostics", 100, take);
    EXPECT_TRUE(waitFor([&] { return is_found; }, timeout_s)) << "last seen: " << status.message;
    return status;
  }
  Status diagnostics() {
    return diagnostics([](const Status&) { return true; });
  }

 private:
  template <class Service>
  ros::ServiceClient service(const std::string& name) {
    if (!ros::service::waitForService(node_ + "/" + name, 10'000))
      throw std::runtime_error("no service " + node_ + "/" + name);
    return nh_.serviceClient<Service>(node_ + "/" + name, true);
  }

  bool read(const diagnostic_msgs::DiagnosticArray& array, Status& status) const {
    for (const diagnostic_msgs::DiagnosticStatus& one : array.status) {
      if (one.name != node_.substr(1) + ": simulation") continue;
      status = {one.level, one.message, {}};
      for (const diagnostic_msgs::KeyValue& value : one.values)
        status.values[value.key] = value.value;
      return true;
    }
    return false;
  }

  std::string node_;
  ros::NodeHandle nh_;
  ros::ServiceClient step_, pause_, reset_;

 public:
  NodeApi api;
};

/// A publisher to the node. After send() the node has the message.
template <class Message>
class Input {
 public:
  Input(Sim& sim, const std::string& topic)
      : sim_(sim), publisher_(sim.nodeHandle().advertise<Message>(topic, 20'000)) {}

  void send(const Message& message) { send(std::vector<Message>{message}); }

  void send(const std::vector<Message>& messages) {
    need("a connection to " + publisher_.getTopic(),
         [&] { return publisher_.getNumSubscribers() > 0; });
    const int before = sim_.api.received(publisher_.getTopic());
    for (const Message& message : messages) publisher_.publish(message);
    need("the node to receive " + publisher_.getTopic(), [&] {
      return sim_.api.received(publisher_.getTopic()) >= before + static_cast<int>(messages.size());
    });
  }

  const ros::Publisher& publisher() const { return publisher_; }

 private:
  Sim& sim_;
  ros::Publisher publisher_;
};

/// Everything that the node sends on a topic from now on; begins with the latched message, if any.
template <class Message>
class Recording {
 public:
  Recording(Sim& sim, const std::string& topic)
      : sim_(sim), topic_(topic), is_shared_(sim.api.sendsHere(topic)) {
    // Named with its type: of a bare lambda roscpp would make a callback that knows no publisher.
    const boost::function<void(const ros::MessageEvent<const Message>&)> take =
        [this](const ros::MessageEvent<const Message>& event) {
          if (event.getPublisherName() != sim_.node()) return;
          messages.push_back(*event.getMessage());
          if (on_message) on_message();
        };
    subscriber_ = sim.nodeHandle().subscribe<Message>(topic, 20'000, take);
    need("a connection to " + topic, [&] { return sim.api.sendsHere(topic); });
  }
  Recording(const Recording&) = delete;
  Recording& operator=(const Recording&) = delete;

  /// Waits until the node has noticed, lest the next recording of the topic takes this one's
  /// connection for its own.
  ~Recording() {
    subscriber_.shutdown();
    if (!is_shared_) waitFor([&] { return !sim_.api.sendsHere(topic_); });
  }

  /// Waits until there are `count` messages.
  void expect(std::size_t count) {
    need(std::to_string(count) + " messages on " + topic_,
         [&] { return messages.size() >= count; });
  }

  std::vector<Message> messages;
  std::function<void()> on_message;

 private:
  Sim& sim_;
  std::string topic_;
  bool is_shared_;  // with another subscriber in this process
  ros::Subscriber subscriber_;
};

/// A test of the node /rigid_body_sim, paused and in its initial state.
class NodeTest : public testing::Test {
 protected:
  void SetUp() override {
    // roscpp listens to /clock by itself; a recording of it shares that connection.
    need("/clock", [this] { return sim.api.sendsHere("/clock"); });
    sim.pause();
    sim.reset();
  }

  Sim sim;
};

/// Body of main().
inline int runRostest(int argc, char** argv, const std::string& name) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, name);
  const ros::NodeHandle nh;  // keeps ROS up between the tests
  return RUN_ALL_TESTS();
}

}  // namespace rigid_body_sim

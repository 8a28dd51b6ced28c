#include "node/master_watch.hpp"

#include <XmlRpc.h>
#include <ros/connection_manager.h>
#include <ros/master.h>
#include <ros/network.h>
#include <ros/xmlrpc_manager.h>

#include <chrono>
#include <set>

namespace rigid_body_sim {
namespace {

constexpr std::chrono::seconds kPeriod(1);

/// One question to the master; false if it does not answer.
bool ask(const std::string& method, const std::vector<std::string>& arguments,
         XmlRpc::XmlRpcValue& payload) {
  XmlRpc::XmlRpcValue request;
  request[0] = ros::this_node::getName();
  for (std::size_t i = 0; i < arguments.size(); ++i)
    request[static_cast<int>(i) + 1] = arguments[i];
  XmlRpc::XmlRpcValue response;
  const bool wait_for_master = false;
  return ros::master::execute(method, request, response, payload, wait_for_master);
}

/// The master's own name for this run of it; empty if it does not answer.
std::string masterRun() {
  XmlRpc::XmlRpcValue run_id;
  if (!ask("getParam", {"/run_id"}, run_id)) return {};
  return run_id.getType() == XmlRpc::XmlRpcValue::TypeString ? static_cast<std::string>(run_id)
                                                             : "";
}

/// One question to the node's own slave API: roscpp keeps its lists private, but answers to
/// anybody. An empty list if there is no answer.
XmlRpc::XmlRpcValue askSelf(const char* method, XmlRpc::XmlRpcValue request = {}) {
  std::string host;
  std::uint32_t port = 0;
  ros::network::splitURI(ros::XMLRPCManager::instance()->getServerURI(), host, port);
  XmlRpc::XmlRpcClient client(host.c_str(), static_cast<int>(port), "/");
  request[0] = ros::this_node::getName();
  XmlRpc::XmlRpcValue response;  // code, message, list
  XmlRpc::XmlRpcValue none;
  none.setSize(0);
  if (!client.execute(method, request, response) || response.size() != 3) return none;
  return response[2];
}

/// Connects to publishers that the new master knew before this node, as it will not tell of them
/// again. Those that are connected stay so, whether it knows them or not.
void connect(const std::string& topic, XmlRpc::XmlRpcValue& publishers) {
  std::set<std::string> uris;
  for (int i = 0; i < publishers.size(); ++i) uris.insert(publishers[i]);
  XmlRpc::XmlRpcValue links = askSelf("getBusInfo");  // id, peer, direction, transport, topic, ...
  for (int i = 0; i < links.size(); ++i) {
    const bool is_input = static_cast<std::string>(links[i][2]) == "i";
    if (is_input && static_cast<std::string>(links[i][4]) == topic) uris.insert(links[i][1]);
  }
  if (uris.empty()) return;
  XmlRpc::XmlRpcValue request;
  request[1] = topic;
  int count = 0;
  for (const std::string& uri : uris) request[2][count++] = uri;
  askSelf("publisherUpdate", request);
}

}  // namespace

MasterWatch::MasterWatch(std::vector<std::string> services)
    : services_(std::move(services)), thread_([this] { run(); }) {}

MasterWatch::~MasterWatch() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stopping_ = true;
  }
  stop_.notify_all();
  thread_.join();
}

void MasterWatch::run() {
  std::string known_run = masterRun();  // empty if it died meanwhile; another will come then
  std::unique_lock<std::mutex> lock(mutex_);
  while (!stop_.wait_for(lock, kPeriod, [this] { return stopping_; })) {
    lock.unlock();
    const std::string run = masterRun();
    if (!run.empty() && run != known_run) {
      ROS_WARN("the master was restarted: registering again");
      registerAll();
      known_run = run;
    }
    lock.lock();
  }
}

void MasterWatch::registerAll() {
  const std::string uri = ros::XMLRPCManager::instance()->getServerURI();
  XmlRpc::XmlRpcValue ignored;
  XmlRpc::XmlRpcValue topics = askSelf("getPublications");  // topic, type
  for (int i = 0; i < topics.size(); ++i)
    ask("registerPublisher", {topics[i][0], topics[i][1], uri}, ignored);

  XmlRpc::XmlRpcValue subscriptions = askSelf("getSubscriptions");
  for (int i = 0; i < subscriptions.size(); ++i) {
    XmlRpc::XmlRpcValue publishers;
    if (ask("registerSubscriber", {subscriptions[i][0], subscriptions[i][1], uri}, publishers))
      connect(subscriptions[i][0], publishers);
  }

  const std::string service_uri = "rosrpc://" + ros::network::getHost() + ":" +
                                  std::to_string(ros::ConnectionManager::instance()->getTCPPort());
  for (const std::string& service : services_)
    ask("registerService", {service, service_uri, uri}, ignored);
}

}  // namespace rigid_body_sim

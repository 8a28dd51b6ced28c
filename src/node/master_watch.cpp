#include "node/master_watch.hpp"

#include <XmlRpc.h>
#include <ros/connection_manager.h>
#include <ros/master.h>
#include <ros/network.h>
#include <ros/xmlrpc_manager.h>

#include <chrono>

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

/// Pairs of topic and type from the node's own slave API: `getPublications` or `getSubscriptions`.
/// roscpp keeps the lists private, but answers this question to anybody.
XmlRpc::XmlRpcValue ownTopics(const char* method, const std::string& uri) {
  std::string host;
  std::uint32_t port = 0;
  ros::network::splitURI(uri, host, port);
  XmlRpc::XmlRpcClient client(host.c_str(), static_cast<int>(port), "/");
  XmlRpc::XmlRpcValue request;
  request[0] = ros::this_node::getName();
  XmlRpc::XmlRpcValue response;  // code, message, list
  XmlRpc::XmlRpcValue none;
  none.setSize(0);
  if (!client.execute(method, request, response) || response.size() != 3) return none;
  return response[2];
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
  std::string known_run;
  std::unique_lock<std::mutex> lock(mutex_);
  while (!stop_.wait_for(lock, kPeriod, [this] { return stopping_; })) {
    lock.unlock();
    const std::string run = masterRun();
    if (!known_run.empty() && !run.empty() && run != known_run) {
      ROS_WARN("the master was restarted: registering again");
      registerAll();
    }
    if (!run.empty()) known_run = run;
    lock.lock();
  }
}

void MasterWatch::registerAll() {
  const std::string uri = ros::XMLRPCManager::instance()->getServerURI();
  XmlRpc::XmlRpcValue ignored;
  XmlRpc::XmlRpcValue topics = ownTopics("getPublications", uri);
  for (int i = 0; i < topics.size(); ++i)
    ask("registerPublisher", {topics[i][0], topics[i][1], uri}, ignored);

  XmlRpc::XmlRpcValue subscriptions = ownTopics("getSubscriptions", uri);
  for (int i = 0; i < subscriptions.size(); ++i)
    ask("registerSubscriber", {subscriptions[i][0], subscriptions[i][1], uri}, ignored);

  const std::string service_uri = "rosrpc://" + ros::network::getHost() + ":" +
                                  std::to_string(ros::ConnectionManager::instance()->getTCPPort());
  for (const std::string& service : services_)
    ask("registerService", {service, service_uri, uri}, ignored);
}

}  // namespace rigid_body_sim

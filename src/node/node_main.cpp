#include <ros/callback_queue.h>
#include <ros/ros.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "node/conversions.hpp"
#include "node/dropped_blocks.hpp"
#include "node/master_watch.hpp"
#include "node/names.hpp"
#include "node/options.hpp"
#include "node/sim_node.hpp"

namespace rigid_body_sim {
namespace {

/// Waits until there is a master, saying so every five seconds. False if ROS was shut down first.
bool waitForMaster() {
  ros::WallTime told;
  while (!ros::master::check()) {
    if (ros::isShuttingDown()) return false;
    if ((ros::WallTime::now() - told).toSec() >= 5) {
      ROS_WARN("no master at %s yet", ros::master::getURI().c_str());
      told = ros::WallTime::now();
    }
    ros::WallDuration(0.2).sleep();
  }
  return true;
}

Value privateParameters(const ros::NodeHandle& private_nh) {
  XmlRpc::XmlRpcValue all;
  if (!private_nh.getParam("", all)) return Value{Value::Map()};
  return toValue(all);
}

/// If the parameters came from a file.
void requireWholeScene(const Parameters& parameters, const Value& given) {
  if (!parameters.has("scene_file")) return;
  const std::string name = parameters.text("scene_file");
  std::ifstream file(name);
  if (!file)
    throw std::invalid_argument("scene_file: '" + name + "' cannot be read, seen from the folder " +
                                std::filesystem::current_path().string() +
                                "; roslaunch needs the absolute path, as scene:=$PWD/scene.yaml");
  const std::string text{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  refuseDroppedBlocks(readYaml(text, name), given, name);
}

std::string urdfParameter(const ros::NodeHandle& nh, const std::string& name) {
  std::string text;
  std::string resolved;
  if (!nh.searchParam(name, resolved) || !nh.getParam(resolved, text))
    throw std::invalid_argument("urdf_parameter: there is no string parameter '" + name + "'");
  return text;
}

/// Bodies become topics, and all frames share one tree with the world's.
void requireGoodNames(const Scene& scene, const std::string& world_frame) {
  for (const SceneBody& body : scene.bodies) {
    std::string why;
    if (!ros::names::validate(body.name, why))
      throw std::invalid_argument("body '" + body.name + "' cannot be a topic: " + why);
    bool is_taken = world_frame == body.name || world_frame == comFrameName(body.name);
    for (const FixedFrame& frame : body.frames) is_taken = is_taken || world_frame == frame.name;
    if (is_taken)
      throw std::invalid_argument("world_frame: '" + world_frame + "' is a frame of the body '" +
                                  body.name + "'");
  }
}

std::int64_t wallTime() {
  using namespace std::chrono;
  return duration_cast<nanoseconds>(system_clock::now().time_since_epoch()).count();
}

/// Not thousands of lines; who made so many knows them.
void tellBodies(const Scene& scene) {
  constexpr std::size_t kMost = 20;
  const std::size_t count = scene.bodies.size();
  for (std::size_t i = 0; i < std::min(count, kMost); ++i)
    ROS_INFO("%s", summary(scene.bodies[i]).c_str());
  if (count > kMost) ROS_INFO("and %zu more bodies", count - kMost);
}

/// The master takes one registration after the other, about a millisecond each.
void tellTopics(const Scene& scene, const NodeOptions& options) {
  constexpr std::size_t kMany = 5000;
  const PublishEvery& every = options.publish_every;
  std::size_t topics = options.body_inputs ? 2 : 0;
  for (const int ticks : {every.twist, every.odom, every.applied_wrench}) topics += ticks > 0;
  topics *= scene.bodies.size();
  if (topics > kMany)
    ROS_WARN(
        "%zu topics of single bodies have to be registered, which takes a while; `body_inputs: "
        "false` and 0 in `publish_every` leave them out: states, wrenches and impulses are of all "
        "bodies",
        topics);
}

void simulate(ros::NodeHandle& nh, ros::NodeHandle& private_nh, ros::CallbackQueue& queue) {
  const Value given = privateParameters(private_nh);
  const Parameters parameters(given, "");
  requireWholeScene(parameters, given);
  const bool use_sim_time = ros::param::param("/use_sim_time", false);
  const NodeOptions options = readNodeOptions(parameters, use_sim_time, wallTime());
  Scene scene = readScene(parameters, {options.scene_folder,
                                       [&](const auto& name) { return urdfParameter(nh, name); }});
  parameters.refuseUnknown();
  requireGoodNames(scene, options.world_frame);
  tellBodies(scene);
  tellTopics(scene, options);
  if (!options.publish_clock && options.real_time_factor != 1)
    ROS_WARN(
        "real_time_factor is not 1 and there is no /clock: the stamps of other nodes and this "
        "simulation's time part; set /use_sim_time");

  if (scene.accuracy)
    ROS_INFO("choosing what keeps %s, by flying it", summary(*scene.accuracy).c_str());
  SimNode node(nh, private_nh, queue, std::move(scene), options);
  for (const std::string& warning : node.scene().warnings) ROS_WARN("%s", warning.c_str());
  ROS_INFO("%s", summary(node.scene()).c_str());
  for (const std::string& elision : elisions(node.scene()))
    ROS_INFO("not computed, as it would change nothing: %s", elision.c_str());
  std::vector<std::string> services;
  for (const char* name : {names::kPause, names::kStep, names::kReset, names::kSwitchEffect,
                           "get_loggers", "set_logger_level"})
    services.push_back(private_nh.resolveName(name));  // the last two are roscpp's own
  const MasterWatch watch(services);
  node.run();
}

}  // namespace
}  // namespace rigid_body_sim

volatile std::sig_atomic_t is_interrupted = 0;

/// ROS looks at requests to end only once it has started, which is after the wait for a master.
void interrupt(int) {
  is_interrupted = 1;
  if (!ros::isStarted()) std::_Exit(0);
  ros::requestShutdown();
}

int main(int argc, char** argv) {
  std::signal(SIGINT, interrupt);
  ros::init(argc, argv, "rigid_body_sim", ros::init_options::NoSigintHandler);
  if (!rigid_body_sim::waitForMaster()) return 0;
  ros::CallbackQueue queue;
  ros::NodeHandle nh;
  ros::NodeHandle private_nh("~");
  nh.setCallbackQueue(&queue);
  private_nh.setCallbackQueue(&queue);
  try {
    rigid_body_sim::simulate(nh, private_nh, queue);
  } catch (const std::invalid_argument& error) {
    // Ended while it started: a signal cuts a question for parameters short, nobody's mistake.
    if (is_interrupted || ros::isShuttingDown()) return 0;
    ROS_FATAL("%s", error.what());
    return 1;
  }
  return 0;
}

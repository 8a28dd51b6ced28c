#include "node/inputs.hpp"

#include "node/names.hpp"

namespace rigid_body_sim {
namespace {

// At 50 Hz of spinning a queue of 1 loses 95 % of a 1 kHz stream, 10 half of it; 1000 loses nothing
// at 10 kHz.
constexpr std::uint32_t kQueueSize = 1000;

// Whether a message has entries.
constexpr bool kList = true;
constexpr bool kSingle = false;

constexpr double kQuiet_s = 1;  // between two warnings of one kind

bool isTimeAgain(ros::SteadyTime& last) {
  const ros::SteadyTime now = ros::SteadyTime::now();
  if (!last.isZero() && (now - last).toSec() < kQuiet_s) return false;
  last = now;
  return true;
}

template <class Message>
ros::Subscriber subscribe(
    ros::NodeHandle& nh, const std::string& topic,
    const boost::function<void(const ros::MessageEvent<const Message>&)>& take) {
  return nh.subscribe<Message>(topic, kQueueSize, take, ros::VoidConstPtr(),
                               ros::TransportHints().tcpNoDelay());
}

template <class Message>
std::string sourceOf(const std::string& topic, const ros::MessageEvent<const Message>& event) {
  return topic + " from " + event.getPublisherName();
}

}  // namespace

Inputs::Inputs(ros::NodeHandle& nh, Simulator& simulator, const SimTime& time,
               const NodeOptions& options)
    : simulator_(simulator), rules_(simulator, time, options) {
  for (std::size_t i = 0; options.body_inputs && i < simulator.scene().bodies.size(); ++i)
    subscribeBody(nh, static_cast<Eigen::Index>(i));

  subscribers_.push_back(subscribe<BodyWrenches>(nh, names::kWrenches, [this](const auto& event) {
    const auto message = event.getMessage();
    const std::string source = sourceOf(names::kWrenches, event);
    ++sequence_;
    for (std::size_t i = 0; i < message->wrenches.size(); ++i)
      take(source, i, kList, [&] { return rules_.scheduled(message->wrenches[i]); });
  }));
  subscribers_.push_back(subscribe<BodyImpulses>(nh, names::kImpulses, [this](const auto& event) {
    const auto message = event.getMessage();
    const std::string source = sourceOf(names::kImpulses, event);
    ++sequence_;
    for (std::size_t i = 0; i < message->impulses.size(); ++i)
      take(source, i, kList, [&] { return rules_.impulse(message->impulses[i]); });
  }));
}

void Inputs::subscribeBody(ros::NodeHandle& nh, Eigen::Index body) {
  const std::string& name = simulator_.scene().bodies[body].name;
  const std::string wrench_topic = name + "/" + names::kWrench;
  const std::string impulse_topic = name + "/" + names::kImpulse;
  subscribers_.push_back(subscribe<geometry_msgs::WrenchStamped>(
      nh, wrench_topic, [this, body, wrench_topic](const auto& event) {
        ++sequence_;
        take(sourceOf(wrench_topic, event), 0, kSingle,
             [&] { return rules_.held(body, *event.getMessage()); });
      }));
  subscribers_.push_back(
      subscribe<ImpulseStamped>(nh, impulse_topic, [this, body, impulse_topic](const auto& event) {
        ++sequence_;
        take(sourceOf(impulse_topic, event), 0, kSingle,
             [&] { return rules_.impulse(body, *event.getMessage()); });
      }));
}

template <class Convert>
void Inputs::take(const std::string& source, std::uint64_t entry, bool is_list, Convert convert) {
  try {
    auto input = convert();
    input.origin = {source, sequence_, entry};
    simulator_.apply(std::move(input));
    ++counts_.accepted;
  } catch (const RefusedInput& refused) {
    refuse(refused, (is_list ? "entry " + std::to_string(entry) + " of " : "") + source);
  }
}

void Inputs::refuse(const RefusedInput& refused, const std::string& source) {
  const auto reason = static_cast<std::size_t>(refused.refusal);
  ++counts_.refused[reason];
  if (isTimeAgain(warned_[reason])) {
    ROS_WARN("refused %s: %s (%lu so far for this reason)", source.c_str(), refused.what(),
             static_cast<unsigned long>(counts_.refused[reason]));
  }
}

void Inputs::reportExpired() {
  for (const WrenchInput& ended : simulator_.endedWrenches()) {
    if (!ended.replaces) continue;  // its own duration is over, as asked for
    ++counts_.expired;
    if (isTimeAgain(told_expiry_)) {
      ROS_INFO("wrench on %s ended after wrench_timeout_s (%s)",
               simulator_.scene().bodies[ended.body].name.c_str(), ended.origin.source.c_str());
    }
  }
}

}  // namespace rigid_body_sim

#include "node/outputs.hpp"

#include <std_msgs/String.h>

#include "node/conversions.hpp"
#include "node/names.hpp"

namespace rigid_body_sim {
namespace {

constexpr std::uint32_t kQueueSize = 100;  // two seconds at 50 Hz

rosgraph_msgs::Clock toClock(const ros::Time& stamp) {
  rosgraph_msgs::Clock clock;
  clock.clock = stamp;
  return clock;
}

/// Whether anything was sent to the subscriber, by roscpp's own count. One that came while a tick
/// waited to be sent has got it with all others; one that came later has not.
bool hasGotSomething(const ros::SingleSubscriberPublisher& subscriber) {
  const auto publication = ros::TopicManager::instance()->lookupPublication(subscriber.getTopic());
  if (!publication) return true;
  XmlRpc::XmlRpcValue links, counts = publication->getStats()[1];  // id, bytes, data, messages, 0
  links.setSize(0);
  publication->getInfo(links);  // id, subscriber, ...
  for (int i = 0; i < links.size(); ++i) {
    if (static_cast<std::string>(links[i][1]) != subscriber.getSubscriberName()) continue;
    for (int k = 0; k < counts.size(); ++k)
      if (counts[k][0] == links[i][0] && static_cast<int>(counts[k][3]) == 0) return false;
  }
  return true;
}

}  // namespace

Outputs::Outputs(ros::NodeHandle nh, const Simulator& simulator, const SimTime& time,
                 const NodeOptions& options)
    : nh_(nh),
      simulator_(simulator),
      time_(time),
      options_(options),
      messages_(simulator, options.world_frame) {
  nh_.setCallbackQueue(&connections_);
  const PublishEvery& every = options.publish_every;
  clock_rate_.every = options.publish_clock ? 1 : 0;
  tf_rate_.every = every.tf;
  states_rate_.every = every.states;
  effect_wrenches_rate_.every = every.effect_wrenches;
  twists_.rate.every = every.twist;
  odoms_.rate.every = every.odom;
  applied_wrenches_.rate.every = every.applied_wrench;
  const std::string& world = options_.world_frame;
  if (clock_rate_.every > 0)
    clock_ = advertise<rosgraph_msgs::Clock>(names::kClock, [this] { return toClock(stamp()); });
  if (every.tf > 0)
    tf_ = advertise<tf2_msgs::TFMessage>(names::kTf,
                                         [&] { return toTf(simulator_, world, stamp()); });
  if (every.states > 0)
    states_ =
        advertise<BodyStates>(names::kStates, [&] { return toStates(simulator_, world, stamp()); });
  if (every.effect_wrenches > 0)
    effect_wrenches_ = advertise<EffectWrenches>(
        names::kEffectWrenches, [&] { return toEffectWrenches(simulator_, world, stamp()); });
  advertise<geometry_msgs::TwistStamped>(
      twists_, names::kTwist, [this](auto body) { return toTwist(simulator_, body, stamp()); });
  advertise<nav_msgs::Odometry>(odoms_, names::kOdom, [&](auto body) {
    return toOdometry(simulator_, body, world, stamp());
  });
  advertise<geometry_msgs::WrenchStamped>(applied_wrenches_, names::kAppliedWrench, [&](auto body) {
    return toAppliedWrench(simulator_, body, stamp());
  });
  advertiseLatched();
  static_broadcaster_.sendTransform(toStaticTf(simulator, options.publish_link_frames, stamp()));
}

void Outputs::advertiseLatched() {
  const bool is_latched = true;
  import_report_ = nh_.advertise<std_msgs::String>(names::kImportReport, 1, is_latched);
  std_msgs::String report;
  report.data = simulator_.scene().import_report;
  import_report_.publish(report);
  if (!simulator_.accuracy()) return;
  accuracy_bill_ = nh_.advertise<std_msgs::String>(names::kAccuracyBill, 1, is_latched);
  publishBill();
}

template <class Message>
Topic<Message> Outputs::advertise(const std::string& topic, std::function<Message()> make) {
  return Topic<Message>(nh_.advertise<Message>(
      topic, kQueueSize,
      [this, make](const ros::SingleSubscriberPublisher& subscriber) {
        subscribers_changed_ = true;
        if (is_paused_ && !hasGotSomething(subscriber)) subscriber.publish(make());
      },
      [this](const ros::SingleSubscriberPublisher&) { subscribers_changed_ = true; }));
}

template <class Message>
void Outputs::advertise(BodyTopics<Message>& kind, const std::string& name,
                        std::function<Message(Eigen::Index)> make) {
  if (kind.rate.every == 0) return;
  for (Eigen::Index i = 0; i < simulator_.bodies().count(); ++i)
    kind.topics.push_back(advertise<Message>(simulator_.scene().bodies[i].name + "/" + name,
                                             [make, i] { return make(i); }));
  kind.wanted.reserve(kind.topics.size());
}

void Outputs::serveNewSubscribers() {
  if (connections_.isEmpty()) return;
  if (is_paused_) gate_.drain();
  connections_.callAvailable(ros::WallDuration(0));
}

void Outputs::publishBill() {
  std_msgs::String bill;
  bill.data = toText(simulator_.accuracy()->bill, simulator_.scene());
  accuracy_bill_.publish(bill);
}

/// To ask every topic of every body at every tick would take longer than to step the bodies.
void Outputs::lookForSubscribers() {
  if (!subscribers_changed_ && connections_.isEmpty()) return;
  const auto look = [](auto& kind) {
    kind.wanted.clear();
    for (std::size_t i = 0; i < kind.topics.size(); ++i)
      if (kind.topics[i].isWanted()) kind.wanted.push_back(static_cast<Eigen::Index>(i));
  };
  look(twists_);
  look(odoms_);
  look(applied_wrenches_);
  subscribers_changed_ = false;
}

template <class Message, class Make>
bool Outputs::publish(BodyTopics<Message>& kind, bool now, Make make) {
  if (!kind.rate.isDue(simulator_.tick(), now)) return false;
  for (const Eigen::Index body : kind.wanted) kind.topics[body].publish(make(body));
  return !kind.wanted.empty();
}

void Outputs::publish(bool now) {
  lookForSubscribers();
  messages_.begin(stamp());
  bool is_any = false;
  const auto send = [&](const auto& topic, Rate& rate, auto make) {
    if (!rate.isDue(simulator_.tick(), now) || !topic.isWanted()) return;
    topic.publish(make());
    is_any = true;
  };
  send(clock_, clock_rate_, [&] { return toClock(stamp()); });
  send(
      tf_, tf_rate_, [&]() -> const auto& { return messages_.tf(); });
  send(
      states_, states_rate_, [&]() -> const auto& { return messages_.states(); });
  send(
      effect_wrenches_,
      effect_wrenches_rate_, [&]() -> const auto& { return messages_.effectWrenches(); });
  is_any |= publish(
      twists_, now, [&](auto i) -> const auto& { return messages_.twist(i); });
  is_any |= publish(
      odoms_, now, [&](auto i) -> const auto& { return messages_.odometry(i); });
  is_any |= publish(
      applied_wrenches_, now, [&](auto i) -> const auto& { return messages_.appliedWrench(i); });
  if (!is_any) return;
  sendPublished();
  gate_.pass();
}

}  // namespace rigid_body_sim

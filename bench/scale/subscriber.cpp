#include "scale/subscriber.hpp"

#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <signal.h>
#include <unistd.h>

#include <csignal>
#include <cstdint>
#include <cstdio>

namespace rigid_body_sim::scale {

/// A message of any type.
struct AnyMessage {};

namespace {

volatile std::sig_atomic_t is_asked = 0;

void ask(int) { is_asked = 1; }

}  // namespace
}  // namespace rigid_body_sim::scale

namespace ros {
namespace message_traits {

template <>
struct MD5Sum<rigid_body_sim::scale::AnyMessage> {
  static const char* value() { return "*"; }
  static const char* value(const rigid_body_sim::scale::AnyMessage&) { return "*"; }
};

template <>
struct DataType<rigid_body_sim::scale::AnyMessage> {
  static const char* value() { return "*"; }
  static const char* value(const rigid_body_sim::scale::AnyMessage&) { return "*"; }
};

}  // namespace message_traits

namespace serialization {

template <>
struct Serializer<rigid_body_sim::scale::AnyMessage> {
  template <class Stream, class Message>
  static void allInOne(Stream&, Message) {}
  template <class Stream>
  static void read(Stream&, rigid_body_sim::scale::AnyMessage&) {}
};

}  // namespace serialization
}  // namespace ros

namespace rigid_body_sim::scale {

int subscribe(const std::vector<std::string>& topics) {
  ros::init(ros::M_string(), "subscriber", ros::init_options::AnonymousName);
  ros::NodeHandle nh;
  std::vector<std::uint64_t> counts(topics.size(), 0);
  std::vector<ros::Subscriber> subscribers;
  std::size_t silent = topics.size();
  std::uint64_t all = 0;
  for (std::size_t i = 0; i < topics.size(); ++i) {
    const boost::function<void(const boost::shared_ptr<AnyMessage const>&)> take =
        [&, i](const boost::shared_ptr<AnyMessage const>&) {
          ++all;
          if (counts[i]++ == 0 && --silent == 0) {
            std::printf("ready\n");
            std::fflush(stdout);
          }
        };
    subscribers.push_back(nh.subscribe<AnyMessage>(topics[i], 100, take));
  }
  signal(SIGUSR1, ask);
  const pid_t parent = getppid();
  while (ros::ok() && getppid() == parent) {
    ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(0.05));
    if (!is_asked) continue;
    is_asked = 0;
    std::printf("received %llu\n", static_cast<unsigned long long>(all));
    std::fflush(stdout);
  }
  return 0;
}

}  // namespace rigid_body_sim::scale

#pragma once

#include <ros/poll_manager.h>
#include <ros/publication.h>
#include <ros/publisher.h>
#include <ros/serialization.h>
#include <ros/topic_manager.h>

#include "rigid_body_sim/conventions.hpp"

namespace rigid_body_sim {

/// A topic that is advertised. Beside a ros::Publisher it knows its place among the node's topics:
/// to publish, and to ask for the number of subscribers, roscpp compares the topic's name with
/// those of all others, which for three topics of each of 1,000 bodies took a third of a core.
template <class Message>
class Topic {
 public:
  Topic() = default;  ///< nobody wants it
  explicit Topic(const ros::Publisher& publisher)
      : publisher_(publisher),
        publication_(ros::TopicManager::instance()->lookupPublication(publisher.getTopic())) {}

  /// Whether there are subscribers.
  bool isWanted() const { return publication_ && publication_->hasSubscribers(); }

  /// Leaves the message for roscpp's own thread, until sendPublished().
  void publish(const Message& message) const {
    ros::SerializedMessage bytes = ros::serialization::serializeMessage(message);
    publication_->publish(bytes);
  }

 private:
  ros::Publisher publisher_;  // while it is there the topic is advertised
  ros::PublicationPtr publication_;
};

/// Wakes the thread that sends: once for all that is published, as each time it looks at all
/// topics.
inline void sendPublished() { ros::PollManager::instance()->getPollSet().signal(); }

/// When a topic's message is due.
struct Rate {
  int every = 1;   ///< ticks from one message to the next; 0: never
  Tick sent = -1;  ///< the latest tick that it was due in

  /// Whether it is due at `tick`, or overdue if `now`; never twice for a tick.
  bool isDue(Tick tick, bool now) {
    if (every == 0 || sent == tick || (!now && tick % every != 0)) return false;
    sent = tick;
    return true;
  }
};

}  // namespace rigid_body_sim

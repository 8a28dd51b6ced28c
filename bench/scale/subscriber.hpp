#pragma once

#include <string>
#include <vector>

namespace rigid_body_sim::scale {

/// A process that subscribes to topics of any type, and counts what comes without looking at it.
/// Says "ready" when something has come on each, and on SIGUSR1 how many messages came so far.
int subscribe(const std::vector<std::string>& topics);

}  // namespace rigid_body_sim::scale

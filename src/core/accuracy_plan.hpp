#pragma once

#include "core/part.hpp"
#include "rigid_body_sim/accuracy.hpp"

namespace rigid_body_sim {

/// As plan() of a scene, in the middle of its simulation and under the wrenches that are held now,
/// as if for ever. Where nothing keeps the budget, the bill has the best there is.
Bill planFrom(const Situation& now, const Budget& budget);

/// The bill with a new choice for one body, or for all if effects couple them.
Bill planAgain(const Bill& bill, const Situation& now, Eigen::Index body);

/// @throws std::invalid_argument naming the body, the best there is and what it leaves, if the bill
/// does not keep its budget
void requireKept(const Bill& bill, const Scene& scene);

}  // namespace rigid_body_sim

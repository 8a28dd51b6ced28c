#pragma once

#include "core/part.hpp"
#include "rigid_body_sim/accuracy.hpp"

namespace rigid_body_sim {

/// What becomes of a plan when nothing keeps the budget for a body.
enum class WithoutAMethod { kRefuse, kTakeTheBest };

/// As plan() of a scene, in the middle of its simulation and under the wrenches that are held now,
/// as if for ever.
/// @throws std::invalid_argument as plan(), or if it shall end; Unplannable for a body
Bill planFrom(const Situation& now, const Budget& budget, WithoutAMethod otherwise);

/// The bill with a new choice for one body, or for all if effects couple them; the best there is
/// where nothing keeps the budget, and the bill as it is where nothing can be known.
Bill planAgain(const Bill& bill, const Situation& now, Eigen::Index body);

/// Why the bill is no plan: the budget, the body, the best there is and what it leaves, and what to
/// do.
std::string refusal(const Bill& bill, const ClassBill& one, const Scene& scene);

/// Why nothing can be planned, and what to do.
std::string refusal(const Budget& budget, const Unplannable& why, const Scene& scene);

}  // namespace rigid_body_sim

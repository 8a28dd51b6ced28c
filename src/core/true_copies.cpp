#include "core/true_copies.hpp"

#include <algorithm>

#include "core/local_error.hpp"

namespace rigid_body_sim {

bool TrueCopies::follow(Eigen::Index body, const Bodies& now, Tick tick) {
  const auto is_it = [body](const Copy& copy) { return copy.body == body; };
  if (copies_.size() >= kMost || std::any_of(copies_.begin(), copies_.end(), is_it)) return false;
  copies_.push_back({body, tick, now.state(body)});
  return true;
}

void TrueCopies::give(const ImpulseInput& input) {
  for (Copy& copy : copies_) {
    if (copy.body != input.body) continue;
    const Wrench impulse = inWorldAboutCom(input.applied, copy.state.q_WB);
    copy.state.P_WB += impulse.f_F;
    copy.state.L_WBcm_W += impulse.t_Q_F;
  }
}

void TrueCopies::step(const Situation& now, const std::vector<Method>& methods) {
  for (Copy& copy : copies_) {
    auto part = partOf(now, {copy.body});
    if (!part) return;  // never: coupled bodies are not followed
    part->bodies.setState(0, copy.state);
    copy.state = flyTickTruly(*part, methods[copy.body]).state(0);
  }
}

void TrueCopies::forget(Eigen::Index body) {
  copies_.erase(std::remove_if(copies_.begin(), copies_.end(),
                               [body](const Copy& copy) { return copy.body == body; }),
                copies_.end());
}

}  // namespace rigid_body_sim

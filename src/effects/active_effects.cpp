#include <algorithm>

#include "rigid_body_sim/effect.hpp"

namespace rigid_body_sim {

void ActiveEffects::remove(const Effect* effect) {
  effects_.erase(std::remove(effects_.begin(), effects_.end(), effect), effects_.end());
}

const Wrenches& ActiveEffects::evaluate(const Bodies& bodies, double time_s) {
  sum_.f_W.setZero(bodies.count(), 3);
  sum_.t_Bcm_W.setZero(bodies.count(), 3);
  for (const Effect* effect : effects_) effect->addWrenches(bodies, time_s, sum_);
  return sum_;
}

}  // namespace rigid_body_sim

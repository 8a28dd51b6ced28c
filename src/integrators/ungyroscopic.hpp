#pragma once

#include <memory>
#include <vector>

#include "rigid_body_sim/integrator.hpp"

namespace rigid_body_sim {

/// Bodies without the gyroscopic term, where there are any: whoever has none takes Gyroscopic::kOn
/// at compile time, which does not ask.
template <Gyroscopic gyroscopic>
class Ungyroscopic {
 public:
  explicit Ungyroscopic(const std::vector<Eigen::Index>& bodies) {
    for (const Eigen::Index i : bodies) {
      if (i >= static_cast<Eigen::Index>(is_.size())) is_.resize(static_cast<std::size_t>(i) + 1);
      is_[static_cast<std::size_t>(i)] = true;
    }
  }

  bool has(Eigen::Index i) const {
    if constexpr (gyroscopic == Gyroscopic::kOn) return false;
    return i < static_cast<Eigen::Index>(is_.size()) && is_[static_cast<std::size_t>(i)];
  }

  Gyroscopic of(Eigen::Index i) const { return has(i) ? Gyroscopic::kOff : Gyroscopic::kOn; }

 private:
  std::vector<bool> is_;
};

/// The integrator `Method<gyroscopic>` for these options, made of them and `more`.
template <template <Gyroscopic> class Method, class... More>
std::unique_ptr<Integrator> makeFor(const IntegratorOptions& options, More&&... more) {
  if (options.ungyroscopic.empty())
    return std::make_unique<Method<Gyroscopic::kOn>>(options, std::forward<More>(more)...);
  return std::make_unique<Method<Gyroscopic::kOff>>(options, std::forward<More>(more)...);
}

}  // namespace rigid_body_sim

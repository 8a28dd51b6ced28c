#pragma once

#include <vector>

#include "integrators/batch/columns.hpp"
#include "rigid_body_sim/integrator.hpp"

namespace rigid_body_sim {

/// The bodies without the gyroscopic term, if there are any.
class Ungyroscopic {
 public:
  explicit Ungyroscopic(const std::vector<Eigen::Index>& bodies) {
    for (const Eigen::Index i : bodies) {
      if (i >= static_cast<Eigen::Index>(is_.size())) is_.resize(static_cast<std::size_t>(i) + 1);
      is_[static_cast<std::size_t>(i)] = true;
    }
  }

  bool has(Eigen::Index i) const {
    return i < static_cast<Eigen::Index>(is_.size()) && is_[static_cast<std::size_t>(i)];
  }

  Gyroscopic of(Eigen::Index i) const { return has(i) ? Gyroscopic::kOff : Gyroscopic::kOn; }

  /// f(range, gyroscopic) for bodies in a row that are alike. A range that does not begin at a
  /// tile's edge ends at the next one.
  template <class F>
  void forRuns(Eigen::Index count, F f) const {
    if (is_.empty()) return f(batch::Range{0, count}, Gyroscopic::kOn);
    for (Eigen::Index begin = 0, end; begin < count; begin = end) {
      const bool is_within_tile = begin % batch::kTile != 0;
      for (end = begin + 1; end < count && has(end) == has(begin); ++end)
        if (is_within_tile && end % batch::kTile == 0) break;
      f(batch::Range{begin, end}, of(begin));
    }
  }

 private:
  std::vector<bool> is_;
};

}  // namespace rigid_body_sim

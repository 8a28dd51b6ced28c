#pragma once

#include <vector>

#include "integrators/batch/kernels.hpp"
#include "rigid_body_sim/effect.hpp"

// Bodies and wrenches as the batch kernels take them.
namespace rigid_body_sim {

inline batch::BodyColumns columnsOf(Bodies& bodies) {
  return {bodies.count(),     bodies.mass.data(), bodies.I_BBcm_B.data(), bodies.p_WBcm.data(),
          bodies.q_WB.data(), bodies.P_WB.data(), bodies.L_WBcm_W.data(), bodies.p_low.data()};
}

inline batch::WrenchColumns columnsOf(const Wrenches& wrenches) {
  return {wrenches.f_W.rows(), wrenches.f_W.data(), wrenches.t_Bcm_W.data()};
}

inline batch::Range allOf(const Bodies& bodies) { return {0, bodies.count()}; }

/// What a method keeps of each body, see batch::kTile. Of zeros at first.
class Tiles {
 public:
  explicit Tiles(int numbers) : numbers_(numbers) {}

  /// For that many bodies; bodies that were there keep what they have.
  void resize(Eigen::Index count) {
    lines_.resize(batch::tileSize(count, numbers_) / batch::kTile);
  }
  double* data() { return lines_.empty() ? nullptr : lines_.front().numbers; }

 private:
  /// The eight bodies' numbers of one kind: a line of the cache.
  struct alignas(64) Line {
    double numbers[batch::kTile] = {};
  };

  int numbers_;
  std::vector<Line> lines_;
};

}  // namespace rigid_body_sim

#pragma once

#include <vector>

#include "core/part.hpp"

namespace rigid_body_sim {

/// Bodies that fly a second time, by a far better method and under the same inputs, beside a
/// running simulation: their distance from the simulation's is the error that it has made since.
class TrueCopies {
 public:
  /// As many at once; each takes at most kMostEvaluations a tick, or what
  /// stiff friction asks for.
  static constexpr std::size_t kMost = 8;

  struct Copy {
    Eigen::Index body;
    Tick since;  ///< the tick at whose beginning it was the same as the simulation's
    BodyState state;
  };

  /// Begins to follow a body from its present state. @returns false if it is followed already, or
  /// as many are as can be.
  bool follow(Eigen::Index body, const Bodies& now, Tick tick);

  /// An impulse that the simulation gives to its own body, too.
  void give(const ImpulseInput& input);

  /// The tick that begins now. @param methods that the simulation uses, of each body
  void step(const Situation& now, const std::vector<Method>& methods);

  void forget(Eigen::Index body);
  void clear() { copies_.clear(); }
  const std::vector<Copy>& copies() const { return copies_; }

 private:
  std::vector<Copy> copies_;
};

}  // namespace rigid_body_sim

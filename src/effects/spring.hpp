#pragma once

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <set>
#include <vector>

#include "rigid_body_sim/column_pointers.hpp"
#include "rigid_body_sim/effect.hpp"

// What springs and their dashpots have in common.
namespace rigid_body_sim {

constexpr Eigen::Index kWorld = -1;

/// One end of a spring.
struct End {
  Eigen::Index body = kWorld;
  Vector3d p = Vector3d::Zero();  // [m] from the centre of mass in B; of the world: p_WQ
  bool turns = false;             // p is not the centre of mass: forces have a torque

  bool isInWorld() const { return body == kWorld; }
};

struct Spring {
  std::array<End, 2> ends;
  double stiffness;    // [N/m]
  double damping;      // [N s/m]
  double rest_length;  // [m]
  bool tension_only;

  /// Without a direction, as at length zero, there is no force.
  bool actsAt(double length) const {
    return length > 0 && !(tension_only && length <= rest_length);
  }
};

using Springs = std::vector<Spring>;

/// The line between the ends at an instant.
struct Line {
  std::array<Turn, 2> R_WB;   // of those bodies whose end turns
  std::array<Triple, 2> r_W;  // from the bodies' centres of mass, the same
  Triple d_W;                 // from the first to the second end
  double length;
};

inline Line lineOf(const Spring& spring, const Instant& now) {
  const RotationPointers R_WB(now.R_WB());
  const auto p_WBcm = pointersTo(now.bodies().p_WBcm);
  Line line;
  std::array<Triple, 2> p_W;
  for (int k = 0; k < 2; ++k) {
    const End& end = spring.ends[k];
    p_W[k] = end.isInWorld() ? Triple(end.p) : at(p_WBcm, end.body);
    if (!end.turns) continue;
    line.R_WB[k] = R_WB.of(end.body);
    line.r_W[k] = line.R_WB[k].times(Triple(end.p));
    p_W[k] = p_W[k] + line.r_W[k];
  }
  line.d_W = p_W[1] - p_W[0];
  line.length = std::sqrt(dot(line.d_W, line.d_W));
  return line;
}

/// f_W on the first end, -f_W on the second.
inline void addForce(const Spring& spring, const Line& line, const Triple& f_W,
                     Wrenches& wrenches) {
  for (int k = 0; k < 2; ++k) {
    const End& end = spring.ends[k];
    if (end.isInWorld()) continue;
    const Triple own_W = k == 0 ? f_W : -1 * f_W;
    add(pointersTo(wrenches.f_W), end.body, own_W);
    if (end.turns) add(pointersTo(wrenches.t_Bcm_W), end.body, cross(line.r_W[k], own_W));
  }
}

/// The largest inverse mass [1/kg] that a force at the end can meet, in any direction n: that of
/// n.M^-1 n + (p x n).I^-1 (p x n). An arm along a rod's axis turns the rod across, whatever its
/// moment about the axis.
inline double lightest(const End& end, const Bodies& bodies) {
  if (end.isInWorld()) return 0;
  double inverse = 1 / bodies.mass(end.body);
  if (bodies.hasAddedMass()) {
    const Eigen::Matrix<double, 9, 1> A = bodies.inverse_mass_B.row(end.body);
    inverse = Eigen::Map<const Matrix3d>(A.data()).selfadjointView<Eigen::Lower>().eigenvalues()(2);
  }
  if (!end.turns) return inverse;
  Matrix3d cross;  // p x n
  cross << 0, -end.p.z(), end.p.y(), end.p.z(), 0, -end.p.x(), -end.p.y(), end.p.x(), 0;
  const Matrix3d turning =
      cross.transpose() * bodies.moments(end.body).cwiseInverse().asDiagonal() * cross;
  return inverse + turning.selfadjointView<Eigen::Lower>().eigenvalues()(2);
}

/// What springs do together: the bodies that they act on, and the same ones among some bodies.
class SpringEffect : public Effect {
 public:
  explicit SpringEffect(Springs springs) : springs_(std::move(springs)) {
    std::set<Eigen::Index> bodies;
    for (const Spring& spring : springs_)
      for (const End& end : spring.ends)
        if (!end.isInWorld()) bodies.insert(end.body);
    body_count_ = bodies.size();
  }

  std::size_t bodyCount() const override { return body_count_; }

 protected:
  double springsPerBody() const {
    return body_count_ == 0 ? 0 : static_cast<double>(springs_.size()) / double(body_count_);
  }

  /// Null if one would be cut.
  std::unique_ptr<Springs> springsAmong(const std::vector<Eigen::Index>& some) const {
    auto restricted = std::make_unique<Springs>();
    for (Spring spring : springs_) {
      int found = 0, bodies = 0;
      for (End& end : spring.ends) {
        if (end.isInWorld()) continue;
        ++bodies;
        const auto place = std::find(some.begin(), some.end(), end.body);
        if (place == some.end()) continue;
        ++found;
        end.body = place - some.begin();
      }
      if (found == bodies) restricted->push_back(spring);
      if (found != bodies && found > 0) return nullptr;
    }
    return restricted;
  }

  const Springs& springs() const { return springs_; }

 private:
  Springs springs_;
  std::size_t body_count_;
};

/// The dashpots of springs.
std::shared_ptr<const Effect> springDamping(const Springs& springs);

}  // namespace rigid_body_sim

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "effects/makers.hpp"

namespace rigid_body_sim {
namespace {

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
  std::array<Vector3d, 2> r_W;  // from the bodies' centres of mass
  Vector3d d_W;                 // from the first to the second end
  double length;
};

/// `turned(i, r_B)` turns a vector of body i to W.
template <class Turned>
Line lineOf(const Spring& spring, const Bodies& bodies, Turned turned) {
  Line line;
  std::array<Vector3d, 2> p_W;
  for (int k = 0; k < 2; ++k) {
    const End& end = spring.ends[k];
    line.r_W[k] = end.turns ? Vector3d(turned(end.body, end.p)) : Vector3d::Zero();
    p_W[k] =
        end.isInWorld() ? end.p : Vector3d(bodies.p_WBcm.row(end.body).transpose() + line.r_W[k]);
  }
  line.d_W = p_W[1] - p_W[0];
  line.length = line.d_W.norm();
  return line;
}

Line lineOf(const Spring& spring, const Instant& now) {
  return lineOf(spring, now.bodies(),
                [&](Eigen::Index i, const Vector3d& r_B) -> Vector3d { return now.R_WB(i) * r_B; });
}

/// f_W on the first end, -f_W on the second.
void addForce(const Spring& spring, const Line& line, const Vector3d& f_W, Wrenches& wrenches) {
  for (int k = 0; k < 2; ++k) {
    const End& end = spring.ends[k];
    if (end.isInWorld()) continue;
    const Vector3d own_W = k == 0 ? f_W : Vector3d(-f_W);
    wrenches.f_W.row(end.body) += own_W;
    if (end.turns) wrenches.t_Bcm_W.row(end.body) += line.r_W[k].cross(own_W);
  }
}

/// The largest inverse mass [1/kg] that a force at the end can meet, in any direction.
double lightest(const End& end, const Bodies& bodies) {
  if (end.isInWorld()) return 0;
  double inverse = 1 / bodies.mass(end.body);
  if (bodies.hasAddedMass()) {
    const Eigen::Matrix<double, 9, 1> A = bodies.inverse_mass_B.row(end.body);
    inverse = Eigen::Map<const Matrix3d>(A.data()).selfadjointView<Eigen::Lower>().eigenvalues()(2);
  }
  return end.turns ? inverse + end.p.squaredNorm() / bodies.moments(end.body)(0) : inverse;
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

/// f = -k (l - l0) along the line (Hooke 1678), potential k (l - l0)^2/2; with `tension_only` both
/// only beyond l0.
class ElasticSprings : public SpringEffect {
 public:
  using SpringEffect::SpringEffect;

  std::string name() const override { return "spring"; }
  bool isConservative() const override { return true; }

  /// Measured: 0.5 with one end on a body's centre, 1.3 off it, 1.9 with two off it.
  double cost() const override { return 1.5 * springsPerBody(); }

  void addWrenches(const Instant& now, Wrenches& wrenches) const override {
    for (const Spring& spring : springs()) {
      const Line line = lineOf(spring, now);
      if (spring.actsAt(line.length)) addForce(spring, line, pull(spring, line), wrenches);
    }
  }

  double potentialEnergy(const Instant& now) const override {
    double sum = 0;
    for (const Spring& spring : springs()) {
      const double extension = lineOf(spring, now).length - spring.rest_length;
      if (spring.tension_only && extension <= 0) continue;
      sum += 0.5 * spring.stiffness * extension * extension;
    }
    return sum;
  }

  /// No frequency is above the largest sum over one body's springs of k (1/m + r^2/I1) of both
  /// ends: the columns' norm of M^-1 K bounds its eigenvalues (Horn and Johnson, Matrix Analysis,
  /// 1985, 5.6.9). What the present force turns an end's own body by, as a pendulum, comes on top.
  Stiffness stiffness(const Instant& now) const override {
    const Bodies& bodies = now.bodies();
    Eigen::VectorXd squares = Eigen::VectorXd::Zero(bodies.count());
    for (const Spring& spring : springs()) {
      const Line line = lineOf(spring, now);
      const double own =
          spring.stiffness * (lightest(spring.ends[0], bodies) + lightest(spring.ends[1], bodies));
      const double force = spring.actsAt(line.length) ? pull(spring, line).norm() : 0;
      for (const End& end : spring.ends) {
        if (end.isInWorld()) continue;
        squares(end.body) += own;
        if (end.turns) squares(end.body) += force * end.p.norm() / bodies.moments(end.body)(0);
      }
    }
    Eigen::Index stiffest = 0;
    const double square = squares.maxCoeff(&stiffest);
    return {std::sqrt(square), 0, stiffest};
  }

  std::shared_ptr<const Effect> restrictedTo(const std::vector<Eigen::Index>& some) const override {
    const auto own = springsAmong(some);
    return own ? std::make_shared<ElasticSprings>(*own) : nullptr;
  }

 private:
  /// On the first end; smooth at l = 0 if l0 = 0.
  static Vector3d pull(const Spring& spring, const Line& line) {
    return spring.stiffness * (1 - spring.rest_length / line.length) * line.d_W;
  }
};

/// f = -c l' along the line, with `tension_only` beyond l0.
///
/// Equal and opposite impulses along the line change l' by their size times
/// 1/m_eff = sum of n.M^-1 n + (r x n).I^-1 (r x n) over the bodies. So in a flow at fixed poses
/// l' falls by exp(-c h/m_eff), whatever c and h. Each spring's own flow comes after the other,
/// after the drift the other way round.
class SpringDamping : public SpringEffect {
 public:
  using SpringEffect::SpringEffect;

  std::string name() const override { return "spring_damping"; }
  bool dependsOnVelocity() const override { return true; }
  int flowOrder() const override { return 2; }

  /// Measured, with an end off the centre; half of what both halves of the flow take.
  double cost() const override { return 4 * springsPerBody(); }

  void addWrenches(const Instant& now, Wrenches& wrenches) const override {
    for (const Spring& spring : springs()) {
      const Line line = lineOf(spring, now);
      if (!spring.actsAt(line.length)) continue;
      const Vector3d n_W = line.d_W / line.length;
      double rate = 0;  // l'
      for (int k = 0; k < 2; ++k) {
        const Eigen::Index i = spring.ends[k].body;
        if (i == kWorld) continue;
        Vector3d v_WQ = now.v_WBcm().row(i);
        if (spring.ends[k].turns) v_WQ += Vector3d(now.w_WB().row(i)).cross(line.r_W[k]);
        rate += (k == 0 ? -1 : 1) * n_W.dot(v_WQ);
      }
      addForce(spring, line, spring.damping * rate * n_W, wrenches);
    }
  }

  void beforeDrift(Bodies& bodies, double, double h) const override {
    for (const Spring& spring : springs()) flow(spring, bodies, 0.5 * h);
  }

  void afterDrift(Bodies& bodies, double, double h) const override {
    for (auto spring = springs().rbegin(); spring != springs().rend(); ++spring)
      flow(*spring, bodies, 0.5 * h);
  }

  /// Bounded as that of ElasticSprings.
  Stiffness stiffness(const Instant& now) const override {
    const Bodies& bodies = now.bodies();
    Eigen::VectorXd rates = Eigen::VectorXd::Zero(bodies.count());
    for (const Spring& spring : springs()) {
      const double own =
          spring.damping * (lightest(spring.ends[0], bodies) + lightest(spring.ends[1], bodies));
      for (const End& end : spring.ends)
        if (!end.isInWorld()) rates(end.body) += own;
    }
    Eigen::Index stiffest = 0;
    const double rate = rates.maxCoeff(&stiffest);
    return {0, rate, stiffest};
  }

  std::shared_ptr<const Effect> restrictedTo(const std::vector<Eigen::Index>& some) const override {
    const auto own = springsAmong(some);
    return own ? std::make_shared<SpringDamping>(*own) : nullptr;
  }

 private:
  static Quaterniond attitude(const Bodies& bodies, Eigen::Index i) {
    return Quaterniond(Eigen::Vector4d(bodies.q_WB.row(i)));
  }

  static void flow(const Spring& spring, Bodies& bodies, double h) {
    const Line line = lineOf(spring, bodies, [&](Eigen::Index i, const Vector3d& r_B) {
      return attitude(bodies, i) * r_B;
    });
    if (!spring.actsAt(line.length)) return;
    const Vector3d n_W = line.d_W / line.length;
    std::array<Vector3d, 2> arms_W;  // r x n
    double rate = 0, inverse_mass = 0;
    for (int k = 0; k < 2; ++k) {
      const End& end = spring.ends[k];
      if (end.isInWorld()) continue;
      double own = n_W.dot(bodies.v_WBcm(end.body));
      inverse_mass += n_W.dot(bodies.velocityFor(end.body, n_W));
      if (end.turns) {
        arms_W[k] = line.r_W[k].cross(n_W);
        const Vector3d w_W = angularVelocity(arms_W[k], bodies, end.body);
        own += w_W.dot(bodies.L_WBcm_W.row(end.body));  // I^-1 is symmetric
        inverse_mass += w_W.dot(arms_W[k]);
      }
      rate += k == 0 ? -own : own;
    }
    const double impulse = -std::expm1(-spring.damping * h * inverse_mass) / inverse_mass * rate;
    for (int k = 0; k < 2; ++k) {
      const End& end = spring.ends[k];
      if (end.isInWorld()) continue;
      const double own = k == 0 ? impulse : -impulse;
      bodies.P_WB.row(end.body) += own * n_W;
      if (end.turns) bodies.L_WBcm_W.row(end.body) += own * arms_W[k];
    }
  }

  /// I^-1 L in W.
  static Vector3d angularVelocity(const Vector3d& L_W, const Bodies& bodies, Eigen::Index i) {
    const Quaterniond q_WB = attitude(bodies, i);
    return q_WB * (q_WB.conjugate() * L_W).cwiseQuotient(bodies.moments(i));
  }
};

/// The point below `key` of the body below `name`; the centre of mass if it is not there.
End bodyEnd(const EffectBlock& block, const Parameters& entry, const std::string& name,
            const std::string& key) {
  End end;
  end.body = block.bodyNamed(entry, name);
  const SceneBody& body = block.bodies[end.body];
  const BodyFrame frame = bodyFrame(body);
  const Vector3d p_LQ = entry.vector3(key, finite("m"), frame.p_LBcm);
  end.p = frame.q_LB.conjugate() * (p_LQ - frame.p_LBcm);
  end.turns = !end.p.isZero(0);
  if (end.turns && body.is_point_mass)
    entry.refuse(key, "the point mass '" + body.name + "' takes no torque: only its centre");
  return end;
}

End otherEnd(const EffectBlock& block, const Parameters& entry) {
  if (entry.has("to") == entry.has("anchor"))
    entry.refuse("to", "it takes `to`, a body, or `anchor`, a point of the world [m]: one of them");
  if (entry.has("to")) return bodyEnd(block, entry, "to", "to_point");
  if (entry.has("to_point")) entry.refuse("to_point", "is of a body; there is no `to`");
  return {kWorld, entry.vector3("anchor", finite("m")), false};
}

Spring springOf(const EffectBlock& block, const Parameters& entry) {
  for (const char* key : {"point", "to_point", "to", "anchor"}) entry.has(key);
  Spring spring = {{bodyEnd(block, entry, "body", "point"), otherEnd(block, entry)},
                   entry.number("stiffness", notNegative("N/m")),
                   entry.number("damping", notNegative("N s/m"), 0),
                   entry.number("rest_length", notNegative("m"), 0),
                   entry.boolean("tension_only", false)};
  if (spring.ends[0].body == spring.ends[1].body)
    entry.refuse("to", "both ends are on the body '" + block.bodies[spring.ends[0].body].name +
                           "'; that is no spring");
  return spring;
}

}  // namespace

EffectList makeSpring(EffectBlock& block) {
  Springs elastic, damped;
  for (const Parameters& entry : block.entries) {
    const Spring spring = springOf(block, entry);
    if (spring.stiffness > 0) elastic.push_back(spring);
    if (spring.damping > 0) damped.push_back(spring);
  }
  EffectList effects;
  if (!elastic.empty()) effects.push_back(std::make_shared<ElasticSprings>(std::move(elastic)));
  if (!damped.empty()) effects.push_back(std::make_shared<SpringDamping>(std::move(damped)));
  return effects;
}

}  // namespace rigid_body_sim

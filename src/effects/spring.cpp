#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "effects/makers.hpp"
#include "rigid_body_sim/column_pointers.hpp"

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
double lightest(const End& end, const Bodies& bodies) {
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

/// Square of the frequency [1/s^2] at which the force f_W at the end swings its body about the
/// centre of mass, as a pendulum; the torque of a small turn t is p x f -> (t x p) x f.
double pendulumSquare(const End& end, const Turn& R_WB, const Triple& f_W, const Bodies& bodies) {
  const Triple turned = R_WB.transposedTimes(f_W);
  const Vector3d f_B(turned.x, turned.y, turned.z);
  const Vector3d scale = bodies.moments(end.body).cwiseSqrt().cwiseInverse();
  const Matrix3d stiffness = end.p.dot(f_B) * Matrix3d::Identity() -
                             0.5 * (end.p * f_B.transpose() + f_B * end.p.transpose());
  const Matrix3d scaled = scale.asDiagonal() * stiffness * scale.asDiagonal();
  return scaled.selfadjointView<Eigen::Lower>().eigenvalues().cwiseAbs().maxCoeff();
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

  /// No frequency is above the largest sum over one body's springs of k times lightest() of both
  /// ends: the columns' norm of M^-1 K bounds its eigenvalues (Horn and Johnson, Matrix Analysis,
  /// 1985, 5.6.9). What the present force turns an end's own body by, as a pendulum, comes on top.
  Stiffness stiffness(const Instant& now) const override {
    const Bodies& bodies = now.bodies();
    Eigen::VectorXd squares = Eigen::VectorXd::Zero(bodies.count());
    bool is_linear = true;
    for (const Spring& spring : springs()) {
      is_linear = is_linear && isLinear(spring);
      const Line line = lineOf(spring, now);
      const double own =
          spring.stiffness * (lightest(spring.ends[0], bodies) + lightest(spring.ends[1], bodies));
      const Triple pulled = spring.actsAt(line.length) ? pull(spring, line) : Triple(0, 0, 0);
      for (int k = 0; k < 2; ++k) {
        const End& end = spring.ends[k];
        if (end.isInWorld()) continue;
        squares(end.body) += own;
        if (end.turns) squares(end.body) += pendulumSquare(end, line.R_WB[k], pulled, bodies);
      }
    }
    Eigen::Index stiffest = 0;
    const double square = squares.maxCoeff(&stiffest);
    return {std::sqrt(square), 0, stiffest, is_linear};
  }

  std::shared_ptr<const Effect> restrictedTo(const std::vector<Eigen::Index>& some) const override {
    const auto own = springsAmong(some);
    return own ? std::make_shared<ElasticSprings>(*own) : nullptr;
  }

 private:
  /// Pulls with the distance alone, and turns nothing.
  static bool isLinear(const Spring& spring) {
    return spring.rest_length == 0 && !spring.tension_only && !spring.ends[0].turns &&
           !spring.ends[1].turns;
  }

  /// On the first end; smooth at l = 0 if l0 = 0.
  static Triple pull(const Spring& spring, const Line& line) {
    return (spring.stiffness * (1 - spring.rest_length / line.length)) * line.d_W;
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
  std::string blockName() const override { return "spring"; }
  bool dependsOnVelocity() const override { return true; }
  int flowOrder() const override { return 2; }

  /// Measured, with an end off the centre; half of what both halves of the flow take.
  double cost() const override { return 4 * springsPerBody(); }

  void addWrenches(const Instant& now, Wrenches& wrenches) const override {
    for (const Spring& spring : springs()) {
      const Line line = lineOf(spring, now);
      if (!spring.actsAt(line.length)) continue;
      const Triple n_W = (1 / line.length) * line.d_W;
      double rate = 0;  // l'
      for (int k = 0; k < 2; ++k) {
        const Eigen::Index i = spring.ends[k].body;
        if (i == kWorld) continue;
        Triple v_WQ = at(pointersTo(now.v_WBcm()), i);
        if (spring.ends[k].turns) v_WQ = v_WQ + cross(at(pointersTo(now.w_WB()), i), line.r_W[k]);
        rate += (k == 0 ? -1 : 1) * dot(n_W, v_WQ);
      }
      addForce(spring, line, (spring.damping * rate) * n_W, wrenches);
    }
  }

  void beforeDrift(Bodies& bodies, const Instant& now, double h) const override {
    for (const Spring& spring : springs()) flow(spring, now, bodies, 0.5 * h);
  }

  void afterDrift(Bodies& bodies, const Instant& now, double h) const override {
    for (auto spring = springs().rbegin(); spring != springs().rend(); ++spring)
      flow(*spring, now, bodies, 0.5 * h);
  }

  /// Bounded as that of ElasticSprings. Not linear: the line turns with what moves across it.
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
  static void flow(const Spring& spring, const Instant& now, Bodies& bodies, double h) {
    const Line line = lineOf(spring, now);
    if (!spring.actsAt(line.length)) return;
    const Triple n_W = (1 / line.length) * line.d_W;
    const auto P = pointersTo(bodies.P_WB), L = pointersTo(bodies.L_WBcm_W);
    std::array<Triple, 2> arms_W;  // r x n
    double rate = 0, inverse_mass = 0;
    for (int k = 0; k < 2; ++k) {
      const End& end = spring.ends[k];
      if (end.isInWorld()) continue;
      const Triple v_W = velocityFor(n_W, bodies, end.body);  // I^-1 and M^-1 are symmetric
      double own = dot(v_W, at(P, end.body));
      inverse_mass += dot(n_W, v_W);
      if (end.turns) {
        arms_W[k] = cross(line.r_W[k], n_W);
        const Triple w_W = angularVelocityFor(arms_W[k], line.R_WB[k], bodies, end.body);
        own += dot(w_W, at(L, end.body));
        inverse_mass += dot(w_W, arms_W[k]);
      }
      rate += k == 0 ? -own : own;
    }
    const double impulse = -std::expm1(-spring.damping * h * inverse_mass) / inverse_mass * rate;
    for (int k = 0; k < 2; ++k) {
      const End& end = spring.ends[k];
      if (end.isInWorld()) continue;
      const double own = k == 0 ? impulse : -impulse;
      add(P, end.body, own * n_W);
      if (end.turns) add(L, end.body, own * arms_W[k]);
    }
  }

  /// M^-1 P
  static Triple velocityFor(const Triple& P_W, const Bodies& bodies, Eigen::Index i) {
    if (bodies.carries(i)) return Triple(bodies.velocityFor(i, P_W.vector()));
    return (1 / bodies.mass(i)) * P_W;
  }

  /// I^-1 L in W.
  static Triple angularVelocityFor(const Triple& L_W, const Turn& R_WB, const Bodies& bodies,
                                   Eigen::Index i) {
    const auto I = pointersTo(bodies.I_BBcm_B);
    const Triple L_B = R_WB.transposedTimes(L_W);
    return R_WB.times({L_B.x / I.x[i], L_B.y / I.y[i], L_B.z / I.z[i]});
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
  block.why_nothing = "the list is empty";
  for (std::size_t k = 0; k < block.entries.size(); ++k) {
    const Spring spring = springOf(block, block.entries[k]);
    if (spring.stiffness == 0 && spring.damping == 0)
      block.idle.push_back("[" + std::to_string(k) + "]: its stiffness and its damping are zero");
    if (spring.stiffness > 0) elastic.push_back(spring);
    if (spring.damping > 0) damped.push_back(spring);
  }
  if (!block.entries.empty()) block.why_nothing = "of no spring is stiffness or damping above zero";
  EffectList effects;
  if (!elastic.empty()) effects.push_back(std::make_shared<ElasticSprings>(std::move(elastic)));
  if (!damped.empty()) effects.push_back(std::make_shared<SpringDamping>(std::move(damped)));
  return effects;
}

}  // namespace rigid_body_sim

#include "effects/spring.hpp"

namespace rigid_body_sim {
namespace {

/// f = -c l' along the line, with `tension_only` beyond l0.
///
/// Equal and opposite impulses along the line change l' by their size times
/// 1/m_eff = sum of n.M^-1 n + (r x n).I^-1 (r x n) over the bodies. So in a flow at fixed poses
/// l' falls by exp(-c h/m_eff), whatever c and h. Each spring's own flow comes after the other,
/// after the drift the other way round.
class SpringDamping : public SpringEffect {
 public:
  explicit SpringDamping(Springs springs) : SpringEffect(std::move(springs)) {
    std::size_t ends = 0;
    for (const Spring& spring : this->springs())
      for (const End& end : spring.ends) ends += end.isInWorld() ? 0 : 1;
    share_bodies_ = ends > bodyCount();
  }

  std::string name() const override { return "spring_damping"; }
  std::string blockName() const override { return "spring"; }
  bool dependsOnVelocity() const override { return true; }
  int flowOrder() const override { return 2; }

  /// Measured, with an end off the centre; half of what both halves of the flow take. Those that
  /// must agree take six times as long.
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
    flowAll(bodies, now, h, Side::kBefore);
  }
  void afterDrift(Bodies& bodies, const Instant& now, double h) const override {
    flowAll(bodies, now, h, Side::kAfter);
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
  enum class Side { kBefore, kAfter };

  /// How the ends of a spring meet impulses along its line.
  struct Grip {
    Line line;
    Triple n_W;
    std::array<Triple, 2> arms_W;  // r x n
    double inverse_mass;           // 1/m_eff
  };

  static Grip gripOf(const Spring& spring, const Line& line, const Bodies& bodies) {
    Grip grip = {line, (1 / line.length) * line.d_W, {}, 0};
    for (int k = 0; k < 2; ++k) {
      const End& end = spring.ends[k];
      if (end.isInWorld()) continue;
      grip.inverse_mass += dot(grip.n_W, velocityFor(grip.n_W, bodies, end.body));
      if (!end.turns) continue;
      grip.arms_W[k] = cross(line.r_W[k], grip.n_W);
      const Triple turned_W = angularVelocityFor(grip.arms_W[k], line.R_WB[k], bodies, end.body);
      grip.inverse_mass += dot(turned_W, grip.arms_W[k]);
    }
    return grip;
  }

  /// Half of the flow of a drift of h. Dashpots that stop their ends at once and share a body would
  /// undo what the one before has done: in small parts, to and fro, they come to an agreement. With
  /// a single pass chains of them gained energy without bound from springs beside them; with four
  /// none of 8,000 random scenes did.
  void flowAll(Bodies& bodies, const Instant& now, double h, Side side) const {
    const double drift_s = side == Side::kBefore ? h : -h;
    if (!mustAgree(bodies, now, 0.5 * h)) {
      flowEach(side == Side::kBefore, bodies, now, 0.5 * h, drift_s);
      return;
    }
    constexpr int kRounds = 4;
    for (int i = 0; i < 2 * kRounds; ++i)
      flowEach(i % 2 == 0, bodies, now, 0.5 * h / (2 * kRounds), drift_s);
  }

  bool mustAgree(const Bodies& bodies, const Instant& now, double h) const {
    if (!share_bodies_) return false;
    return std::any_of(springs().begin(), springs().end(), [&](const Spring& spring) {
      const Line line = lineOf(spring, now);
      return spring.actsAt(line.length) &&
             spring.damping * h * gripOf(spring, line, bodies).inverse_mass > 0.5;
    });
  }

  void flowEach(bool forwards, Bodies& bodies, const Instant& now, double h, double drift_s) const {
    for (std::size_t i = 0; i < springs().size(); ++i)
      flow(springs()[forwards ? i : springs().size() - 1 - i], now, bodies, h, drift_s);
  }

  /// l' falls towards the one that leaves l as it is: a drift of s along straight lines makes l
  /// longer by l'' s^2/2, which a dashpot that only stopped it would give to springs beside it as
  /// energy. So before the drift it is -l'' s/2, and after it l'' s/2. Not if the line, or an end
  /// about its body, turns by more than half a radian meanwhile.
  /// @param drift_s of the drift that follows, or less that of the one that was
  static void flow(const Spring& spring, const Instant& now, Bodies& bodies, double h,
                   double drift_s) {
    const Line line = lineOf(spring, now);
    if (!spring.actsAt(line.length)) return;
    const Grip grip = gripOf(spring, line, bodies);
    const auto P = pointersTo(bodies.P_WB), L = pointersTo(bodies.L_WBcm_W);
    Triple v_W(0, 0, 0), a_W(0, 0, 0);  // of the second end as seen from the first
    double fastest = 0;                 // [rad^2/s^2]
    for (int k = 0; k < 2; ++k) {
      const End& end = spring.ends[k];
      if (end.isInWorld()) continue;
      Triple own_v = velocityFor(at(P, end.body), bodies, end.body), own_a(0, 0, 0);
      if (end.turns) {
        const Triple w_W = angularVelocityFor(at(L, end.body), line.R_WB[k], bodies, end.body);
        const Triple turning_v = cross(w_W, line.r_W[k]);
        own_v = own_v + turning_v;
        own_a = cross(w_W, turning_v);
        fastest = std::max(fastest, dot(w_W, w_W));
      }
      v_W = k == 0 ? v_W - own_v : v_W + own_v;
      a_W = k == 0 ? a_W - own_a : a_W + own_a;
    }
    const double rate = dot(grip.n_W, v_W), l2 = line.length * line.length;
    const double across2 = std::max(0.0, dot(v_W, v_W) - rate * rate);
    fastest = std::max(fastest, across2 / l2);
    const double s2 = drift_s * drift_s;
    double wanted = 0;  // the part across is the exact answer for ends that go straight on
    if (fastest * s2 < 0.25)
      wanted = -drift_s *
               (across2 / (line.length + std::sqrt(l2 - across2 * s2)) + 0.5 * dot(grip.n_W, a_W));
    const double impulse =
        -std::expm1(-spring.damping * h * grip.inverse_mass) / grip.inverse_mass * (rate - wanted);
    for (int k = 0; k < 2; ++k) {
      const End& end = spring.ends[k];
      if (end.isInWorld()) continue;
      const double own = k == 0 ? impulse : -impulse;
      add(P, end.body, own * grip.n_W);
      if (end.turns) add(L, end.body, own * grip.arms_W[k]);
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

  bool share_bodies_ = false;
};

}  // namespace

std::shared_ptr<const Effect> springDamping(Springs springs) {
  return std::make_shared<SpringDamping>(std::move(springs));
}

}  // namespace rigid_body_sim

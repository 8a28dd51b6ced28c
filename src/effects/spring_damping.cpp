#include <map>

#include "effects/spring.hpp"

namespace rigid_body_sim {
namespace {

/// Springs, those that bodies join to each other one after the other.
struct Chains {
  Springs springs;
  std::vector<std::size_t> ends;  // where a chain ends and the next one begins
};

Chains chainsOf(const Springs& springs) {
  std::map<Eigen::Index, Eigen::Index> joined;  // a body to one with a smaller number, or itself
  const auto first = [&](Eigen::Index body) {
    joined.emplace(body, body);
    while (joined[body] != body) body = joined[body] = joined[joined[body]];
    return body;
  };
  const auto firstOf = [&](const Spring& spring) {
    const auto& [a, b] = spring.ends;
    return first(a.isInWorld() ? b.body : a.body);
  };
  for (const Spring& spring : springs)
    for (const End& end : spring.ends) {
      if (end.isInWorld()) continue;
      const Eigen::Index one = firstOf(spring), other = first(end.body);
      joined[std::max(one, other)] = std::min(one, other);
    }
  std::map<Eigen::Index, Springs> chains;
  for (const Spring& spring : springs) chains[firstOf(spring)].push_back(spring);
  Chains all;
  for (const auto& [body, chain] : chains) {
    all.springs.insert(all.springs.end(), chain.begin(), chain.end());
    all.ends.push_back(all.springs.size());
  }
  return all;
}

/// f = -c l' along the line, with `tension_only` beyond l0.
///
/// Equal and opposite impulses along the line change l' by their size times
/// 1/m_eff = sum of n.M^-1 n + (r x n).I^-1 (r x n) over the bodies. So in a flow at fixed poses
/// l' falls by exp(-c h/m_eff), whatever c and h. Each spring's own flow comes after the other,
/// after the drift the other way round.
class SpringDamping : public SpringEffect {
 public:
  explicit SpringDamping(const Springs& springs) : SpringDamping(chainsOf(springs)) {}

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

  explicit SpringDamping(Chains chains)
      : SpringEffect(std::move(chains.springs)), ends_(std::move(chains.ends)) {}

  /// Half of the flow of a drift of h, chain by chain: none depends on which others there are.
  void flowAll(Bodies& bodies, const Instant& now, double h, Side side) const {
    std::size_t begin = 0;
    for (const std::size_t end : ends_) {
      flowChain(begin, end, bodies, now, h, side);
      begin = end;
    }
  }

  /// Dashpots that stop their ends at once and share a body would undo what the one before has
  /// done: in small parts, to and fro, they come to an agreement. With a single pass some chains
  /// gained energy without bound from springs beside them, see test/spring_chain_test.cpp.
  void flowChain(std::size_t begin, std::size_t end, Bodies& bodies, const Instant& now, double h,
                 Side side) const {
    const double drift_s = side == Side::kBefore ? h : -h;
    const bool must_agree = end - begin > 1 && areStiff(begin, end, bodies, now, 0.5 * h);
    const int passes = must_agree ? 8 : 1;
    for (int pass = 0; pass < passes; ++pass) {
      const bool is_forwards = must_agree ? pass % 2 == 0 : side == Side::kBefore;
      for (std::size_t k = 0; k < end - begin; ++k)
        flow(springs()[is_forwards ? begin + k : end - 1 - k], now, bodies, 0.5 * h / passes,
             drift_s);
    }
  }

  bool areStiff(std::size_t begin, std::size_t end, const Bodies& bodies, const Instant& now,
                double h) const {
    for (std::size_t k = begin; k < end; ++k) {
      const Spring& spring = springs()[k];
      const Line line = lineOf(spring, now);
      if (spring.actsAt(line.length) &&
          spring.damping * h * gripOf(spring, line, bodies).inverse_mass > 0.5)
        return true;
    }
    return false;
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

  std::vector<std::size_t> ends_;  // of the chains
};

}  // namespace

std::shared_ptr<const Effect> springDamping(const Springs& springs) {
  return std::make_shared<SpringDamping>(springs);
}

}  // namespace rigid_body_sim

#include "effects/spring.hpp"

#include "effects/makers.hpp"

namespace rigid_body_sim {
namespace {

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
  if (!damped.empty()) effects.push_back(springDamping(damped));
  return effects;
}

}  // namespace rigid_body_sim

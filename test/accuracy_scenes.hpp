#pragma once

// Ten scenes of different nature for accuracy budgets, whose forces the reference can follow in
// long double.

#include <algorithm>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "generic.hpp"
#include "reference/flight.hpp"

namespace rigid_body_sim {

template <class Scalar>
using Vector3 = Eigen::Matrix<Scalar, 3, 1>;

/// A body in flight, in double or long double.
template <class Scalar>
struct Moving {
  Vector3<Scalar> p;
  Eigen::Quaternion<Scalar> q;
  Vector3<Scalar> P, L;
};

template <class Scalar>
struct Pushed {
  Vector3<Scalar> f = Vector3<Scalar>::Zero();
  Vector3<Scalar> t = Vector3<Scalar>::Zero();
};

/// A torque in body axes that varies with time, as of thrusters in pairs.
struct VaryingTorque {
  Vector3d amplitude, rate;
  template <class S>
  Pushed<S> operator()(S time_s, const Moving<S>& body) const {
    const Vector3<S> phase = time_s * rate.cast<S>();
    return {Vector3<S>::Zero(),
            body.q * Vector3<S>(amplitude.cast<S>().array() * phase.array().cos())};
  }
};

/// On a circular orbit of the given rate: 3 n^2 r x I r (Hughes, Spacecraft Attitude Dynamics,
/// 1986, eq. 8.1.22).
struct GravityGradient {
  double rate;
  Vector3d I;
  template <class S>
  Pushed<S> operator()(S time_s, const Moving<S>& body) const {
    using std::cos;
    using std::sin;
    const S angle = S(rate) * time_s;
    const Vector3<S> r_B = body.q.conjugate() * Vector3<S>(cos(angle), sin(angle), S(0));
    const Vector3<S> Ir = I.cast<S>().cwiseProduct(r_B);
    return {Vector3<S>::Zero(), body.q * Vector3<S>(S(3 * rate * rate) * r_B.cross(Ir))};
  }
};

/// Proportional to the velocities.
struct Drag {
  double linear, angular, mass;
  Vector3d I;
  template <class S>
  Pushed<S> operator()(S, const Moving<S>& body) const {
    const Vector3<S> w_B = (body.q.conjugate() * body.L).cwiseQuotient(I.cast<S>());
    return {Vector3<S>(S(-linear / mass) * body.P), body.q * Vector3<S>(S(-angular) * w_B)};
  }
};

/// A constant force in body axes at a point of the body.
struct Thruster {
  Vector3d f_B, p_BcmQ_B;
  template <class S>
  Pushed<S> operator()(S, const Moving<S>& body) const {
    return {body.q * Vector3<S>(f_B.cast<S>()), body.q * Vector3<S>(p_BcmQ_B.cross(f_B).cast<S>())};
  }
};

/// A constant force in world axes at a point of the body.
struct Pendulum {
  Vector3d f_W, p_BcmQ_B;
  template <class S>
  Pushed<S> operator()(S, const Moving<S>& body) const {
    const Vector3<S> arm = body.q * Vector3<S>(p_BcmQ_B.cast<S>());
    return {f_W.cast<S>(), arm.cross(Vector3<S>(f_W.cast<S>()))};
  }
};

/// To the origin, harder with the distance.
struct Spring {
  double linear, cubic;
  template <class S>
  Pushed<S> operator()(S, const Moving<S>& body) const {
    return {Vector3<S>(-(S(linear) + S(cubic) * body.p.squaredNorm()) * body.p),
            Vector3<S>::Zero()};
  }
};

/// Laws of one kind, each on a body of its own.
template <class Law>
class LawEffect : public Effect {
 public:
  using Member = std::pair<Eigen::Index, Law>;
  LawEffect(std::vector<Member> members, bool depends_on_velocity)
      : members_(std::move(members)), depends_on_velocity_(depends_on_velocity) {}

  std::string name() const override { return "law"; }
  std::size_t bodyCount() const override { return members_.size(); }
  bool dependsOnVelocity() const override { return depends_on_velocity_; }

  void addWrenches(const Instant& now, Wrenches& wrenches) const override {
    for (const auto& [i, law] : members_) {
      const BodyState body = now.bodies().state(i);
      const Pushed<double> push =
          law(now.time_s(), Moving<double>{body.p_WBcm, body.q_WB, body.P_WB, body.L_WBcm_W});
      wrenches.f_W.row(i) += push.f;
      wrenches.t_Bcm_W.row(i) += push.t;
    }
  }

  std::shared_ptr<const Effect> restrictedTo(
      const std::vector<Eigen::Index>& bodies) const override {
    std::vector<Member> members;
    for (std::size_t k = 0; k < bodies.size(); ++k)
      for (const Member& member : members_)
        if (member.first == bodies[k])
          members.emplace_back(static_cast<Eigen::Index>(k), member.second);
    return std::make_shared<LawEffect>(std::move(members), depends_on_velocity_);
  }

 private:
  std::vector<Member> members_;
  bool depends_on_velocity_;
};

/// A scene, and for each body what the reference needs to follow it.
struct TrueScene {
  std::string name;
  Scene scene;
  std::vector<reference::PushLaw> laws;
  bool is_of_positions = false;  ///< the budget is one of metres, not radians

  Budget budget(double error) const {
    Budget budget;
    (is_of_positions ? budget.position_m : budget.attitude_rad) = error;
    budget.over_s = 60;
    return budget;
  }
};

template <class Law>
reference::PushLaw lawOf(const Law& law) {
  using Real = reference::Real;
  return [law](Real time_s, const reference::State& body) {
    const Pushed<Real> push =
        law(time_s, Moving<Real>{body.p_WBcm, body.q_WB, body.P_WB, body.L_WBcm_W});
    return reference::Push{push.f, push.t};
  };
}

inline SceneBody bodyOf(const std::string& name, const Vector3d& I, const Vector3d& w_WB_B) {
  SceneBody body;
  body.name = name;
  body.mass_properties.mass = 2;
  body.mass_properties.I_BBcm_F = I.asDiagonal();
  body.X_WL = genericPose();
  body.v_WBcm << 0.3, -0.2, 0.1;
  body.w_WB_L = w_WB_B;
  return body;
}

inline TrueScene freeScene(const std::string& name, const SceneBody& body) {
  return {name, sceneOf(body, "exact"), {reference::nothing}};
}

template <class Law>
TrueScene forcedScene(const std::string& name, const SceneBody& body, const Law& law,
                      bool depends_on_velocity = false) {
  TrueScene one = {name, sceneOf(body, "exact"), {lawOf(law)}};
  one.scene.effects.push_back(std::make_shared<LawEffect<Law>>(
      std::vector<std::pair<Eigen::Index, Law>>{{0, law}}, depends_on_velocity));
  return one;
}

/// Bodies of all shapes and spins; every other one pushed by a thruster of its own.
inline TrueScene swarmScene(int count) {
  TrueScene swarm;
  swarm.name = "swarm";
  Sampler sampler(7);
  std::vector<std::pair<Eigen::Index, Thruster>> thrusters;
  for (int i = 0; i < count; ++i) {
    const double a = sampler.between(0.2, 2), b = sampler.between(0.2, 2);
    const double c = std::abs(a - b) + sampler.between(0.1, 1) * 2 * std::min(a, b);
    SceneBody body = bodyOf("body_" + std::to_string(i), {a, b, c}, 4 * sampler.vector());
    body.X_WL.linear() = sampler.attitude().toRotationMatrix();
    swarm.scene.bodies.push_back(body);
    swarm.laws.push_back(reference::nothing);
    if (i % 2 == 1) continue;
    thrusters.emplace_back(i, Thruster{0.3 * sampler.vector(), 0.2 * sampler.vector()});
    swarm.laws.back() = lawOf(thrusters.back().second);
  }
  swarm.scene.integrator = "exact";
  swarm.scene.effects.push_back(std::make_shared<LawEffect<Thruster>>(thrusters, false));
  return swarm;
}

inline std::vector<TrueScene> tenScenes(int swarm_count = 200) {
  const Vector3d I(1, 1.5, 2.2), w(0.9, -1.3, 0.7);
  SceneBody dot = bodyOf("dot", Vector3d::Ones(), Vector3d::Zero());
  dot.is_point_mass = true;
  // Along the world's axes: elsewhere L itself holds the rod's spin no better than to 2e-10 rad/s.
  SceneBody rod = bodyOf("rod", {1e-6, 1, 1}, {10, 1, 2});
  rod.X_WL.linear().setIdentity();
  TrueScene point = forcedScene("point mass", dot, Spring{1.3, 0.2});
  point.is_of_positions = true;
  return {
      freeScene("free", bodyOf("stone", {1, 2, 3}, {0.1, 5, 0.1})),
      forcedScene("forced", bodyOf("craft", I, w),
                  VaryingTorque{{0.3, -0.2, 0.25}, {0.7, 1.1, 0.4}}),
      forcedScene("gravity gradient", bodyOf("satellite", I, 0.2 * w), GravityGradient{0.1, I}),
      forcedScene("drag", bodyOf("feather", I, 2 * w), Drag{0.1, 0.05, 2, I}, true),
      forcedScene("thruster", bodyOf("rocket", I, w), Thruster{{0.4, 0.1, -0.2}, {0.1, 0.3, 0.2}}),
      forcedScene("spinner", bodyOf("top", {0.01, 0.02, 0.03}, {50, 1, 80}),
                  VaryingTorque{{2e-3, 1e-3, -2e-3}, {0.7, 1.1, 0.4}}),
      forcedScene("sphere", bodyOf("ball", {1, 1, 1}, w),
                  Pendulum{{0.5, -0.3, 0.8}, {0.2, 0.4, 0}}),
      freeScene("rod", rod),
      point,
      swarmScene(swarm_count),
  };
}

/// One body of a scene as a scene.
inline Scene alone(const Scene& scene, Eigen::Index body) {
  Scene part = scene;
  part.bodies = {scene.bodies[body]};
  part.effects.clear();
  for (const auto& effect : scene.effects) {
    auto own = effect->restrictedTo({body});
    if (own->bodyCount() > 0) part.effects.push_back(own);
  }
  return part;
}

}  // namespace rigid_body_sim

#pragma once

// What the laws of the integrators share: bodies, pushes, and the parameter that runs over the
// registry.
#include <cmath>
#include <string>

#include "generic.hpp"
#include "reference/flight.hpp"
#include "rigid_body_sim/conserved.hpp"

namespace rigid_body_sim {

/// For gtest's messages.
inline void PrintTo(const IntegratorRow& row, std::ostream* out) { *out << row.name; }

/// A push on body 0 that the test can count.
class Push : public Effect {
 public:
  explicit Push(const AppliedWrench& applied) : applied_(applied) {}
  std::string name() const override { return "push"; }
  std::size_t bodyCount() const override { return 1; }
  void addWrenches(const Instant& now, Wrenches& wrenches) const override {
    ++evaluations;
    const Wrench wrench = inWorldAboutCom(applied_, now.bodies().state(0).q_WB);
    wrenches.f_W.row(0) += wrench.f_F;
    wrenches.t_Bcm_W.row(0) += wrench.t_Q_F;
  }

  mutable long evaluations = 0;

 private:
  AppliedWrench applied_;
};

/// A law of the reference as an effect on body 0.
class Obeying : public Effect {
 public:
  explicit Obeying(reference::PushLaw law) : law_(std::move(law)) {}
  std::string name() const override { return "law"; }
  std::size_t bodyCount() const override { return 1; }
  bool dependsOnVelocity() const override { return true; }  // or so it may be
  void addWrenches(const Instant& now, Wrenches& wrenches) const override {
    const reference::Push push = law_(now.time_s(), reference::extended(now.bodies().state(0)));
    wrenches.f_W.row(0) += push.f_W.cast<double>();
    wrenches.t_Bcm_W.row(0) += push.t_Bcm_W.cast<double>();
  }

 private:
  reference::PushLaw law_;
};

/// The same push as the reference sees it, from its definition and in long double.
inline reference::PushLaw lawOf(const AppliedWrench& applied) {
  using Vector = reference::Vector3r;
  const Vector f = applied.wrench.f_F.cast<reference::Real>();
  const Vector t = applied.wrench.t_Q_F.cast<reference::Real>();
  const Vector r = applied.p_BcmQ_B.cast<reference::Real>();
  const bool turns = applied.axes == Axes::kBody;
  return [=](reference::Real, const reference::State& body) {
    const Vector f_W = turns ? Vector(body.q_WB * f) : f;
    const Vector t_W = turns ? Vector(body.q_WB * t) : t;
    return reference::Push{f_W, t_W + Vector(body.q_WB * r).cross(f_W)};
  };
}

inline Bodies bodiesOf(const reference::Case& one) {
  Bodies bodies(1);
  bodies.mass << one.mass;
  bodies.I_BBcm_B.row(0) = one.I_BBcm_B;
  BodyState start;
  start.q_WB = genericAttitude();
  start.P_WB << 0.3, -0.8, 0.5;
  start.L_WBcm_W = start.q_WB * one.I_BBcm_B.cwiseProduct(one.w_WB_B);
  bodies.setState(0, start);
  return bodies;
}

inline double energy(const Bodies& bodies) {
  return kineticEnergy(bodies.state(0), bodies.mass(0), bodies.moments(0));
}

/// All that can differ between two states, each part in its own unit.
inline double distance(const BodyState& a, const BodyState& b) {
  return angleBetween(a.q_WB, b.q_WB) + (a.p_WBcm - b.p_WBcm).norm() + (a.P_WB - b.P_WB).norm() +
         (a.L_WBcm_W - b.L_WBcm_W).norm();
}

class IntegratorLaws : public testing::TestWithParam<IntegratorRow> {
 protected:
  std::unique_ptr<Integrator> make(Gyroscopic gyroscopic = Gyroscopic::kOn) const {
    return GetParam().make({gyroscopic == Gyroscopic::kOn ? std::vector<Eigen::Index>()
                                                          : std::vector<Eigen::Index>{0}});
  }

  BodyState run(const reference::Case& one, const Effect* effect, double time_s, int steps) const {
    Bodies bodies = bodiesOf(one);
    ActiveEffects effects;
    if (effect) effects.add(effect);
    const auto integrator = make();
    const double h = time_s / steps;
    for (int i = 0; i < steps; ++i) integrator->step(bodies, effects, i * h, h);
    return bodies.state(0);
  }

  /// Attitude error [rad] that rounding may leave after steps of 0.02 s at a constant rate: kEps a
  /// step where L is kept. A method that goes from velocities to L and back each step loses up to
  /// two kEps of the rate, and every later step turns by that much less; measured: 0.7 of the
  /// bound.
  double steadyTurnRounding(int steps, const Vector3d& w_WB_B) const {
    const double own = 2 * steps * kEps;
    if (GetParam().keeps_angular_momentum) return own;
    return own + steps * 0.5 * steps * 0.02 * w_WB_B.norm() * 2 * kEps;
  }
};

/// Every row of the registry, by its name.
inline std::string nameOfRow(const testing::TestParamInfo<IntegratorRow>& info) {
  return info.param.name;
}

}  // namespace rigid_body_sim

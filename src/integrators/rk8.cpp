#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "integrators/body_momentum.hpp"
#include "integrators/dop853.hpp"
#include "integrators/families.hpp"
#include "integrators/ungyroscopic.hpp"

namespace rigid_body_sim {
namespace {

/// Rates of one body, or sums of them: attitude (x, y, z, w), momentum in body axes, then velocity
/// and force in the world. Each part is filled up to four numbers.
constexpr int kAttitude = 0, kMomentum = 4, kVelocity = 8, kForce = 12;
constexpr int kFree = 8;  // of a body on which nothing acts, only the first two parts
constexpr int kForced = 16;

template <int size>
using Rates = Eigen::Array<double, size, 1>;
template <int size>
using Stages = std::array<Rates<size>, Dop853::kStages>;

template <int size>
Rates<size> sum(const Stages<size>& k, const Dop853::Weight* first, const Dop853::Weight* last) {
  Rates<size> result = Rates<size>::Zero();
  for (; first != last; ++first) result += first->value * k[static_cast<std::size_t>(first->stage)];
  return result;
}

template <int size, class Weights>
Rates<size> sum(const Stages<size>& k, const Weights& weights) {
  return sum(k, weights.data(), weights.data() + weights.size());
}

/// What stage s adds to the state at the beginning, a step long.
template <int size>
Rates<size> stageSum(const Stages<size>& k, int s) {
  return sum(k, Dop853::a.data() + Dop853::first[s], Dop853::a.data() + Dop853::first[s + 1]);
}

/// A body at the beginning of a step or at a stage.
struct Moment {
  BodyState state;
  Vector3d m_B;  ///< angular momentum in body axes
};

Moment startOf(const Bodies& bodies, Eigen::Index i) {
  const BodyState state = bodies.state(i);
  return {state, state.q_WB.conjugate() * state.L_WBcm_W};
}

/// The first two parts of the rates, at an attitude that need not be of unit length.
template <int size>
void setRotationRates(Gyroscopic gyroscopic, Rates<size>& rates, const Eigen::Vector4d& q,
                      const Vector3d& m_B, const Vector3d& I, const Vector3d& t_B) {
  const Vector3d w_B = m_B.cwiseQuotient(I);
  const Quaterniond half_w(0, 0.5 * w_B.x(), 0.5 * w_B.y(), 0.5 * w_B.z());
  rates.template segment<4>(kAttitude) = (Quaterniond(q) * half_w).coeffs();
  rates.template segment<3>(kMomentum) = momentumRate(gyroscopic, m_B, w_B, t_B);
  rates(kMomentum + 3) = 0;
}

template <int size>
void endRotation(Gyroscopic gyroscopic, BodyState& body, const Moment& start,
                 const Rates<size>& step, const Vector3d& dL_W) {
  const Vector3d dm_B = step.template segment<3>(kMomentum);
  const Eigen::Vector4d dq = step.template segment<4>(kAttitude);
  setRotation(gyroscopic, body, Quaterniond(Eigen::Vector4d(start.state.q_WB.coeffs() + dq)),
              start.m_B + dm_B, start.state.L_WBcm_W + dL_W);
}

/// Size of `part`, three or four numbers of `error`, relative to `scale`; zero of zero is zero.
template <int count, int size>
double relative(const Rates<size>& error, int part, double scale) {
  const double length = error.matrix().template segment<count>(part).norm();
  return length == 0 ? 0 : length / scale;
}

/// Dormand and Prince's method on attitude, momentum in body axes, position and momentum.
class DormandPrince {
 public:
  explicit DormandPrince(const IntegratorOptions& options) : ungyroscopic_(options.ungyroscopic) {}

  /// One step of h [s] from time_s.
  void step(Bodies& bodies, ActiveEffects& effects, double time_s, double h) {
    if (effects.empty()) {
      for (Eigen::Index i = 0; i < bodies.count(); ++i) stepFree(bodies, i, h);
      return;
    }
    tryStep(bodies, effects, time_s, h);
    take(bodies, h);
    effects.stepTaken();
  }

  /// Works out a step without taking it.
  void tryStep(const Bodies& bodies, ActiveEffects& effects, double time_s, double h) {
    starts_.resize(static_cast<std::size_t>(bodies.count()));
    stages_.resize(starts_.size());
    torques_.resize(starts_.size());
    stage_.resize(starts_.size());
    for (Eigen::Index i = 0; i < bodies.count(); ++i) stage_[i] = starts_[i] = startOf(bodies, i);
    stage_bodies_ = bodies;
    for (int s = 0; s < Dop853::kStages; ++s) {
      if (s > 0)
        for (Eigen::Index i = 0; i < bodies.count(); ++i) beginStage(i, s, h);
      const Wrenches& wrenches =
          effects.evaluate(stage_bodies_, time_s + Dop853::c[s] * h, weightOf(s) * h);
      const Column3& v_WBcm = effects.instant().v_WBcm();
      for (Eigen::Index i = 0; i < bodies.count(); ++i)
        finishStage(i, s, v_WBcm.row(i), {wrenches.f_W.row(i), wrenches.t_Bcm_W.row(i)});
    }
  }

  /// Estimated error of the step tried last, the worst of all bodies: of the attitude [rad], of
  /// momenta relative to themselves, of the position relative to its distance from the origin or
  /// the way of the step.
  double error(double h) const {
    double worst = 0;
    for (std::size_t i = 0; i < starts_.size(); ++i) {
      const double one = estimate(static_cast<Eigen::Index>(i), h);
      if (std::isnan(one)) return one;
      worst = std::max(worst, one);
    }
    return worst;
  }

  /// Takes the step tried last.
  void take(Bodies& bodies, double h) const {
    for (Eigen::Index i = 0; i < bodies.count(); ++i) {
      const Rates<kForced> step = h * sum(stages_[i], Dop853::b);
      BodyState body = starts_[i].state;
      move(body, step.matrix().segment<3>(kVelocity));
      body.P_WB += step.matrix().segment<3>(kForce);
      Vector3d dL_W = Vector3d::Zero();
      for (const Dop853::Weight& b : Dop853::b) dL_W += (h * b.value) * torques_[i][b.stage];
      if (!starts_[i].m_B.isZero(0) || !dL_W.isZero(0) || !step.segment<4>(kMomentum).isZero(0))
        endRotation(ungyroscopic_.of(i), body, starts_[i], step, dL_W);
      bodies.setState(i, body);
    }
  }

 private:
  /// Of stage s in the step.
  static double weightOf(int s) {
    for (const Dop853::Weight& b : Dop853::b)
      if (b.stage == s) return b.value;
    return 0;
  }

  void stepFree(Bodies& bodies, Eigen::Index i, double h) const {
    const Moment start = startOf(bodies, i);
    BodyState body = start.state;
    move(body, (h / bodies.mass(i)) * body.P_WB);
    if (!start.m_B.isZero(0)) {
      const Vector3d I = bodies.moments(i);
      Stages<kFree> k;
      for (int s = 0; s < Dop853::kStages; ++s) {
        const Rates<kFree> so_far = h * stageSum(k, s);
        const Eigen::Vector4d q = start.state.q_WB.coeffs() + so_far.matrix().segment<4>(kAttitude);
        const Vector3d m_B = start.m_B + so_far.matrix().segment<3>(kMomentum);
        setRotationRates(ungyroscopic_.of(i), k[s], q, m_B, I, Vector3d::Zero());
      }
      endRotation(ungyroscopic_.of(i), body, start, Rates<kFree>(h * sum(k, Dop853::b)),
                  Vector3d::Zero());
    }
    bodies.setState(i, body);
  }

  /// The state at which the effects of stage s are evaluated.
  void beginStage(Eigen::Index i, int s, double h) {
    const Rates<kForced> so_far = h * stageSum(stages_[i], s);
    const Moment& start = starts_[i];
    BodyState& at = stage_[i].state;
    at.p_WBcm = start.state.p_WBcm + so_far.matrix().segment<3>(kVelocity);
    at.P_WB = start.state.P_WB + so_far.matrix().segment<3>(kForce);
    // Stages are only near unit length, and nearer after this.
    at.q_WB = renormalized(Quaterniond(
        Eigen::Vector4d(start.state.q_WB.coeffs() + so_far.matrix().segment<4>(kAttitude))));
    stage_[i].m_B = start.m_B + so_far.matrix().segment<3>(kMomentum);
    at.L_WBcm_W = at.q_WB * stage_[i].m_B;
    stage_bodies_.setState(i, at);
  }

  void finishStage(Eigen::Index i, int s, const Vector3d& v_WBcm, const Wrench& wrench) {
    const BodyState& at = stage_[i].state;
    Rates<kForced>& k = stages_[i][s];
    setRotationRates(ungyroscopic_.of(i), k, at.q_WB.coeffs(), stage_[i].m_B,
                     stage_bodies_.moments(i), at.q_WB.conjugate() * wrench.t_Q_F);
    torques_[i][s] = wrench.t_Q_F;
    k.matrix().segment<3>(kVelocity) = v_WBcm;
    k(kVelocity + 3) = k(kForce + 3) = 0;
    k.matrix().segment<3>(kForce) = wrench.f_F;
  }

  /// From the estimates of order 5 and 3 (Hairer, Norsett and Wanner, II.10).
  double estimate(Eigen::Index i, double h) const {
    const Stages<kForced>& k = stages_[i];
    const Rates<kForced> step = h * sum(k, Dop853::b);
    const auto size = [&](const Rates<kForced>& e) {
      const auto scale = [&](const Vector3d& start, int part) {
        const Vector3d change = step.matrix().segment<3>(part);
        return std::max(start.norm(), change.norm());
      };
      const BodyState& start = starts_[i].state;
      const Eigen::Array4d parts(2 * relative<4>(e, kAttitude, 1),
                                 relative<3>(e, kMomentum, scale(starts_[i].m_B, kMomentum)),
                                 relative<3>(e, kVelocity, scale(start.p_WBcm, kVelocity)),
                                 relative<3>(e, kForce, scale(start.P_WB, kForce)));
      return parts.isNaN().any() ? std::numeric_limits<double>::quiet_NaN() : parts.maxCoeff();
    };
    const double e5 = size(h * sum(k, Dop853::e5));
    const double e3 = size(h * sum(k, Dop853::e3));
    return e5 == 0 ? 0 : e5 * e5 / std::sqrt(e5 * e5 + 0.01 * e3 * e3);
  }

  Ungyroscopic ungyroscopic_;
  Bodies stage_bodies_;
  std::vector<Moment> starts_;
  std::vector<Moment> stage_;  // the bodies at the present stage, as in stage_bodies_
  std::vector<Stages<kForced>> stages_;
  std::vector<std::array<Vector3d, Dop853::kStages>> torques_;  // in the world
};

class Rk8 : public Integrator {
 public:
  explicit Rk8(const IntegratorOptions& options) : method_(options) {}

  void step(Bodies& bodies, ActiveEffects& effects, double time_s, double h) override {
    method_.step(bodies, effects, time_s, h);
  }

 private:
  DormandPrince method_;
};

/// As many steps as the estimated error wants, the same for all bodies. They do not depend on those
/// of earlier ticks, so that the same state gives the same bits.
class Adaptive : public Integrator {
 public:
  explicit Adaptive(const IntegratorOptions& options)
      : method_(options), tolerance_(options.tolerance) {}

  void step(Bodies& bodies, ActiveEffects& effects, double time_s, double h) override {
    const double least = kLeast * std::abs(h);
    double done = 0;
    double next = firstStep(bodies, h);
    while (true) {
      const bool is_last = std::abs(next) >= std::abs(h - done) * (1 - 1e-9);
      const double dt = is_last ? h - done : next;
      method_.tryStep(bodies, effects, time_s + done, dt);
      const double error = method_.error(dt);
      const bool is_least = std::abs(dt) <= least * (1 + 1e-6);  // the last is rounded
      // Rounding is no reason to go on halving.
      const double allowed = std::max(tolerance_ * std::abs(dt), kRounding);
      if (std::isnan(error) && is_least)
        return takeAsItIs(bodies, effects, time_s + done, h - done);
      if (error <= allowed || is_least) {
        method_.take(bodies, dt);
        effects.stepTaken();
        if (is_last) return;
        done += dt;
      } else {
        effects.stepGivenUp();
      }
      const double factor = error == 0 ? 5 : 0.9 * std::pow(allowed / error, 1.0 / 8);
      const double wanted =
          std::abs(dt) * (std::isnan(factor) ? 0.2 : std::clamp(factor, 0.2, 5.0));
      next = std::copysign(std::max(wanted, least), h);
    }
  }

 private:
  static constexpr double kRounding = 4 * std::numeric_limits<double>::epsilon();
  /// Of the whole step, however stiff. A thousand steps of 0.2 rad keep any tolerance: hence the
  /// registry's 200 rad, of turns and swings. At 300 a tumbling plate loses 1e-10 of its energy a
  /// tick, at 2000 it is lost. And a thousand steps bear 6.38 of a decay each, as rk8 does.
  static constexpr double kLeast = 1e-3;

  /// What is left of the step, under wrenches that are no numbers: no smaller step would help.
  void takeAsItIs(Bodies& bodies, ActiveEffects& effects, double time_s, double h) {
    effects.stepGivenUp();
    method_.tryStep(bodies, effects, time_s, h);
    method_.take(bodies, h);
    effects.stepTaken();
  }

  /// A fifth of a radian of the fastest body.
  static double firstStep(const Bodies& bodies, double h) {
    double rate = 0;
    for (Eigen::Index i = 0; i < bodies.count(); ++i)
      rate = std::max(rate, angularVelocityInBody(bodies.state(i), bodies.moments(i)).norm());
    if (!(rate * std::abs(h) > 0.2)) return h;
    return std::copysign(std::max(0.2 / rate, kLeast * std::abs(h)), h);
  }

  DormandPrince method_;
  double tolerance_;
};

}  // namespace

std::unique_ptr<Integrator> makeRk8(const IntegratorOptions& options) {
  return std::make_unique<Rk8>(options);
}

std::unique_ptr<Integrator> makeAdaptive(const IntegratorOptions& options) {
  return std::make_unique<Adaptive>(options);
}

}  // namespace rigid_body_sim

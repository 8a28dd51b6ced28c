#include <vector>

#include "integrators/coasting.hpp"
#include "integrators/drift.hpp"
#include "integrators/exact_rotation.hpp"
#include "integrators/families.hpp"
#include "integrators/kick.hpp"

namespace rigid_body_sim {
namespace {

/// A symmetric sequence kick - drift - kick - ... - drift - kick; each number is a fraction of the
/// step, one more kick than drifts. Time goes on in the drifts.
struct Composition {
  std::vector<double> kicks;
  std::vector<double> drifts;
};

/// The whole sequence from its first half; the middle one of the drifts or kicks stands once.
Composition mirrored(std::vector<double> kicks, std::vector<double> drifts) {
  const bool middle_is_kick = kicks.size() > drifts.size();
  const auto append = [](std::vector<double>& list, bool has_middle) {
    const std::vector<double> first = list;
    list.insert(list.end(), first.rbegin() + (has_middle ? 1 : 0), first.rend());
  };
  append(kicks, middle_is_kick);
  append(drifts, !middle_is_kick);
  return {std::move(kicks), std::move(drifts)};
}

Composition strang() { return {{0.5, 0.5}, {1}}; }

/// S. Blanes and P.C. Moan, J. Comput. Appl. Math. 142 (2002) 313, Runge-Kutta-Nystroem methods
/// SRKN_6^b of order 4 and SRKN_11^b of order 6. They want [V, [V, [V, T]]] = 0: here, as T is
/// quadratic in the momenta.
Composition blanesMoan4() {
  constexpr double b1 = 0.0829844064174052, b2 = 0.396309801498368, b3 = -0.0390563049223486;
  constexpr double a1 = 0.245298957184271, a2 = 0.604872665711080;
  return mirrored({b1, b2, b3, 1 - 2 * (b1 + b2 + b3)}, {a1, a2, 0.5 - (a1 + a2)});
}

Composition blanesMoan6() {
  constexpr double b1 = 0.0414649985182624, b2 = 0.198128671918067, b3 = -0.0400061921041533,
                   b4 = 0.0752539843015807, b5 = -0.0115113874206879;
  constexpr double a1 = 0.123229775946271, a2 = 0.290553797799558, a3 = -0.127049212625417,
                   a4 = -0.246331761062075, a5 = 0.357208872795928;
  return mirrored({b1, b2, b3, b4, b5, 0.5 - (b1 + b2 + b3 + b4 + b5)},
                  {a1, a2, a3, a4, a5, 1 - 2 * (a1 + a2 + a3 + a4 + a5)});
}

/// m = R^T L, rounded once: a thin rod's own spin is a small difference in it.
Vector3d momentumInBody(const Quaterniond& q_WB, const Vector3d& L_W) {
  using Real = long double;
  const Eigen::Quaternion<Real> q = q_WB.cast<Real>().normalized();
  return (q.conjugate() * L_W.cast<Real>()).cast<double>();
}

/// What the method remembers of a body between steps, besides its state. It holds as long as
/// attitude and angular momentum are those that it left behind; whoever changes them need not know.
struct Spin {
  Quaterniond q_WB;
  Vector3d L_W;
  /// In body axes. Kept along, not made of L again: R^T L would lose the own spin of a thin rod.
  /// Not up to date while coasting.
  Vector3d m_B;
  InverseMoments a;
  double drift_s = 0;        ///< the latest drift, if nothing turned the momentum since
  bool is_coasting = false;  ///< `coasting` holds
  Coasting coasting = {};
};

/// Kicks and exact free flight between them.
template <Gyroscopic gyroscopic>
class Exact : public Integrator {
 public:
  Exact(const IntegratorOptions& options, Composition composition)
      : ungyroscopic_(options.ungyroscopic), composition_(std::move(composition)) {}

  void step(Bodies& bodies, ActiveEffects& effects, double time_s, double h) override {
    recall(bodies);
    if (effects.empty()) return drift(bodies, h);
    double t = time_s;
    for (std::size_t i = 0; i < composition_.kicks.size(); ++i) {
      if (effects.hasKicks()) {
        const double kick_s = composition_.kicks[i] * h;
        kick(bodies, effects.evaluateKicks(bodies, t, kick_s), kick_s);
      }
      if (i == composition_.drifts.size()) break;
      const double drift_s = composition_.drifts[i] * h;
      driftUnderFlows(bodies, effects, t, drift_s);
      t += drift_s;
    }
  }

 private:
  void driftUnderFlows(Bodies& bodies, ActiveEffects& effects, double time_s, double h) {
    if (!effects.hasFlows()) return drift(bodies, h);
    effects.beforeDrift(bodies, time_s, h);
    recall(bodies);
    drift(bodies, h);
    effects.afterDrift(bodies, time_s, h);
    recall(bodies);
  }

  /// Takes up the bodies that somebody else has moved.
  void recall(const Bodies& bodies) {
    const auto known = static_cast<Eigen::Index>(spins_.size());
    for (Eigen::Index i = 0; i < bodies.count(); ++i) {
      if (i < known && isKnown(spins_[i], bodies, i)) continue;
      if (i < known)
        spins_[i] = spinOf(bodies, i);
      else
        spins_.push_back(spinOf(bodies, i));
    }
  }

  static Spin spinOf(const Bodies& bodies, Eigen::Index i) {
    const Quaterniond q_WB(Eigen::Vector4d(bodies.q_WB.row(i)));
    const Vector3d L_W = bodies.L_WBcm_W.row(i);
    return {q_WB, L_W, momentumInBody(q_WB, L_W), InverseMoments(bodies.moments(i))};
  }

  static bool isKnown(const Spin& spin, const Bodies& bodies, Eigen::Index i) {
    const auto& q = bodies.q_WB;
    const auto& L = bodies.L_WBcm_W;
    return spin.q_WB.x() == q(i, 0) && spin.q_WB.y() == q(i, 1) && spin.q_WB.z() == q(i, 2) &&
           spin.q_WB.w() == q(i, 3) && spin.L_W.x() == L(i, 0) && spin.L_W.y() == L(i, 1) &&
           spin.L_W.z() == L(i, 2);
  }

  void kick(Bodies& bodies, const Wrenches& wrenches, double h) {
    bodies.P_WB += h * wrenches.f_W;
    for (Eigen::Index i = 0; i < bodies.count(); ++i) {
      const Vector3d t_W = wrenches.t_Bcm_W.row(i);
      if (t_W.isZero(0)) continue;
      Spin& spin = spins_[i];
      if (spin.is_coasting) spin.m_B = spin.coasting.m_B();
      spin.is_coasting = false;
      spin.drift_s = 0;
      spin.L_W += h * t_W;
      spin.m_B += spin.q_WB.conjugate() * (h * t_W);
      bodies.L_WBcm_W.row(i) = spin.L_W;
    }
  }

  void drift(Bodies& bodies, double h) {
    for (Eigen::Index i = 0; i < bodies.count(); ++i) {
      const double s = h / bodies.mass(i);
      for (int k = 0; k < 3; ++k) bodies.p_WBcm(i, k) += s * bodies.P_WB(i, k);
      Spin& spin = spins_[i];
      // Without spin, as a point mass always is, there is no rotation to compute.
      if (spin.L_W.isZero(0)) continue;
      if (ungyroscopic_.has(i)) {
        turnAtConstantRate(bodies, i, h);
        continue;
      }
      if (spin.drift_s != h)
        rotate(spin, bodies.moments(i), h);
      else if (spin.is_coasting)
        spin.coasting.step(spin.q_WB);
      else
        beginToCoast(spin, bodies.moments(i), h);
      bodies.q_WB(i, 0) = spin.q_WB.x();
      bodies.q_WB(i, 1) = spin.q_WB.y();
      bodies.q_WB(i, 2) = spin.q_WB.z();
      bodies.q_WB(i, 3) = spin.q_WB.w();
    }
  }

  void turnAtConstantRate(Bodies& bodies, Eigen::Index i, double h) {
    BodyState body = bodies.state(i);
    freeSpinWithoutGyroscopicTerm(body, bodies.moments(i), h);
    bodies.setState(i, body);
    spins_[i] = spinOf(bodies, i);
  }

  static void rotate(Spin& spin, const Vector3d& I, double h) {
    if (spin.is_coasting) spin.m_B = spin.coasting.m_B();
    spin.is_coasting = false;
    spin.drift_s = h;
    const FreeRotation free = exactRotation(spin.m_B, I, spin.a, h);
    spin.q_WB = renormalized(spin.q_WB * free.q_BBnext);
    spin.m_B = free.m_B;
    align(spin);
  }

  /// The second equal drift in a row without torque.
  static void beginToCoast(Spin& spin, const Vector3d& I, double h) {
    spin.coasting = Coasting(spin.q_WB, spin.m_B, I, h);
    spin.is_coasting = true;
    spin.coasting.step(spin.q_WB);
  }

  /// R m and L wander apart by roundings; the shortest turn of the body puts them together again.
  /// Where they are further apart than a walk of roundings can be, L has shrunk to what they were
  /// of a larger one: then it is m that is made anew, and the body does not turn.
  static void align(Spin& spin) {
    const Vector3d L_W = spin.q_WB * spin.m_B;
    const double size2 = spin.L_W.squaredNorm();
    const double off2 = (L_W - spin.L_W).squaredNorm();
    if (off2 <= 1e-28 * size2) return;
    if (off2 > 1e-24 * size2) {
      spin.m_B = momentumInBody(spin.q_WB, spin.L_W);
      return;
    }
    const Vector3d half = (0.5 / size2) * L_W.cross(spin.L_W);
    spin.q_WB = renormalized(Quaterniond(1, half.x(), half.y(), half.z()) * spin.q_WB);
  }

  Ungyroscopic<gyroscopic> ungyroscopic_;
  Composition composition_;
  std::vector<Spin> spins_;
};

std::unique_ptr<Integrator> make(Composition composition, const IntegratorOptions& options) {
  return makeFor<Exact>(options, std::move(composition));
}

}  // namespace

std::unique_ptr<Integrator> makeExact(const IntegratorOptions& options) {
  return make(strang(), options);
}

std::unique_ptr<Integrator> makeExact4(const IntegratorOptions& options) {
  return make(blanesMoan4(), options);
}

std::unique_ptr<Integrator> makeExact6(const IntegratorOptions& options) {
  return make(blanesMoan6(), options);
}

}  // namespace rigid_body_sim

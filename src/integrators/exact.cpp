#include <vector>

#include "integrators/columns.hpp"
#include "integrators/families.hpp"
#include "integrators/ungyroscopic.hpp"

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

/// Kicks and exact free flight between them. What it remembers of a body between steps, see
/// batch/spins.hpp, holds as long as attitude and angular momentum are those that it left behind;
/// whoever changes them need not know.
class Exact : public Integrator {
 public:
  Exact(const IntegratorOptions& options, Composition composition)
      : ungyroscopic_(options.ungyroscopic), composition_(std::move(composition)) {}

  void step(Bodies& bodies, ActiveEffects& effects, double time_s, double h) override {
    spins_.resize(bodies.count());
    if (effects.empty()) return drift(bodies, h);
    if (effects.areSteady())
      return stepSteadily(bodies, effects.evaluateSteady(bodies, time_s, kickCount()), h);
    double t = time_s;
    for (std::size_t i = 0; i < composition_.kicks.size(); ++i) {
      const double kick_s = composition_.kicks[i] * h;
      const Wrenches* wrenches =
          effects.hasKicks() ? &effects.evaluateKicks(bodies, t, kick_s) : nullptr;
      if (i == composition_.drifts.size()) {
        if (wrenches) kick(bodies, *wrenches, kick_s);
        break;
      }
      const double drift_s = composition_.drifts[i] * h;
      if (wrenches && !effects.hasFlows()) {
        fly(bodies, *wrenches, kick_s, drift_s, 0);
      } else {
        if (wrenches) kick(bodies, *wrenches, kick_s);
        driftUnderFlows(bodies, effects, t, drift_s);
      }
      t += drift_s;
    }
  }

 private:
  unsigned kickCount() const { return static_cast<unsigned>(composition_.kicks.size()); }

  /// Under wrenches that stay the same.
  void stepSteadily(Bodies& bodies, const Wrenches& wrenches, double h) {
    const std::size_t last = composition_.drifts.size() - 1;
    for (std::size_t i = 0; i <= last; ++i)
      fly(bodies, wrenches, composition_.kicks[i] * h, composition_.drifts[i] * h,
          i == last ? composition_.kicks[i + 1] * h : 0);
  }

  /// A kick, a drift and perhaps another kick.
  void fly(Bodies& bodies, const Wrenches& by, double before_s, double h, double after_s) {
    const batch::BodyColumns columns = columnsOf(bodies);
    const batch::WrenchColumns wrenches = columnsOf(by);
    ungyroscopic_.forRuns(bodies.count(), [&](batch::Range range, Gyroscopic gyroscopic) {
      if (gyroscopic == Gyroscopic::kOn)
        return kernels_.flySpins(columns, wrenches, spins_.data(), before_s, h, after_s, range);
      kernels_.kickSpins(columns, wrenches, spins_.data(), before_s, range);
      kernels_.driftWithoutGyroscopicTerm(columns, h, range);
      if (after_s != 0) kernels_.kickSpins(columns, wrenches, spins_.data(), after_s, range);
    });
  }

  void kick(Bodies& bodies, const Wrenches& wrenches, double kick_s) {
    kernels_.kickSpins(columnsOf(bodies), columnsOf(wrenches), spins_.data(), kick_s,
                       allOf(bodies));
  }

  void driftUnderFlows(Bodies& bodies, ActiveEffects& effects, double time_s, double h) {
    if (!effects.hasFlows()) return drift(bodies, h);
    effects.beforeDrift(bodies, time_s, h);
    drift(bodies, h);
    effects.afterDrift(bodies, time_s, h);
  }

  void drift(Bodies& bodies, double h) {
    const batch::BodyColumns columns = columnsOf(bodies);
    ungyroscopic_.forRuns(bodies.count(), [&](batch::Range range, Gyroscopic gyroscopic) {
      if (gyroscopic == Gyroscopic::kOn)
        return kernels_.driftSpins(columns, spins_.data(), h, range);
      kernels_.driftWithoutGyroscopicTerm(columns, h, range);
    });
  }

  const batch::Kernels& kernels_ = batch::kernels();
  Ungyroscopic ungyroscopic_;
  Composition composition_;
  Tiles spins_{batch::kSpinNumbers};
};

std::unique_ptr<Integrator> make(Composition composition, const IntegratorOptions& options) {
  return std::make_unique<Exact>(options, std::move(composition));
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

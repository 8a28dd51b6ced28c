#include <stdexcept>

#include "integrators/families.hpp"

namespace rigid_body_sim {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();

/// Kick and drift under a pendulum's torque is the standard map, whose energy has no bound from
/// (frequency x step)^2 = 0.9716 on (J.M. Greene, J. Math. Phys. 20 (1979) 1183); of a body with
/// three moments that spins besides, from some 0.8 on.
constexpr double kLargeSwing = 0.5;

/// A linear one is bounded below 2, and at 2 drifts off.
constexpr double kSwing = 1.99;

}  // namespace

const std::vector<IntegratorRow>& integrators() {
  static const std::vector<IntegratorRow> rows = {
      {"explicit_euler_velocity", 1, 1, true, false, false, false, false, kInf, 0.05, 0.05, 2, 1,
       1.75, 1.7, true,
       "explicit Euler on (v, w), the founding text's first method; a tumbling body loses energy "
       "until it spins about one axis",
       makeExplicitEulerVelocity},
      {"semi_implicit_velocity", 1, 1, true, false, false, false, false, kInf, kSwing, kLargeSwing,
       2, 1, 2.2, 2.1, true,
       "semi-implicit Euler on (v, w), as most engines step; unstable with the gyroscopic term",
       makeSemiImplicitVelocity},
      {"semi_implicit_newton", 1, 1, true, false, false, false, false, kInf, kSwing, kLargeSwing, 2,
       1, 2.6, 2.6, true,
       "semi-implicit Euler on (v, w), the gyroscopic term by one implicit Newton step, as game "
       "engines do; never infinite, but energy and angular momentum decay",
       makeSemiImplicitNewton},
      {"explicit_euler", 1, 1, true, false, true, false, false, kInf, 0.05, 0.05, 2, 1, 1.0, 1.2,
       true,
       "explicit Euler on (P, L): moves with the old momenta; energy stays below |L|^2 / 2 I1",
       makeExplicitEuler},
      {"semi_implicit", 1, 1, true, false, true, false, false, kInf, kSwing, kLargeSwing, 2, 1, 1.0,
       1.1, true,
       "semi-implicit Euler on (P, L): moves with the new momenta; the yardstick of cost",
       makeSemiImplicit},
      {"split2", 2, 1, true, false, true, true, true, kInf, kSwing, kLargeSwing, 4, 2, 2.2, 2.2,
       true, "kick - exact-rotations drift - kick on (P, L); never touches L in free flight",
       makeSplit2},
      {"rk4", 4, 4, false, false, true, false, false, 1, 2.82, 2.5, 2.78, 4, 2.2, 4.7, false,
       "classical Runge-Kutta on momentum in body axes, Runge-Kutta-Munthe-Kaas on attitude; any "
       "smooth wrench",
       makeRk4},
      {"rk8", 8, 8, false, false, true, false, false, 2, 5.95, 1, 6.38, 12, 10.7, 19, false,
       "Dormand and Prince's eighth order on momentum in body axes and quaternion; any smooth "
       "wrench",
       makeRk8},
      {"exact", 2, 1, true, true, true, true, true, kInf, kSwing, kLargeSwing, 4, 2, 1.1, 3.4, true,
       "kick - exact free rotation (Jacobi's elliptic functions) - kick; right to rounding at any "
       "step without torque",
       makeExact},
      {"exact4", 4, 0, true, true, true, true, true, kInf, 3.1, 1, 0, 7, 1.1, 19, false,
       "six exact free rotations between seven kicks (Blanes and Moan); any spin", makeExact4},
      {"exact6", 6, 0, true, true, true, true, true, kInf, 3.1, 2, 0, 12, 1.1, 34, false,
       "eleven exact free rotations between twelve kicks (Blanes and Moan); any spin", makeExact6},
      {"adaptive", 0, 0, false, false, true, false, false, 200, 200, 200, 6000, 0, 51, 51, false,
       "rk8 in as many steps as `tolerance` wants, a thousand a tick at most; the reference",
       makeAdaptive},
  };
  return rows;
}

const IntegratorRow& integratorNamed(const std::string& name) {
  std::string known;
  for (const IntegratorRow& row : integrators()) {
    if (row.name == name) return row;
    known += (known.empty() ? "" : ", ") + row.name;
  }
  throw std::invalid_argument("'" + name + "' is not an integrator; there are " + known);
}

}  // namespace rigid_body_sim

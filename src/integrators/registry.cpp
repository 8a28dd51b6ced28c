#include <stdexcept>

#include "integrators/families.hpp"

namespace rigid_body_sim {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();

}  // namespace

const std::vector<IntegratorRow>& integrators() {
  static const std::vector<IntegratorRow> rows = {
      {"explicit_euler_velocity", 1, 1, false, false, false, false, kInf, 1, 1.3, 1.3,
       "explicit Euler on (v, w), the founding text's first method; a tumbling body loses energy "
       "until it spins about one axis",
       makeExplicitEulerVelocity},
      {"semi_implicit_velocity", 1, 1, false, false, false, false, kInf, 1, 1.3, 1.3,
       "semi-implicit Euler on (v, w), as most engines step; unstable with the gyroscopic term",
       makeSemiImplicitVelocity},
      {"split2", 2, 1, false, true, true, true, kInf, 2, 1.8, 1.8,
       "kick - exact-rotations drift - kick on (P, L); never touches L in free flight", makeSplit2},
      {"exact", 2, 1, true, true, true, true, kInf, 2, 0.7, 2.2,
       "kick - exact free rotation (Jacobi's elliptic functions) - kick; right to rounding at any "
       "step without torque",
       makeExact},
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

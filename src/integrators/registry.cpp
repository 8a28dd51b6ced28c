#include <stdexcept>

#include "integrators/families.hpp"

namespace rigid_body_sim {

const std::vector<IntegratorRow>& integrators() {
  static const std::vector<IntegratorRow> rows = {
      {"explicit_euler_velocity", 1, false, false, false, 1,
       "explicit Euler on (v, w), the founding text's first method; a tumbling body loses energy "
       "until it spins about one axis",
       makeExplicitEulerVelocity},
      {"semi_implicit_velocity", 1, false, false, false, 1,
       "semi-implicit Euler on (v, w), as most engines step; unstable with the gyroscopic term",
       makeSemiImplicitVelocity},
      {"split2", 2, false, true, true, 2,
       "kick - exact-rotations drift - kick on (P, L); never touches L in free flight", makeSplit2},
      {"exact", 2, true, true, true, 2,
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

#include "reference/cases.hpp"

#include <stdexcept>

namespace rigid_body_sim::reference {
namespace {

constexpr double kDegree = 3.14159265358979323846 / 180;

Case nescBrick() {
  // 1 ft = 0.3048 m, 1 lb = 0.45359237 kg, 1 slug = 1 lbf s^2/ft. The nine digits that the report
  // rounds its SI tensor to would turn the brick by 3e-9 rad in 30 s.
  constexpr double kSlugSquareFoot = 14.593902937206364 * 0.3048 * 0.3048;
  Case brick = {"nesc_brick",
                5 * 0.45359237,
                kSlugSquareFoot * Vector3d(0.00189422, 0.006211019, 0.007194665),
                {10 * kDegree, 20 * kDegree, 30 * kDegree},
                "NASA/TM-2015-218675, check case 2: tumbling brick of 5 lb"};
  // Simulation 04 of the report. Nine digits of q: half a unit of the last, twice for the angle.
  brick.published = {30,
                     Quaterniond(0.881147185, -0.470182528, -0.011728252, -0.048687540),
                     {0.2202324653, -0.3036432161, 0.5431392879},
                     2e-9,
                     1e-10};
  return brick;
}

std::vector<Case> makeCases() {
  return {
      {"dzhanibekov",
       1,
       {1, 2, 3},
       {0.1, 5, 0.1},
       "spin about the intermediate axis, a little off it: turns over again and again "
       "(V. Dzhanibekov, Salyut 7, 1985; rates of S. Peters' benchmark 'boxes')"},
      nescBrick(),
      {"fast_spinner",
       1,
       {0.01, 0.02, 0.03},
       {50, 1, 80},
       "1.9 radians in a step of 0.02 s: no method of polynomials can follow"},
      {"prolate_top",
       1,
       {0.4, 1, 1},
       {6, 1, -2},
       "closed form: two equal moments, the single one the smallest"},
      {"oblate_top",
       1,
       {1, 1, 1.8},
       {1, -2, 6},
       "closed form: two equal moments, the single one the largest"},
      {"thin_rod",
       1,
       {1e-6, 1, 1},
       {10, 1, 2},
       "closed form: moments a million to one, spinning about itself"},
      {"sphere",
       1,
       {0.7, 0.7, 0.7},
       {1, -2, 3},
       "closed form: three equal moments, a constant rate"},
      {"tumbling_stone",
       1,
       {1, 1.3, 2.1},
       {1.1, -2.3, 0.7},
       "three different moments, no axis near the spin"},
  };
}

}  // namespace

const std::vector<Case>& cases() {
  static const std::vector<Case> all = makeCases();
  return all;
}

const Case& caseNamed(const std::string& name) {
  for (const Case& one : cases())
    if (one.name == name) return one;
  throw std::invalid_argument("there is no case '" + name + "'");
}

}  // namespace rigid_body_sim::reference

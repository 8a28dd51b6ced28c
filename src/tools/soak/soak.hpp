#pragma once

#include <functional>
#include <iosfwd>
#include <string>
#include <vector>

#include "rigid_body_sim/simulator.hpp"

namespace rigid_body_sim::soak {

/// What rounding leaves of a constant of the motion: a walk at random, or a drift. Several bodies
/// are several walks. A bias that all of them have shows in their mean, which is zero but for
/// chance without one; a drift of each to its own side in how they grow, by the steps and not by
/// their root.
struct Walk {
  double mean = 0;      ///< of the bodies' relative deviations at the end
  double scatter = 0;   ///< their standard deviation
  double worst = 0;     ///< the largest at any look
  double exponent = 0;  ///< of the growth of their root mean square with the number of steps, from
                        ///< 1/64 of the steps on: 1/2 a random walk, 1 a bias, 0 neither

  /// Of the mean, by chance: three standard deviations, or an ulp where nothing scatters.
  double byChance(int bodies) const;
  bool isBiased(int bodies) const;

  /// More than some ulps, and nearer to the steps than to their root.
  bool isDrift() const;
};

/// @param deviations at 64 equal parts of the steps, each of every body
Walk walkOf(const std::vector<std::vector<double>>& deviations);

/// One method's flight: free bodies of every shape for which it is exact but for rounding, so that
/// nothing hides that.
struct Report {
  std::string rung;
  std::string bodies_in_words;
  int bodies = 0;
  Tick ticks = 0;
  double wall_s = 0;
  double length_mean = 0;      ///< of |q| - 1, over bodies and looks
  double length_worst = 0;     ///< the largest of it
  Walk angular_momentum = {};  ///< |L|
  Walk energy = {};
  double energy_limit = 0;  ///< of the worst body, by what was measured over 1e8 steps

  /// |L| to the bit, energy within its limit and without a common bias.
  bool isAsMeasured() const;
};

/// The methods that can be told apart from their truncation so: `exact`, `split2`, `rk4`.
const std::vector<std::string>& rungs();

/// @param ticks are rounded up to a multiple of 64
/// @throws std::invalid_argument for a rung that is not one of rungs()
Report fly(const std::string& rung, Tick ticks, const std::function<void(double part)>& progress);

void print(const std::vector<Report>& reports, std::ostream& out);

}  // namespace rigid_body_sim::soak

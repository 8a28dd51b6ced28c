#pragma once

#include <optional>
#include <vector>

#include "rigid_body_sim/parameters.hpp"

namespace rigid_body_sim {

/// How strong gusts are and how long they last.
struct GustParameters {
  double deviation = 0;  ///< root mean square of each axis [m/s]
  double time = 1;       ///< after which a gust is forgotten, as exp(-t / time) [s]
  int seed = 1;
};

/// Gusts that blow everywhere alike: a smooth function of time alone, the same for the same seed.
///
/// Each axis is a sum of cosines with random phases (Shinozuka and Deodatis, Appl. Mech. Rev. 44
/// (1991) 191), which approximates the first-order spectrum
/// S(w) = (2/pi) deviation^2 time / (1 + (time w)^2) for w >= 0, whose correlation is
/// exp(-|t| / time), by 24 waves up to w = 30 / time. That is Dryden's longitudinal spectrum for
/// time = L / V (MIL-F-8785C (1980), 3.7.1.2); he has a second-order one for the other axes.
class Gusts {
 public:
  Gusts() = default;  ///< none
  explicit Gusts(const GustParameters& parameters);

  /// Their velocity at this time [m/s], in W; over long times the mean is zero and the mean square
  /// of each axis is exactly deviation^2.
  Vector3d at(double time_s) const;

  bool areNone() const { return waves_.empty(); }

 private:
  struct Wave {
    double frequency;  // [rad/s]
    double phase;      // [rad]
    double amplitude;  // [m/s]
  };
  std::vector<Wave> waves_;  // of the axes in turn: x, y, z, x, ...
};

/// How wind grows with height: as (height / reference_height)^exponent, from zero at the ground
/// (Hellmann 1916; Justus and Mikhail, Geophys. Res. Lett. 3 (1976) 261). Measured winds follow
/// it in the lowest 100 m or so, with exponents near 1/7 over open land; here it goes on above.
struct WindShear {
  double reference_height;  ///< at which the factor is 1 [m]
  double exponent;

  /// Of the wind at the reference height. Zero below the ground.
  double factor(double height) const;
};

/// A wind that is the same everywhere or grows with height, and gusts on top of it.
struct Wind {
  Vector3d velocity_W = Vector3d::Zero();  ///< [m/s]
  std::optional<WindShear> shear;
  Gusts gusts;
};

/// The wind below `wind`: a vector, or a map of velocity, shear and gusts. No key, no wind.
/// @throws std::invalid_argument as Parameters does
Wind readWind(const Parameters& block);

}  // namespace rigid_body_sim

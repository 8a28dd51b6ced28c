#pragma once

#include <string>
#include <vector>

#include "rigid_body_sim/conventions.hpp"

namespace rigid_body_sim::reference {

/// NASA's constants of the check cases, in SI units (1 ft = 0.3048 m, 1 slug = 14.593902937206364
/// kg).
constexpr double kNescMu = 3.986004418e14;           ///< of the Earth [m^3/s^2]
constexpr double kNescJ2 = 0.00108262982;            ///< second zonal harmonic of the oblate Earth
constexpr double kNescEquator_m = 6378137;           ///< equatorial radius of the oblate Earth
constexpr double kNescRound_m = 6371007.1809;        ///< radius of the round Earth
constexpr double kNescTurn_radps = 7.292115e-5;      ///< of the Earth that turns
constexpr double kNescMass_kg = 14.593902937206364;  ///< of the sphere, one slug
constexpr double kNescMoment_kgm2 =
    3.6 * kNescMass_kg * 0.3048 * 0.3048;  ///< of the sphere, 3.6 slug sq ft
/// Drag coefficient 0.1 times the sphere's disc, 0.1963495 sq ft [m^2].
constexpr double kNescDragArea_m2 = 0.1 * 0.1963495 * 0.3048 * 0.3048;

/// Where the centre of mass is.
struct NescPoint {
  double time_s;
  Vector3d p_W;  ///< [m] from the centre of the Earth, inertial axes, z to the north pole
  Vector3d v_W;  ///< [m/s]
};

/// One of NASA's check cases for simulators of flight vehicles (NASA/TM-2015-218675, NESC-RP-12-
/// 00770, 2015, atmospheric cases): 30 s of fall from 30,000 ft above the equator, at rest against
/// the Earth. Six tools of NASA and its partners flew each; `spread_m` is how far they are apart at
/// most, which is what a simulator has to stay in.
///
/// The numbers are not theirs: the equations of motion with the constants above, solved by DOP853
/// to a relative tolerance of 1e-13. The best of NASA's tools agrees with them to 1.1e-6 m (case
/// 1), 2.6e-5 m (4), 2.4e-5 m (5) and 2.5e-5 m (6). The air of the cases with drag is the U.S.
/// Standard Atmosphere 1976 by its own constants: T = 288.15 K - 0.0065 K/m H, p = 101325 Pa
/// (T/288.15 K)^(g/(R 0.0065 K/m)), rho = p/(R T), with R = 8314.32/28.9644 J/(kg K), g = 9.80665
/// m/s^2, H = 6356766 m h/(6356766 m + h). With R rounded to 287.053 the sphere is off by 2.4e-6 m.
struct NescCase {
  int number;
  std::string what;
  double spread_m;
  std::vector<NescPoint> points;  ///< every 5 s, the first one the start
};

/// Cases 1, 4, 5 and 6. @throws std::invalid_argument for others.
const NescCase& nescCase(int number);

}  // namespace rigid_body_sim::reference

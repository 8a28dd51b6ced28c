#pragma once

#include <memory>
#include <optional>

#include "effects/atmosphere.hpp"
#include "effects/wind.hpp"

// The air that drag acts in: its density and wind. at() works out once an instant what depends on
// time alone; density() and wind() are asked for each body. kCost as Effect::cost(), measured.
namespace rigid_body_sim {

/// Of the same density and wind everywhere.
struct UniformAir {
  static constexpr double kCost = 0.4;
  double density_everywhere;  ///< [kg/m^3]
  Vector3d wind_W;            ///< but for gusts [m/s]
  Gusts gusts;

  struct Now {
    double density_now;
    Vector3d wind_now;
    double density(const Vector3d&) const { return density_now; }
    const Vector3d& wind(const Vector3d&) const { return wind_now; }
  };
  Now at(double time_s) const { return {density_everywhere, wind_W + gusts.at(time_s)}; }
};

/// Where the altitude counts from.
struct SeaLevel {
  Vector3d center_W;  ///< [m]
  double radius;      ///< [m]
};

/// Whose density or wind depends on altitude.
struct LayeredAir {
  static constexpr double kCost = 0.9;
  std::optional<double> density_everywhere;  ///< [kg/m^3]; unset: that of the atmosphere
  StandardAtmosphere1976 atmosphere;
  Wind breeze;
  std::optional<SeaLevel> sea_level;  ///< unset: altitude is z

  struct Now {
    const LayeredAir& air;
    Vector3d gust;

    double density(const Vector3d& p_W) const {
      return air.density_everywhere ? *air.density_everywhere
                                    : air.atmosphere.density(air.altitude(p_W));
    }
    Vector3d wind(const Vector3d& p_W) const {
      const auto& shear = air.breeze.shear;
      const double factor = shear ? shear->factor(air.altitude(p_W)) : 1;
      return factor * air.breeze.velocity_W + gust;
    }
  };
  Now at(double time_s) const { return {*this, breeze.gusts.at(time_s)}; }

  /// [m]
  double altitude(const Vector3d& p_W) const {
    return sea_level ? (p_W - sea_level->center_W).norm() - sea_level->radius : p_W.z();
  }
};

}  // namespace rigid_body_sim

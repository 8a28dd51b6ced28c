#pragma once

#include <array>
#include <cstddef>

namespace rigid_body_sim {

/// Air density by altitude, of the U.S. Standard Atmosphere, 1976 (NOAA, NASA and USAF,
/// NOAA-S/T 76-1562, NASA-TM-X-74335): a year-round mean at 45 degrees north with moderate solar
/// activity.
///
/// Up to 86 km the standard's seven layers, each with a constant gradient of temperature (Part 1,
/// tables 2 and 4, equations 18, 23, 33 and 42). From there to 1000 km, where the standard solves
/// differential equations of each gas, densities printed in its Table I (Part 4), between which the
/// logarithm is a cubic: within 0.6% of every row. Above 1000 km the density falls
/// exponentially. Below -5 km, where the tables begin, it flattens out towards that of -10 km,
/// 2.9 kg/m^3, so that nothing grows without bound inside a planet. It is continuous everywhere.
class StandardAtmosphere1976 {
 public:
  StandardAtmosphere1976();

  /// @param altitude geometric, above the sea [m]
  /// @return [kg/m^3]
  double density(double altitude) const;

 private:
  static constexpr std::size_t kLayers = 7;
  static constexpr std::size_t kNodes = 24;

  struct Layer {
    double base;         // geopotential [m]
    double temperature;  // at the base [K]
    double lapse;        // of temperature [K/m]
    double density;      // at the base [kg/m^3]
  };
  struct Node {
    double altitude;     // geometric [m]
    double log_density;  // of [kg/m^3]
    double slope;        // of that [1/m]
  };

  double layeredDensity(double altitude) const;
  double upperDensity(double altitude) const;
  void setLayers();
  void setNodes();
  double width(std::size_t i) const { return nodes_[i + 1].altitude - nodes_[i].altitude; }

  std::array<Layer, kLayers> layers_;
  std::array<Node, kNodes> nodes_;
};

}  // namespace rigid_body_sim

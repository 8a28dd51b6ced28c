#include "effects/atmosphere.hpp"

#include <algorithm>
#include <cmath>

namespace rigid_body_sim {
namespace {

// U.S. Standard Atmosphere, 1976, Part 1, table 2; R is R*/M0.
constexpr double kT0 = 288.15;            // [K]
constexpr double kP0 = 101325;            // [Pa]
constexpr double kR = 8314.32 / 28.9644;  // [J/(kg K)]
constexpr double kG0 = 9.80665;           // [m/s^2]
constexpr double kRadius = 6356766;       // r0 [m]
constexpr double kTop = 86e3;             // of the layers, geometric [m]
constexpr double kBottom = -5e3;          // of the tables [m]
constexpr double kFlattening = 5e3;       // how far below that the density still grows [m]

// Table 4: bases of the layers, geopotential [m], and gradients of temperature [K/m].
constexpr double kBases[] = {0, 11e3, 20e3, 32e3, 47e3, 51e3, 71e3};
constexpr double kLapses[] = {-6.5e-3, 0, 1e-3, 2.8e-3, 0, -2.8e-3, -2e-3};

// Part 4, Table I, pages 68 to 73: geometric altitude [km] and density [kg/m^3]; those rows between
// which the others come out best. The layers' own value stands for the first.
constexpr double kPrinted[][2] = {
    {86, 6.958e-6},   {89, 4.081e-6},   {96, 1.162e-6},   {100, 5.604e-7},  {108, 1.381e-7},
    {114, 4.975e-8},  {120, 2.222e-8},  {130, 8.152e-9},  {136, 5.074e-9},  {150, 2.076e-9},
    {165, 9.750e-10}, {175, 6.339e-10}, {200, 2.541e-10}, {230, 1.029e-10}, {250, 6.073e-11},
    {300, 1.916e-11}, {320, 1.264e-11}, {380, 4.013e-12}, {440, 1.402e-12}, {500, 5.215e-13},
    {750, 1.788e-14}, {850, 7.824e-15}, {925, 5.038e-15}, {1000, 3.561e-15}};

double geopotential(double altitude) { return kRadius * altitude / (kRadius + altitude); }  // (18)

/// Density of air whose temperature changes by `lapse` [K/m] over the density at the base of that
/// layer, `height` [m] above it: equations 23 and 33 with 42.
double densityRatio(double base_temperature, double lapse, double height) {
  if (lapse == 0) return std::exp(-kG0 / (kR * base_temperature) * height);
  return std::pow(1 + lapse / base_temperature * height, -kG0 / (kR * lapse) - 1);
}

}  // namespace

StandardAtmosphere1976::StandardAtmosphere1976() {
  setLayers();
  setNodes();
}

void StandardAtmosphere1976::setLayers() {
  layers_[0] = {kBases[0], kT0, kLapses[0], kP0 / (kR * kT0)};
  for (std::size_t i = 1; i < kLayers; ++i) {
    const Layer& below = layers_[i - 1];
    const double height = kBases[i] - below.base;
    layers_[i] = {kBases[i], below.temperature + below.lapse * height, kLapses[i],
                  below.density * densityRatio(below.temperature, below.lapse, height)};
  }
}

/// The slope at a node is that of the parabola through it and its neighbours; at the first one that
/// of the layers, so that there is no kink.
void StandardAtmosphere1976::setNodes() {
  for (std::size_t i = 0; i < kNodes; ++i)
    nodes_[i] = {1e3 * kPrinted[i][0], std::log(kPrinted[i][1]), 0};
  nodes_[0].log_density = std::log(layeredDensity(kTop));
  const Layer& layer = layers_.back();
  const double temperature = layer.temperature + layer.lapse * (geopotential(kTop) - layer.base);
  const double shrinking = kRadius / (kRadius + kTop);  // dH/dh is its square
  nodes_[0].slope = -(kG0 / kR + layer.lapse) / temperature * shrinking * shrinking;
  const auto rise = [this](std::size_t i) {
    return (nodes_[i + 1].log_density - nodes_[i].log_density) / width(i);
  };
  for (std::size_t i = 1; i + 1 < kNodes; ++i)
    nodes_[i].slope = (rise(i - 1) * width(i) + rise(i) * width(i - 1)) / (width(i - 1) + width(i));
  const std::size_t n = kNodes - 2;
  nodes_[n + 1].slope = rise(n) + (rise(n) - rise(n - 1)) * width(n) / (width(n) + width(n - 1));
}

double StandardAtmosphere1976::density(double altitude) const {
  if (altitude >= kTop) return upperDensity(altitude);
  if (altitude < kBottom)
    altitude = kBottom + kFlattening * std::expm1((altitude - kBottom) / kFlattening);
  return layeredDensity(altitude);
}

double StandardAtmosphere1976::layeredDensity(double altitude) const {
  const double H = geopotential(altitude);
  std::size_t i = 0;
  while (i + 1 < kLayers && H >= layers_[i + 1].base) ++i;
  const Layer& layer = layers_[i];
  return layer.density * densityRatio(layer.temperature, layer.lapse, H - layer.base);
}

double StandardAtmosphere1976::upperDensity(double altitude) const {
  if (altitude >= nodes_.back().altitude)
    return std::exp(nodes_.back().log_density +
                    nodes_.back().slope * (altitude - nodes_.back().altitude));
  std::size_t i = 0;
  while (altitude >= nodes_[i + 1].altitude) ++i;
  // Hermite's cubic.
  const double t = (altitude - nodes_[i].altitude) / width(i);
  const double s = 1 - t;
  const double ends =
      s * s * (1 + 2 * t) * nodes_[i].log_density + t * t * (1 + 2 * s) * nodes_[i + 1].log_density;
  const double slopes = s * s * t * nodes_[i].slope - t * t * s * nodes_[i + 1].slope;
  return std::exp(ends + width(i) * slopes);
}

}  // namespace rigid_body_sim

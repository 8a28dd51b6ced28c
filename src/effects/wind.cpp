#include "effects/wind.hpp"

#include <cmath>
#include <cstdint>
#include <limits>
#include <random>

namespace rigid_body_sim {
namespace {

constexpr double kPi = 3.14159265358979323846;

/// Of each axis; and how fast the fastest is, times `time`: 2% of the variance of the spectrum lies
/// beyond. Measured: the correlation is within 0.06 of exp(-t / time) for three times `time`. Waves
/// of equal variance, the other choice, are within 0.16, and 60 / time fast.
constexpr int kWaves = 24;
constexpr double kFastest = 30;

/// The part of the spectrum's variance below the frequency x / time.
double varianceBelow(double x) { return 2 / kPi * std::atan(x); }

/// In [0, 1), the same on every platform: the standard fixes the engine's raw output, but not what
/// its distributions make of it.
double uniform(std::mt19937_64& engine) { return static_cast<double>(engine() >> 11) * 0x1p-53; }

WindShear readShear(const Parameters& block) {
  const WindShear shear = {block.number("reference_height", positive("m")),
                           block.number("exponent", positive(""))};
  block.refuseUnknown();
  return shear;
}

Gusts readGusts(const Parameters& block) {
  GustParameters parameters;
  parameters.deviation = block.number("deviation", notNegative("m/s"));
  parameters.time = block.number("time", positive("s"));
  parameters.seed = block.integer("seed", 0, std::numeric_limits<int>::max(), 1);
  block.refuseUnknown();
  return Gusts(parameters);
}

}  // namespace

/// The band is cut at sinh(j c), evenly at low and geometrically at high frequencies; each of its
/// parts has a wave, with the variance of that part. The wave's frequency is drawn from the middle
/// quarter of its part, of which each axis has a third of its own: no two of them have a frequency
/// in common, and so no correlation.
Gusts::Gusts(const GustParameters& parameters) {
  if (parameters.deviation == 0) return;
  std::mt19937_64 engine(static_cast<std::uint64_t>(parameters.seed));
  const double c = std::asinh(kFastest) / kWaves;
  for (int j = 0; j < kWaves; ++j) {
    const double part = varianceBelow(std::sinh((j + 1) * c)) - varianceBelow(std::sinh(j * c));
    const double variance =
        parameters.deviation * parameters.deviation * part / varianceBelow(kFastest);
    for (int axis = 0; axis < 3; ++axis) {
      const double place = j + 0.375 + ((axis + j) % 3 + 0.5 * uniform(engine)) / 12;
      const double phase = 2 * kPi * uniform(engine);
      waves_.push_back({std::sinh(place * c) / parameters.time, phase, std::sqrt(2 * variance)});
    }
  }
}

Vector3d Gusts::at(double time_s) const {
  Vector3d sum = Vector3d::Zero();
  for (std::size_t i = 0; i < waves_.size(); i += 3) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const Wave& wave = waves_[i + axis];
      sum(static_cast<Eigen::Index>(axis)) +=
          wave.amplitude * std::cos(wave.frequency * time_s + wave.phase);
    }
  }
  return sum;
}

double WindShear::factor(double height) const {
  return height > 0 ? std::pow(height / reference_height, exponent) : 0;
}

Wind readWind(const Parameters& block) {
  Wind wind;
  if (!block.has("wind")) return wind;
  if (!block.isMap("wind")) {
    wind.velocity_W = block.vector3("wind", finite("m/s"));
    return wind;
  }
  const Parameters map = block.child("wind");
  const bool has_shear = map.has("shear");
  if (map.has("velocity") || has_shear) wind.velocity_W = map.vector3("velocity", finite("m/s"));
  if (has_shear) wind.shear = readShear(map.child("shear"));
  if (map.has("gusts")) wind.gusts = readGusts(map.child("gusts"));
  map.refuseUnknown();
  return wind;
}

}  // namespace rigid_body_sim

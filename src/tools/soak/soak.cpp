#include "tools/soak/soak.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iomanip>
#include <limits>
#include <ostream>
#include <random>
#include <sstream>
#include <stdexcept>

#include "rigid_body_sim/conserved.hpp"

namespace rigid_body_sim::soak {
namespace {

constexpr int kBodies = 32;
constexpr int kLooks = 64;
constexpr double kUlp = std::numeric_limits<double>::epsilon();

/// A method, and for which bodies its truncation is less than rounding.
struct Row {
  std::string rung;
  std::string bodies_in_words;
  bool has_equal_moments;
  double rate;   // [rad/s], at 0.02 s a step
  double drift;  // most of the energy's relative change that a step leaves in the end; see below
};

const std::vector<Row>& rows() {
  // Drifts measured over 1e8 steps, the worst of 32 bodies; each body has its own, of either sign,
  // the same at 1e-4 and at 0.002 rad a step, so that they are of rounding, and not of truncation.
  static const std::vector<Row> all = {
      {"exact", "three moments, 0.1 rad a step", false, 5, 0},
      // With two equal moments its three turns are the motion itself.
      {"split2", "two equal moments, 0.1 rad a step", true, 5, 4e-18},  // 1.9e-18
      // At 0.01 rad a step truncation leaves 7e-17 a step, and falls by the fifth power: 2e-20
      // here.
      {"rk4", "three moments, 0.002 rad a step", false, 0.1, 4e-17},  // 1.7e-17
  };
  return all;
}

Vector3d moments(bool has_equal, const std::function<double(double, double)>& between) {
  Vector3d I(between(0.5, 1), between(1, 1.4), 0);
  if (has_equal)
    I.z() = I.y();
  else
    I.z() = between(I.y(), I.x() + I.y());
  return I;
}

Scene sceneOf(const Row& row) {
  std::mt19937 generator(2024);
  const auto between = [&](double low, double high) {  // the same everywhere, unlike std's
    return low + (high - low) * generator() / 4294967296.0;
  };
  const auto vector = [&] { return Vector3d(between(-1, 1), between(-1, 1), between(-1, 1)); };
  Scene scene;
  scene.integrator = row.rung;
  for (int i = 0; i < kBodies; ++i) {
    SceneBody body;
    body.name = "body" + std::to_string(i);
    body.mass_properties = {1, Vector3d::Zero(),
                            moments(row.has_equal_moments, between).asDiagonal()};
    body.X_WL.linear() = Eigen::AngleAxisd(between(0, 3), vector().normalized()).matrix();
    body.w_WB_L = row.rate * vector().normalized();
    scene.bodies.push_back(body);
  }
  return scene;
}

double rms(const std::vector<double>& values) {
  double squares = 0;
  for (const double value : values) squares += value * value;
  return std::sqrt(squares / static_cast<double>(values.size()));
}

}  // namespace

double Walk::byChance(int bodies) const {
  return std::max(3 * scatter / std::sqrt(static_cast<double>(bodies)), kUlp);
}

bool Walk::isBiased(int bodies) const { return !(std::abs(mean) <= byChance(bodies)); }

bool Walk::isDrift() const { return worst > 16 * kUlp && !(exponent < 0.75); }

bool Report::isAsMeasured() const {
  return angular_momentum.worst == 0 && energy.worst <= energy_limit && !energy.isBiased(bodies);
}

Walk walkOf(const std::vector<std::vector<double>>& deviations) {
  Walk walk;
  const std::vector<double>& end = deviations.back();
  const auto count = static_cast<double>(end.size());
  for (const double one : end) walk.mean += one / count;
  double squares = 0;
  for (const double one : end) squares += (one - walk.mean) * (one - walk.mean);
  walk.scatter = std::sqrt(squares / (count - 1));
  for (const auto& look : deviations)
    for (const double one : look) walk.worst = std::max(walk.worst, std::abs(one));
  // A line through the logarithms of all looks; those at which nothing is off have none.
  double n = 0, x = 0, y = 0, xx = 0, xy = 0;
  for (std::size_t k = 0; k < deviations.size(); ++k) {
    const double off = rms(deviations[k]);
    if (off == 0) continue;
    const double a = std::log(static_cast<double>(k + 1)), b = std::log(off);
    n += 1, x += a, y += b, xx += a * a, xy += a * b;
  }
  if (n > 1) walk.exponent = (n * xy - x * y) / (n * xx - x * x);
  return walk;
}

const std::vector<std::string>& rungs() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> names;
    for (const Row& row : rows()) names.push_back(row.rung);
    return names;
  }();
  return names;
}

Report fly(const std::string& rung, Tick ticks, const std::function<void(double part)>& progress) {
  const auto row =
      std::find_if(rows().begin(), rows().end(), [&](const Row& one) { return one.rung == rung; });
  if (row == rows().end())
    throw std::invalid_argument("'" + rung + "' is not flown; there are exact, split2, rk4");
  const Tick every = (ticks + kLooks - 1) / kLooks;
  Simulator simulator(sceneOf(*row));
  const Bodies start = simulator.bodies();
  Report report = {rung, row->bodies_in_words, kBodies, every * kLooks};
  std::vector<std::vector<double>> momenta, energies;
  const auto began = std::chrono::steady_clock::now();
  for (int look = 0; look < kLooks; ++look) {
    progress(static_cast<double>(look) / kLooks);
    simulator.advance(every);
    const Bodies& now = simulator.bodies();
    momenta.emplace_back();
    energies.emplace_back();
    for (Eigen::Index i = 0; i < kBodies; ++i) {
      // In extended precision: a root of doubles near one is rounded by as much as is looked for.
      const long double length = now.state(i).q_WB.coeffs().cast<long double>().norm() - 1;
      report.length_mean += static_cast<double>(length / (kBodies * kLooks));
      report.length_worst = std::max(report.length_worst, static_cast<double>(std::abs(length)));
      const auto L = [i](const Bodies& bodies) {
        return bodies.state(i).L_WBcm_W.cast<long double>().norm();
      };
      momenta.back().push_back(static_cast<double>(L(now) / L(start) - 1));
      energies.back().push_back(kineticEnergy(now, i) / kineticEnergy(start, i) - 1);
    }
  }
  report.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  report.angular_momentum = walkOf(momenta);
  report.energy = walkOf(energies);
  report.energy_limit = 64 * kUlp + row->drift * static_cast<double>(report.ticks);
  return report;
}

static std::string verdictOn(const Walk& walk, const Report& report) {
  std::ostringstream text;
  text.precision(2);
  const auto ulps_a_step = [&](double change) {
    return change / kUlp / static_cast<double>(report.ticks);
  };
  if (walk.worst == 0)
    text << "to the bit";
  else if (walk.isBiased(report.bodies))
    text << "BIASED, by " << ulps_a_step(walk.mean) << " ulps a step";
  else if (walk.isDrift())
    text << "drifts, each body to its own side, by " << ulps_a_step(walk.worst)
         << " ulps a step at most";
  else
    text << "no bias";
  return text.str();
}

void print(const std::vector<Report>& reports, std::ostream& out) {
  out << "Torque-free bodies of which each method's truncation is less than rounding: what is left "
         "is rounding.\nA walk at random grows by the root of the steps, a drift by the steps; a "
         "bias "
         "of all bodies shows in their mean.\n";
  out.precision(2);
  const auto line = [&](const Report& report, const std::string& name, const Walk& walk) {
    out << "  " << std::left << std::setw(8) << name << std::right << "mean " << std::setw(9)
        << walk.mean << " (by chance " << std::setw(8) << walk.byChance(report.bodies)
        << "), worst " << std::setw(8) << walk.worst << ", grows by steps^" << std::setw(6)
        << std::left << walk.exponent << std::right << ' ' << verdictOn(walk, report) << '\n';
  };
  for (const Report& report : reports) {
    out << '\n'
        << report.rung << ": " << report.bodies << " bodies of " << report.bodies_in_words << ", "
        << static_cast<double>(report.ticks) << " steps (" << report.wall_s << " s)\n"
        << "  |q| - 1 mean " << std::setw(9) << report.length_mean << ", worst "
        << report.length_worst << '\n';
    line(report, "|L|", report.angular_momentum);
    line(report, "energy", report.energy);
    if (!report.isAsMeasured())
      out << "  MORE than was measured: energy may be off by " << report.energy_limit << '\n';
  }
}

}  // namespace rigid_body_sim::soak

#include "tools/accuracy_report/own_method.hpp"

#include <algorithm>
#include <sstream>
#include <stdexcept>
#include <vector>

#include "rigid_body_sim/accuracy.hpp"

namespace rigid_body_sim::report {
namespace {

constexpr std::size_t kMostNamed = 3;  // bodies, in a sentence

std::string namesOf(const std::vector<Eigen::Index>& bodies, const Scene& scene) {
  std::string names;
  for (std::size_t k = 0; k < bodies.size() && k < kMostNamed; ++k)
    names += (k == 0 ? "" : ", ") + scene.bodies[bodies[k]].name;
  if (bodies.size() > kMostNamed)
    names += " and " + std::to_string(bodies.size() - kMostNamed) + " more";
  return names;
}

/// The row, or null; a tolerance is the row's only where the method has one.
const Row* rowOf(const Report& report, const Method& method) {
  for (const Row& row : report.rows) {
    const bool is_as_fine = row.adapts ? row.method.tolerance == method.tolerance
                                       : row.method.substeps == method.substeps;
    if (row.method.integrator == method.integrator && is_as_fine) return &row;
  }
  return nullptr;
}

std::string rowText(const Report& report, const Method& method) {
  std::ostringstream text;
  text.precision(2);
  Row named;
  named.method = method;
  named.adapts = integratorNamed(method.integrator).order == 0;
  text << nameOf(named);
  const Row* row = rowOf(report, method);
  if (!row) return text.str() + " (which is no row here)";
  if (row->outcome != Outcome::kFlown) return text.str() + " (" + row->why + ")";
  const double error = errorOf(report, *row), doubt = doubtOf(report);
  text << " (" << (error < doubt ? "less than " : "") << std::max(error, doubt)
       << (report.rotates ? " rad" : " m") << " off at worst)";
  return text.str();
}

std::string chosenText(const Report& report, const std::vector<MethodOfBodies>& methods) {
  std::string text;
  for (const MethodOfBodies& one : methods)
    text += (text.empty() ? "" : "; ") + rowText(report, one.method) +
            (methods.size() == 1 ? "" : " for " + namesOf(one.bodies, report.scene));
  return text;
}

}  // namespace

std::string ownMethod(const Report& report) {
  const Scene& scene = report.scene;
  if (!scene.accuracy)
    return "The scene's own integrator and substeps: " + rowText(report, methodOf(scene)) + ".";
  const std::string budget = "The scene's own accuracy, " + summary(*scene.accuracy) + ", ";
  try {
    return budget + "chooses " +
           chosenText(report, methodsOf(rigid_body_sim::plan(scene, *scene.accuracy))) + ".";
  } catch (const std::invalid_argument& error) {
    return budget + "cannot be kept: " + error.what();
  }
}

}  // namespace rigid_body_sim::report

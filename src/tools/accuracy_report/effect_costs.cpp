#include "tools/accuracy_report/effect_costs.hpp"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <ostream>

#include "tools/accuracy_report/errors.hpp"

namespace rigid_body_sim::report {
namespace {

constexpr Tick kTicks = 500;  // a run; the state may not go far from the start

bool contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

std::size_t bodiesOf(const Scene& scene, const std::string& effect) {
  std::size_t bodies = 0;
  for (const auto& one : scene.effects)
    if (one->name() == effect) bodies = std::max(bodies, one->bodyCount());
  return bodies;
}

/// Medians of times [ns] of a body's tick of each scene, run in turn.
std::vector<double> timesOf(const std::vector<Scene>& scenes, const Method& method, int repeats) {
  std::vector<std::vector<double>> times(scenes.size());
  for (int repeat = 0; repeat < repeats; ++repeat)
    for (std::size_t k = 0; k < scenes.size(); ++k)
      times[k].push_back(
          costsOf(scenes[k], {{method, kTicks}}, 1, [](std::size_t) {}).front().median_ns);
  std::vector<double> medians;
  for (std::vector<double>& of_one : times) {
    std::sort(of_one.begin(), of_one.end());
    medians.push_back(of_one[of_one.size() / 2]);
  }
  return medians;
}

void printLine(const EffectCost& cost, const std::string& name, const std::string& bodies,
               std::ostream& out) {
  out << "  " << std::left << std::setw(34) << name << std::right << std::setw(8) << bodies
      << std::setw(12) << std::llround(cost.time_ns) << std::setw(16);
  if (std::isnan(cost.instructions))
    out << "-";
  else
    out << std::llround(cost.instructions);
  out << '\n';
}

}  // namespace

std::vector<std::string> effectNamesOf(const Scene& scene) {
  std::vector<std::string> names;
  for (const auto& effect : scene.effects)
    if (!contains(names, effect->name())) names.push_back(effect->name());
  return names;
}

Scene withEffects(Scene scene, const std::vector<std::string>& names) {
  const auto is_out = [&](const auto& effect) { return !contains(names, effect->name()); };
  scene.effects.erase(std::remove_if(scene.effects.begin(), scene.effects.end(), is_out),
                      scene.effects.end());
  return scene;
}

EffectCosts effectCosts(const Scene& scene, const Method& method, int repeats,
                        const EffectStepCommand& command,
                        const std::function<void(const std::string&)>& tell) {
  const std::vector<std::string> all = effectNamesOf(scene);
  std::vector<std::vector<std::string>> choices = {{}};
  for (const std::string& name : all) choices.push_back({name});
  choices.push_back(all);

  std::vector<Scene> scenes;
  for (const auto& names : choices) scenes.push_back(withEffects(scene, names));
  const std::vector<double> times = timesOf(scenes, method, repeats);
  std::vector<EffectCost> costs;
  for (std::size_t k = 0; k < choices.size(); ++k) {
    costs.push_back({choices[k].empty() ? "" : choices[k].front(), scene.bodies.size(), times[k]});
    if (command) {
      tell(k == 0 ? "none" : k + 1 == choices.size() ? "together" : choices[k].front());
      costs.back().instructions =
          instructionsATick(scene.bodies.size(), {method}, [&](const std::vector<Method>& methods) {
            return command(methods, choices[k]);
          }).front();
    }
    if (k == 0) continue;
    costs[k].bodies = bodiesOf(scene, costs[k].name);
    costs[k].time_ns -= costs[0].time_ns;
    costs[k].instructions -= costs[0].instructions;
  }
  EffectCosts result = {method, costs.front(), {costs.begin() + 1, costs.end() - 1}, costs.back()};
  result.together.bodies = scene.bodies.size();
  return result;
}

void print(const EffectCosts& costs, std::ostream& out) {
  out << "What the effects cost with " << toText(costs.method)
      << ", a body of the scene and tick:\n"
      << "  " << std::left << std::setw(34) << "" << std::right << std::setw(8) << "bodies"
      << std::setw(12) << "time [ns]" << std::setw(16) << "instructions" << '\n';
  printLine(costs.none, "a tick without effects", std::to_string(costs.none.bodies), out);
  for (const EffectCost& cost : costs.alone)
    printLine(cost, "+ " + cost.name + " alone", std::to_string(cost.bodies), out);
  if (costs.alone.size() > 1)
    printLine(costs.together, "+ all together", std::to_string(costs.together.bodies), out);
}

void writeCsv(const EffectCosts& costs, std::ostream& file) {
  file << "effect,bodies,time_ns,instructions\n";
  const auto write = [&](const EffectCost& cost, const std::string& name) {
    file << name << ',' << cost.bodies << ',' << cost.time_ns << ',';
    if (!std::isnan(cost.instructions)) file << cost.instructions;
    file << '\n';
  };
  write(costs.none, "none");
  for (const EffectCost& cost : costs.alone) write(cost, cost.name);
  write(costs.together, "together");
}

}  // namespace rigid_body_sim::report

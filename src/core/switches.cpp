#include <algorithm>
#include <stdexcept>

#include "core/accuracy_watch.hpp"
#include "core/block.hpp"
#include "core/suitability.hpp"
#include "rigid_body_sim/simulator.hpp"

namespace rigid_body_sim {

std::vector<std::string> Simulator::effectNames() const {
  std::vector<std::string> names = {"gyroscopic"};
  for (const auto& effect : at_start_.effects)
    if (std::find(names.begin(), names.end(), effect->blockName()) == names.end())
      names.push_back(effect->blockName());
  return names;
}

/// What the scene's effects become; nothing is changed yet.
Simulator::Switches Simulator::switchedTo(const std::string& name, bool is_on) const {
  const std::vector<std::string> names = effectNames();
  if (std::find(names.begin(), names.end(), name) == names.end()) {
    for (const std::string& line : scene_.elided)
      if (line.rfind(name + ": ", 0) == 0)
        throw std::invalid_argument("the scene's '" + name +
                                    "' does nothing: " + line.substr(name.size() + 2));
    std::string known;
    for (const std::string& one : names) known += (known.empty() ? "" : ", ") + one;
    throw std::invalid_argument("the scene has no effect '" + name + "'; there are " + known);
  }
  Switches to = {{}, scene_.gyroscopic};
  if (name == "gyroscopic") to.gyroscopic = is_on ? Gyroscopic::kOn : Gyroscopic::kOff;
  for (const auto& effect : at_start_.effects) {
    const auto& now = scene_.effects;
    const bool was_on = std::find(now.begin(), now.end(), effect) != now.end();
    const bool is_it = effect->blockName() == name;
    if (is_it && !is_on && !effect->isSwitchable())
      throw std::invalid_argument("'" + name +
                                  "' cannot end: the momenta of the bodies contain it");
    if (is_it ? is_on : was_on) to.effects.push_back(effect);
  }
  return to;
}

bool Simulator::switchEffect(const std::string& name, bool is_on) {
  if (watch_)
    throw std::invalid_argument(
        "the methods were chosen for these effects, to keep the accuracy; a scene with a budget "
        "keeps its effects");
  const Switches to = switchedTo(name, is_on);
  if (to.effects == scene_.effects && to.gyroscopic == scene_.gyroscopic) return false;
  Scene changed = scene_;
  changed.effects = to.effects;
  changed.gyroscopic = to.gyroscopic;
  // What ends makes nothing harder, but that some effects need the gyroscopic term.
  changed.warnings.resize(start_warnings_);
  if (is_on || name == "gyroscopic")
    for (std::string& warning : requireSuitableMethods(changed, bodies(), time_s()))
      changed.warnings.push_back(std::move(warning));
  const double before = energy().potential_J;
  scene_ = std::move(changed);
  start_energy_J_ += energy().potential_J - before;  // it comes and goes with the effect
  makeBlocks();
  return true;
}

}  // namespace rigid_body_sim

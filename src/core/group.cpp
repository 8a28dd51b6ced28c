#include "core/group.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <utility>

namespace rigid_body_sim {
namespace {

/// If the bodies have methods of their own.
void requireEachBodyOnce(const Scene& scene) {
  if (scene.methods.empty()) return;
  std::vector<int> counts(scene.bodies.size(), 0);
  for (const MethodOfBodies& part : scene.methods) {
    if (part.bodies.empty()) throw std::invalid_argument("a method for no body");
    for (const Eigen::Index body : part.bodies) {
      if (body < 0 || body >= static_cast<Eigen::Index>(counts.size()))
        throw std::invalid_argument("a method for the body " + std::to_string(body) +
                                    ", which is not there");
      ++counts[body];
    }
  }
  for (std::size_t i = 0; i < counts.size(); ++i)
    if (counts[i] != 1)
      throw std::invalid_argument("body '" + scene.bodies[i].name + "' has " +
                                  std::to_string(counts[i]) + " methods; it takes one");
}

/// The methods of a scene; no bodies means all of them.
std::vector<MethodOfBodies> methodsOf(const Scene& scene) {
  if (scene.methods.empty()) return {{{}, methodOf(scene)}};
  if (scene.methods.size() == 1) return {{{}, scene.methods[0].method}};
  return scene.methods;
}

EffectList effectsOn(const MethodOfBodies& part, const Scene& scene) {
  if (part.bodies.empty()) return scene.effects;
  auto effects = restrictedTo(scene.effects, part.bodies);
  if (!effects)
    throw std::invalid_argument(
        "an effect couples the bodies of the scene: they all take the same method");
  return *effects;
}

}  // namespace

std::string toText(const Method& method) {
  if (method.substeps == 1) return method.integrator;
  return method.integrator + " x " + std::to_string(method.substeps);
}

std::optional<EffectList> restrictedTo(const EffectList& effects,
                                       const std::vector<Eigen::Index>& bodies) {
  EffectList restricted;
  for (const auto& effect : effects) {
    auto part = effect->restrictedTo(bodies);
    if (!part) return std::nullopt;
    if (part->bodyCount() > 0) restricted.push_back(std::move(part));
  }
  return restricted;
}

bool areCoupled(const EffectList& effects, Eigen::Index count) {
  for (Eigen::Index i = 0; i < count; ++i)
    if (!restrictedTo(effects, {i})) return true;
  return false;
}

Bodies rowsOf(const Bodies& bodies, const std::vector<Eigen::Index>& indices) {
  Bodies rows(static_cast<Eigen::Index>(indices.size()));
  for (std::size_t k = 0; k < indices.size(); ++k) {
    const auto row = static_cast<Eigen::Index>(k);
    rows.mass(row) = bodies.mass(indices[k]);
    rows.I_BBcm_B.row(row) = bodies.I_BBcm_B.row(indices[k]);
    rows.setState(row, bodies.state(indices[k]));
  }
  return rows;
}

FastestBody fastestOf(const Bodies& bodies) {
  FastestBody fastest;
  for (Eigen::Index i = 0; i < bodies.count(); ++i) {
    const double rate = angularVelocityInBody(bodies.state(i), bodies.moments(i)).norm();
    if (rate > fastest.rate) fastest = {i, rate};
  }
  return fastest;
}

std::string objection(const Method& method, const EffectList& effects) {
  const IntegratorRow& row = integratorNamed(method.integrator);
  if (method.substeps <= 0 || method.substeps > kMostSubsteps)
    return "the number of substeps must be from 1 to " + std::to_string(kMostSubsteps) + ", not " +
           std::to_string(method.substeps);
  if (!(method.tolerance > 0)) return "the tolerance must be positive";
  for (const auto& effect : effects)
    if (row.order > 0 && row.order_under_drag == 0 && effect->dependsOnVelocity())
      return "integrator '" + row.name + "' has steps back in time, in which '" + effect->name() +
             "' would feed energy: it depends on velocities; take rk4 or rk8";
  return {};
}

std::string objection(const Method& method, double rate, double tick_s) {
  const IntegratorRow& row = integratorNamed(method.integrator);
  const double turn = rate * tick_s / method.substeps;
  if (!(turn > row.max_turn)) return {};
  std::ostringstream why;
  why << rate << " rad/s are " << turn << " rad a step, and '" << row.name << "' bears "
      << row.max_turn << "; take " << std::ceil(rate * tick_s / row.max_turn)
      << " substeps or more, or exact";
  return why.str();
}

std::string caution(const Method& method, const EffectList& effects) {
  const IntegratorRow& row = integratorNamed(method.integrator);
  if (row.order_under_drag >= row.order || row.order_under_drag == 0) return {};
  for (const auto& effect : effects)
    if (effect->dependsOnVelocity())
      return effect->name() + " depends on velocities: " + row.name + " is of order " +
             std::to_string(row.order_under_drag) + " with it, not " + std::to_string(row.order);
  return {};
}

std::vector<std::string> requireSuitableMethods(const Scene& scene, const Bodies& bodies) {
  requireEachBodyOnce(scene);
  std::vector<std::string> cautions;
  for (const MethodOfBodies& part : methodsOf(scene)) {
    const EffectList effects = effectsOn(part, scene);
    std::string why = objection(part.method, effects);
    if (!why.empty()) throw std::invalid_argument(why);
    const FastestBody fastest =
        fastestOf(part.bodies.empty() ? bodies : rowsOf(bodies, part.bodies));
    why = objection(part.method, fastest.rate, scene.step_s());
    const Eigen::Index body = part.bodies.empty() ? fastest.body : part.bodies[fastest.body];
    if (!why.empty()) throw std::invalid_argument("body '" + scene.bodies[body].name + "': " + why);
    cautions.push_back(caution(part.method, effects));
    if (cautions.back().empty()) cautions.pop_back();
  }
  return cautions;
}

std::vector<Group> groupsOf(const Scene& scene) {
  std::vector<Group> groups;
  for (const MethodOfBodies& part : methodsOf(scene))
    groups.emplace_back(part.method, scene.gyroscopic, effectsOn(part, scene), part.bodies);
  return groups;
}

Group::Group(const Method& method, Gyroscopic gyroscopic, EffectList effects,
             std::vector<Eigen::Index> bodies)
    : method_(method),
      indices_(std::move(bodies)),
      effects_(std::move(effects)),
      integrator_(integratorNamed(method.integrator).make({gyroscopic, method.tolerance})) {
  for (const auto& effect : effects_) active_.add(effect.get());
}

void Group::hold(const AppliedWrenches& applied) {
  if (applied_) active_.remove(applied_);
  own_applied_ = indices_.empty() ? nullptr : applied.restrictedTo(indices_);
  applied_ = own_applied_ ? own_applied_.get() : &applied;
  if (applied_->bodyCount() == 0) applied_ = nullptr;
  if (applied_) active_.add(applied_);
}

void Group::step(Bodies& all, double start_s, double tick_s) {
  if (indices_.empty()) return stepInPlace(all, start_s, tick_s);
  gather(all);
  stepInPlace(own_, start_s, tick_s);
  scatter(all);
}

void Group::stepInPlace(Bodies& bodies, double start_s, double tick_s) {
  const double step_s = tick_s / method_.substeps;
  for (int i = 0; i < method_.substeps; ++i)
    integrator_->step(bodies, active_, start_s + i * step_s, step_s);
}

void Group::gather(const Bodies& all) {
  if (own_.count() == 0) own_ = rowsOf(all, indices_);
  for (std::size_t k = 0; k < indices_.size(); ++k)
    own_.setState(static_cast<Eigen::Index>(k), all.state(indices_[k]));
}

void Group::scatter(Bodies& all) const {
  for (std::size_t k = 0; k < indices_.size(); ++k)
    all.setState(indices_[k], own_.state(static_cast<Eigen::Index>(k)));
}

}  // namespace rigid_body_sim

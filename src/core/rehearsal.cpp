#include "core/rehearsal.hpp"

#include <algorithm>
#include <sstream>

#include "core/block.hpp"

namespace rigid_body_sim {
namespace {

// Some tenth of a second, in the registry's unit of cost: 60 ns of one body.
constexpr double kMostWork = 1e6;
constexpr Tick kMost = 1'000;
constexpr Tick kFewest = 10;

/// 0 if there is no time for them, or no saying how long they take.
Tick ticksToFly(const Scene& scene, Eigen::Index count) {
  double work = 0;  // a tick
  for (const MethodOfBodies& part : methodsOf(scene)) {
    const IntegratorRow& row = integratorNamed(part.method.integrator);
    if (row.order == 0) return 0;
    const auto bodies = static_cast<double>(
        part.bodies.empty() ? count : static_cast<Eigen::Index>(part.bodies.size()));
    work += bodies * part.method.substeps * row.forced_cost;
  }
  const Tick ticks = static_cast<Tick>(std::min(static_cast<double>(kMost), kMostWork / work));
  return ticks < kFewest ? 0 : ticks;
}

std::optional<Trouble> lookAt(const Placed& one, Tick tick, double tick_s) {
  const double time_s = static_cast<double>(tick) * tick_s;
  auto fault = one.block.tooStiff(time_s, tick_s);
  if (!fault && !one.block.frozen().empty())
    fault = Fault{one.block.frozen().front().body, "its state becomes infinite"};
  if (!fault) return std::nullopt;
  return Trouble{time_s, {one.indices[fault->body], fault->why}};
}

}  // namespace

std::optional<Trouble> firstTrouble(const Scene& scene, const Bodies& bodies) {
  const auto is_steady = [](const auto& effect) { return effect->isSteady(); };
  if (std::all_of(scene.effects.begin(), scene.effects.end(), is_steady)) return std::nullopt;
  const Tick ticks = ticksToFly(scene, bodies.count());
  if (ticks == 0) return std::nullopt;
  const double tick_s = scene.step_s();
  std::vector<Placed> blocks = blocksOf(scene, bodies);
  const auto is_known = [&](const Placed& one) { return lookAt(one, 0, tick_s).has_value(); };
  blocks.erase(std::remove_if(blocks.begin(), blocks.end(), is_known), blocks.end());
  Snapshot before;
  for (Tick tick = 0; tick < ticks; ++tick)
    for (Placed& one : blocks) {
      one.block.advance(tick, 1, tick_s, before);
      if (auto trouble = lookAt(one, tick + 1, tick_s)) return trouble;
    }
  return std::nullopt;
}

std::string toText(const Trouble& trouble, const Scene& scene) {
  std::ostringstream text;
  text << "body '" << scene.bodies[trouble.fault.body].name << "', " << trouble.time_s
       << " s after the start: " << trouble.fault.why;
  return text.str();
}

}  // namespace rigid_body_sim

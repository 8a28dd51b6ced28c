#include "core/block.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

#include "core/suitability.hpp"
#include "integrators/columns.hpp"

namespace rigid_body_sim {
namespace {

/// As many bodies as the second cache holds with all that a step needs of them. Measured for 256 to
/// 65,536 bodies with an L1 of 32 kB and an L2 of 1 MB: any number from 64 to 520 is within a tenth
/// but for powers of two, whose columns fall onto the same places of the first cache: 128 bodies
/// take up to 15 % longer under semi_implicit.
constexpr std::size_t kBlockSize = 136;

/// The columns of the state, in the order of a snapshot.
template <class AnyBodies, class F>
void forColumns(AnyBodies& bodies, F f) {
  f(bodies.p_WBcm);
  f(bodies.q_WB);
  f(bodies.P_WB);
  f(bodies.L_WBcm_W);
  f(bodies.p_low);
}

constexpr Eigen::Index kStateNumbers = 16;

std::vector<Eigen::Index> allOf(const Scene& scene) {
  std::vector<Eigen::Index> all(scene.bodies.size());
  std::iota(all.begin(), all.end(), Eigen::Index(0));
  return all;
}

Placed placed(const MethodOfBodies& part, const Scene& scene, const Bodies& bodies,
              std::vector<Eigen::Index> indices, EffectList effects) {
  const bool is_whole = part.bodies.empty() && indices.size() == scene.bodies.size();
  Bodies rows = is_whole ? bodies : rowsOf(bodies, indices);
  std::vector<Eigen::Index> ungyroscopic = ungyroscopicBodies(scene, indices);
  Block block(part.method, std::move(ungyroscopic), std::move(effects), std::move(rows));
  return {std::move(indices), std::move(block)};
}

/// A part in blocks; empty if an effect cannot be divided so.
std::vector<Placed> dividedPart(const MethodOfBodies& part, const Scene& scene,
                                const Bodies& bodies, const std::vector<Eigen::Index>& indices) {
  std::vector<Placed> blocks;
  for (std::size_t begin = 0; begin < indices.size(); begin += kBlockSize) {
    const auto first = indices.begin() + static_cast<std::ptrdiff_t>(begin);
    const auto count = std::min(kBlockSize, indices.size() - begin);
    std::vector<Eigen::Index> some(first, first + static_cast<std::ptrdiff_t>(count));
    auto effects = restrictedTo(scene.effects, some);
    if (!effects) return {};
    blocks.push_back(placed(part, scene, bodies, std::move(some), std::move(*effects)));
  }
  return blocks;
}

}  // namespace

void Snapshot::take(const Bodies& bodies) {
  numbers_.resize(static_cast<std::size_t>(kStateNumbers * bodies.count()));
  double* to = numbers_.data();
  forColumns(bodies, [&](const auto& columns) {
    to = std::copy(columns.data(), columns.data() + columns.size(), to);
  });
}

void Snapshot::restore(Eigen::Index i, Bodies& bodies) const {
  const double* from = numbers_.data() + i;
  forColumns(bodies, [&](auto& columns) {
    for (Eigen::Index k = 0; k < columns.cols(); ++k, from += bodies.count()) columns(i, k) = *from;
  });
}

Block::Block(const Method& method, std::vector<Eigen::Index> ungyroscopic, EffectList effects,
             Bodies bodies)
    : method_(method),
      effects_(std::move(effects)),
      bodies_(std::move(bodies)),
      integrator_(
          integratorNamed(method.integrator).make({std::move(ungyroscopic), method.tolerance})) {
  for (const auto& effect : effects_) active_.add(effect.get());
}

void Block::setState(Eigen::Index i, const BodyState& state) {
  bodies_.setState(i, state);
  motion_ = Motion::kUnknown;
}

void Block::hold(std::shared_ptr<const Effect> applied) {
  if (applied_) active_.remove(applied_.get());
  applied_ = std::move(applied);
  if (applied_) active_.add(applied_.get());
  motion_ = Motion::kUnknown;
}

/// Free bodies that are at rest stay there until somebody moves them; so nothing is computed.
bool Block::isAtRest() {
  if (!active_.empty()) return false;
  if (motion_ == Motion::kUnknown) {
    const bool rests = bodies_.P_WB.isZero(0) && bodies_.L_WBcm_W.isZero(0);
    motion_ = rests ? Motion::kAtRest : Motion::kMoves;
  }
  return motion_ == Motion::kAtRest;
}

void Block::step(double start_s, double tick_s) {
  if (isAtRest()) return;
  const double step_s = tick_s / method_.substeps;
  for (int i = 0; i < method_.substeps; ++i)
    integrator_->step(bodies_, active_, start_s + i * step_s, step_s);
}

void Block::advance(Tick first, Tick ticks, double tick_s, Snapshot& before) {
  for (Tick tick = first; tick < first + ticks; ++tick) {
    if (isAtRest()) return;
    before.take(bodies_);
    step(static_cast<double>(tick) * tick_s, tick_s);
    freezeWhatIsNotFinite(tick, before);
  }
}

std::optional<Fault> Block::tooStiff(double time_s, double tick_s) const {
  const Instant now(bodies_, time_s);
  if (auto fault = oneTooStiff(method_, effects_, now, tick_s)) return fault;
  return stoppedAtOnce(method_, effects_, now, tick_s);
}

void Block::freezeWhatIsNotFinite(Tick tick, const Snapshot& before) {
  for (const FrozenBody& frozen : frozen_) before.restore(frozen.body, bodies_);
  if (batch::kernels().areFinite(columnsOf(bodies_), rigid_body_sim::allOf(bodies_))) return;
  for (Eigen::Index i = 0; i < bodies_.count(); ++i) {
    if (isFinite(bodies_.state(i))) continue;
    before.restore(i, bodies_);
    frozen_.push_back({i, tick});
  }
}

std::vector<Placed> blocksOf(const Scene& scene, const Bodies& bodies) {
  std::vector<Placed> blocks;
  for (const MethodOfBodies& part : methodsOf(scene)) {
    std::vector<Eigen::Index> indices = part.bodies.empty() ? allOf(scene) : part.bodies;
    const bool has_common_steps = integratorNamed(part.method.integrator).order == 0;
    std::vector<Placed> some;
    if (indices.size() > kBlockSize && !has_common_steps)
      some = dividedPart(part, scene, bodies, indices);
    if (some.empty())
      some.push_back(placed(part, scene, bodies, std::move(indices), effectsOn(part, scene)));
    std::move(some.begin(), some.end(), std::back_inserter(blocks));
  }
  return blocks;
}

}  // namespace rigid_body_sim

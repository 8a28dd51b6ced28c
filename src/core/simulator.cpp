#include "rigid_body_sim/simulator.hpp"

#include <algorithm>
#include <iterator>
#include <map>
#include <stdexcept>
#include <utility>

#include "core/accuracy_plan.hpp"
#include "core/accuracy_watch.hpp"
#include "core/block.hpp"
#include "core/crew.hpp"
#include "core/rehearsal.hpp"
#include "core/suitability.hpp"
#include "rigid_body_sim/conserved.hpp"

namespace rigid_body_sim {
namespace {

/// From where on a second thread is worth waking: measured on two cores, a step of semi_implicit
/// then takes 0.70 of the time, of half as many bodies 0.95.
constexpr Eigen::Index kManyBodies = 2000;

void copyState(const Bodies& from, Bodies& to) {
  to.p_WBcm = from.p_WBcm;
  to.q_WB = from.q_WB;
  to.P_WB = from.P_WB;
  to.L_WBcm_W = from.L_WBcm_W;
  to.p_low = from.p_low;
}

/// Every frame of every body becomes a frame of one tree.
void requireUniqueFrames(const Scene& scene) {
  std::map<std::string, std::string> owners;  // body by frame
  const auto add = [&](const std::string& frame, const std::string& body) {
    const auto [found, is_new] = owners.emplace(frame, body);
    if (!is_new)
      throw std::invalid_argument("frame '" + frame + "' is there twice: in '" + found->second +
                                  "' and in '" + body + "'");
  };
  for (const SceneBody& body : scene.bodies) {
    add(body.name, body.name);
    add(comFrameName(body.name), body.name);
    for (const FixedFrame& frame : body.frames) add(frame.name, body.name);
  }
}

/// Scaled, sheared or left-handed poses are none. One made of doubles is off by some 1e-15, one
/// made of floats by 1e-7 and refused.
void requireRigid(const SceneBody& body) {
  const Matrix3d R_WL = body.X_WL.linear();
  const double off = (R_WL * R_WL.transpose() - Matrix3d::Identity()).cwiseAbs().maxCoeff();
  if (!(off < 1e-9) || R_WL.determinant() < 0 || !body.X_WL.translation().allFinite())
    throw std::invalid_argument("body '" + body.name + "': its pose is no rigid transform");
}

}  // namespace

Simulator::Simulator(Scene scene, std::function<bool()> shall_end)
    : scene_(std::move(scene)), shall_end_(std::move(shall_end)) {
  if (scene_.bodies.empty()) throw std::invalid_argument("the scene has no body");
  if (scene_.step_ns <= 0) throw std::invalid_argument("the step must be positive");
  if (scene_.threads < 0) throw std::invalid_argument("threads must not be negative");
  requireUniqueFrames(scene_);
  for (const auto& effect : scene_.effects)
    if (!effect) throw std::invalid_argument("an effect of the scene is null");
  initial_ = Bodies(static_cast<Eigen::Index>(scene_.bodies.size()));
  initial_.mass.setOnes();
  for (const SceneBody& body : scene_.bodies) addBody(body);
  bodies_ = initial_;
  const bool are_many = initial_.count() >= kManyBodies;
  if (scene_.threads > 1 || (scene_.threads == 0 && are_many))
    crew_ = std::make_unique<Crew>(scene_.threads);
  if (scene_.accuracy) {
    Bill bill = planFrom({scene_, bodies_, *applied_, tick_, shall_end_}, *scene_.accuracy,
                         WithoutAMethod::kRefuse);
    scene_.methods = methodsOf(bill);
    watch_ = std::make_unique<AccuracyWatch>(std::move(bill), scene_);
  }
  for (std::string& warning : requireSuitableMethods(scene_, bodies_))
    scene_.warnings.push_back(std::move(warning));
  if (!scene_.accuracy)
    if (const auto trouble = firstTrouble(scene_, bodies_))
      scene_.warnings.push_back(toText(*trouble, scene_));
  at_start_ = {scene_.effects, scene_.gyroscopic};
  start_warnings_ = scene_.warnings.size();
  if (scene_.effects.empty() && initial_.P_WB.isZero(0) && initial_.L_WBcm_W.isZero(0))
    scene_.elided.push_back(
        "motion: all bodies start at rest and nothing acts on them; nothing is computed until "
        "something does");
  makeBlocks();
  start_energy_J_ = initial_energy_J_ = energy().kinetic_J + energy().potential_J;
}

Simulator::~Simulator() = default;
Simulator::Simulator(Simulator&&) noexcept = default;
Simulator& Simulator::operator=(Simulator&&) noexcept = default;

void Simulator::addBody(const SceneBody& body) {
  requireRigid(body);
  const auto i = static_cast<Eigen::Index>(frames_.size());
  frames_.push_back(rigid_body_sim::bodyFrame(body));
  initial_.mass(i) = frames_.back().mass;
  initial_.I_BBcm_B.row(i) = frames_.back().I_BBcm_B;
  if (frames_.back().has_added_mass)
    initial_.setInverseMass(i, frames_.back().mass_matrix_B.inverse());
  else if (initial_.hasAddedMass())  // of an earlier body; that did not know this one's mass yet
    initial_.setInverseMass(i, Matrix3d::Identity() / initial_.mass(i));
  const BodyState state = stateOfLink(frames_.back(), body.X_WL, body.v_WBcm,
                                      body.is_point_mass ? Vector3d::Zero() : body.w_WB_L);
  if (!isFinite(state))
    throw std::invalid_argument("body '" + body.name + "': its initial momentum is not finite");
  initial_.setState(i, state);
}

/// From the state in bodies_.
void Simulator::makeBlocks() {
  for (const Placed& one : blocks_) addUp(one.block.counts(), counts_);
  blocks_ = blocksOf(scene_, bodies());
  places_.resize(scene_.bodies.size());
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    const std::vector<Eigen::Index>& indices = blocks_[b].indices;
    for (std::size_t k = 0; k < indices.size(); ++k)
      places_[indices[k]] = {b, static_cast<Eigen::Index>(k)};
    if (scene_.energy_audit) blocks_[b].block.beginAudit();
  }
  for (const FrozenBody& frozen : frozen_) {
    const Place place = places_[frozen.body];
    blocks_[place.block].block.freeze({place.row, frozen.tick});
  }
  holdWrenches();
}

const Bodies& Simulator::bodies() const {
  if (is_up_to_date_) return bodies_;
  for (const Placed& one : blocks_) {
    const Bodies& from = one.block.bodies();
    if (blocks_.size() == 1 && one.indices.front() == 0) {  // of all, in their order
      copyState(from, bodies_);
      break;
    }
    for (std::size_t k = 0; k < one.indices.size(); ++k)
      bodies_.setState(one.indices[k], from.state(static_cast<Eigen::Index>(k)));
  }
  is_up_to_date_ = true;
  return bodies_;
}

BodyState Simulator::state(Eigen::Index body) const {
  const Place place = places_[body];
  return blocks_[place.block].block.bodies().state(place.row);
}

void Simulator::setState(Eigen::Index body, const BodyState& state) {
  const Place place = places_[body];
  blocks_[place.block].block.setState(place.row, state);
  is_up_to_date_ = false;
}

void Simulator::advance(Tick ticks) {
  if (ticks < 0) throw std::invalid_argument("simulated time does not run backwards");
  ended_.clear();
  for (Tick done = 0, some; done < ticks; done += some) {
    latchInputs();
    some = ticks - done == 1 ? 1 : ticksWithoutInput(ticks - done);
    if (watch_) {
      watch_->beginTick({scene_, bodies(), *applied_, tick_});
      replanIfDue();
    }
    advanceBlocks(some);
    noteFrozenBodies();
    if (watch_) watch_->endTick(bodies(), frozen_, tick_);
    tick_ += some;
  }
}

void Simulator::advanceBlocks(Tick ticks) {
  const auto advance = [&](std::size_t first, std::size_t last) {
    thread_local Snapshot before;
    for (std::size_t b = first; b < last; ++b)
      blocks_[b].block.advance(tick_, ticks, scene_.step_s(), before);
  };
  constexpr std::size_t kLeast = 4;  // blocks: some 5 us of work
  if (crew_ && blocks_.size() > kLeast)
    crew_->share(blocks_.size(), kLeast, advance);
  else
    advance(0, blocks_.size());
  is_up_to_date_ = false;
}

/// Those that the latest ticks froze. A body that an impulse made infinite goes back to before it.
void Simulator::noteFrozenBodies() {
  const std::size_t known = frozen_.size();
  std::size_t count = 0;
  for (const Placed& one : blocks_) count += one.block.frozen().size();
  if (count == known) return;
  frozen_.clear();
  for (const Placed& one : blocks_)
    for (const FrozenBody& frozen : one.block.frozen())
      frozen_.push_back({one.indices[frozen.body], frozen.tick});
  std::sort(frozen_.begin(), frozen_.end(), [](const FrozenBody& a, const FrozenBody& b) {
    return std::tie(a.tick, a.body) < std::tie(b.tick, b.body);
  });
  for (auto frozen = frozen_.begin() + static_cast<std::ptrdiff_t>(known); frozen != frozen_.end();
       ++frozen)
    for (const auto& [body, state] : before_impulses_)
      if (body == frozen->body && frozen->tick == tick_) setState(body, state);
}

void Simulator::replanIfDue() {
  const std::optional<Eigen::Index> body = watch_->bodyToReplan();
  if (!body) return;
  const Situation now = {scene_, bodies(), *applied_, tick_, shall_end_};
  watch_->replan(planAgain(watch_->state().bill, now, *body), *body);
  scene_.methods = methodsOf(watch_->state().bill);
  makeBlocks();
}

std::vector<EffectCount> Simulator::effectCounts() const {
  std::vector<EffectCount> counts = counts_;
  for (const Placed& one : blocks_) addUp(one.block.counts(), counts);
  return counts;
}

EnergyBalance Simulator::energy() const {
  EnergyBalance energy;
  energy.kinetic_J = kineticEnergy(bodies());
  const Instant now(bodies(), time_s());
  for (const auto& effect : scene_.effects) energy.potential_J += effect->potentialEnergy(now);
  energy.start_J = start_energy_J_;
  energy.inputs_J = impulse_work_J_;
  for (const EffectCount& count : effectCounts())
    (count.name == applied_->name() ? energy.inputs_J : energy.effects_J) += count.work_J;
  return energy;
}

std::vector<WrenchesOfEffect> Simulator::effectWrenches() const {
  std::vector<WrenchesOfEffect> all;
  const Instant now(bodies(), time_s());
  const auto add = [&](const Effect& effect) {
    all.push_back({effect.name(), {}});
    all.back().wrenches.setZero(now.bodies().count());
    effect.addWrenches(now, all.back().wrenches);
  };
  for (const auto& effect : scene_.effects) add(*effect);
  if (applied_->bodyCount() > 0) add(*applied_);
  return all;
}

Wrench Simulator::wrenchOn(Eigen::Index body) const {
  Wrench sum;
  for (const WrenchesOfEffect& one : effectWrenches()) {
    sum.f_F += one.wrenches.f_W.row(body);
    sum.t_Q_F += one.wrenches.t_Bcm_W.row(body);
  }
  return sum;
}

const AccuracyState* Simulator::accuracy() const { return watch_ ? &watch_->state() : nullptr; }

void Simulator::reset() {
  copyState(initial_, bodies_);
  is_up_to_date_ = true;
  frozen_.clear();
  applied_->clear();
  if (watch_ && watch_->reset(tick_ + 1)) scene_.methods = methodsOf(watch_->state().bill);
  scene_.effects = at_start_.effects;
  scene_.gyroscopic = at_start_.gyroscopic;
  scene_.warnings.resize(start_warnings_);
  makeBlocks();
  start_energy_J_ = initial_energy_J_;
  counts_.clear();
  impulse_work_J_ = 0;
  pending_wrenches_.clear();
  pending_impulses_.clear();
  ended_.clear();
  ++tick_;
}

std::optional<OverTurnedBody> Simulator::overTurnedBody() const {
  std::optional<OverTurnedBody> worst;
  for (const Placed& one : blocks_) {
    const Method& method = one.block.method();
    const double max_turn = integratorNamed(method.integrator).max_turn;
    const FastestBody fastest = fastestOf(one.block.bodies());
    const double turn = fastest.rate * scene_.step_s() / method.substeps;
    if (turn > max_turn && (!worst || turn / max_turn > worst->turn / worst->max_turn))
      worst = {one.indices[fastest.body], method, turn, max_turn};
  }
  return worst;
}

std::optional<StiffBody> Simulator::stiffBody() const {
  for (const Placed& one : blocks_)
    if (const auto fault = one.block.tooStiff(time_s(), scene_.step_s()))
      return StiffBody{one.indices[fault->body], fault->why};
  return std::nullopt;
}

LinkMotion Simulator::linkMotion(Eigen::Index body) const {
  return rigid_body_sim::linkMotion(frames_[body], state(body));
}

}  // namespace rigid_body_sim

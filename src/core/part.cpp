#include "core/part.hpp"

#include <cstdint>
#include <numeric>
#include <stdexcept>
#include <utility>

namespace rigid_body_sim {

std::optional<Part> partOf(const Situation& now, const std::vector<Eigen::Index>& bodies) {
  auto effects = restrictedTo(now.scene.effects, bodies);
  if (!effects) return std::nullopt;
  if (auto held = now.held.restrictedTo(bodies); held->bodyCount() > 0)
    effects->push_back(std::move(held));
  return Part{bodies,
              rowsOf(now.bodies, bodies),
              std::move(*effects),
              ungyroscopicBodies(now.scene, bodies),
              now.scene.step_s(),
              now.tick,
              now.shall_end};
}

Part wholeOf(const Situation& now) {
  std::vector<Eigen::Index> all(static_cast<std::size_t>(now.bodies.count()));
  std::iota(all.begin(), all.end(), Eigen::Index(0));
  EffectList effects = now.scene.effects;
  if (auto held = now.held.restrictedTo(all); held->bodyCount() > 0)
    effects.push_back(std::move(held));
  return {std::move(all),     now.bodies, std::move(effects), ungyroscopicBodies(now.scene),
          now.scene.step_s(), now.tick,   now.shall_end};
}

Flight::Flight(const Part& part, const Method& method)
    : block_(method, part.ungyroscopic, part.effects, part.bodies),
      tick_(part.tick),
      tick_s_(part.tick_s),
      shall_end_(part.shall_end) {}

void Flight::step() {
  constexpr double kOften = 1000;  // steps of a body: a hundredth of a second, more or less
  unasked_ += static_cast<double>(block_.method().substeps * bodies().count());
  if (unasked_ > kOften && shall_end_) {
    unasked_ = 0;
    if (shall_end_())
      throw std::invalid_argument("ended while methods were chosen for the accuracy");
  }
  block_.step(static_cast<double>(tick_) * tick_s_, tick_s_);
  ++tick_;
}

std::vector<Tick> ticksToCompare(Tick ticks, Tick every) {
  // Weyl's sequence: the multiples of the golden ratio, modulo one, in units of 2^-32.
  constexpr std::uint64_t kGoldenRatio = 2654435769;
  std::vector<Tick> chosen = {0};
  for (Tick start = 0; start < ticks; start += every) {
    const std::uint64_t place = static_cast<std::uint32_t>(chosen.size() * kGoldenRatio);
    chosen.push_back(start + 1 +
                     static_cast<Tick>((place * static_cast<std::uint64_t>(every)) >> 32));
  }
  if (ticks > 0) chosen.back() = ticks;
  return chosen;
}

Trajectory fly(const Part& part, const Method& method, Tick ticks, Tick every) {
  Flight flight(part, method);
  Trajectory trajectory = {every, {}};
  Tick flown = 0;
  for (const Tick tick : ticksToCompare(ticks, every)) {
    for (; flown < tick; ++flown) flight.step();
    trajectory.samples.push_back(flight.bodies());
  }
  return trajectory;
}

TrueTrajectory flyTruly(const Part& part, Tick ticks, Tick every) {
  return truest([&](const Method& method) { return fly(part, method, ticks, every); },
                part.effects.empty(), static_cast<double>(ticks) * part.tick_s);
}

}  // namespace rigid_body_sim

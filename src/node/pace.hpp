#pragma once

#include <algorithm>
#include <cstdint>
#include <utility>

namespace rigid_body_sim {

/// When the next tick is due, on a steady clock. A loop that is late catches up by running at most
/// five ticks without waiting; when it is later than that, the lost time is given up: the
/// simulation is slower then, never wrong.
class Pace {
 public:
  static constexpr std::int64_t kCatchUpTicks = 5;

  /// @param period_ns wall time a tick; 0: never wait
  explicit Pace(std::int64_t period_ns) : period_ns_(period_ns) {}

  /// The next tick is due one period from now.
  void restart(std::int64_t now_ns) { due_ns_ = now_ns + period_ns_; }

  /// How long to wait for the next tick [ns]; not positive: it is due.
  std::int64_t untilDue(std::int64_t now_ns) const {
    return period_ns_ == 0 ? 0 : due_ns_ - now_ns;
  }

  /// A tick was published.
  void tickDone(std::int64_t now_ns) {
    latest_ns_ = std::max(latest_ns_, now_ns - due_ns_);
    due_ns_ += period_ns_;
    if (now_ns > due_ns_) ++overruns_;
    if (now_ns - due_ns_ <= kCatchUpTicks * period_ns_) return;
    due_ns_ = now_ns;
    ++rebases_;
  }

  std::uint64_t overruns() const {
    return period_ns_ == 0 ? 0 : overruns_;
  }  ///< ticks more than a period late
  std::uint64_t rebases() const {
    return period_ns_ == 0 ? 0 : rebases_;
  }  ///< times that lost time was given up

  /// How much after it was due the latest tick was published, of those since the last call; 0 if
  /// none waits [ns].
  std::int64_t takeLatest() { return period_ns_ == 0 ? 0 : std::exchange(latest_ns_, 0); }

 private:
  std::int64_t period_ns_;
  std::int64_t due_ns_ = 0;
  std::uint64_t overruns_ = 0;
  std::uint64_t rebases_ = 0;
  std::int64_t latest_ns_ = 0;
};

}  // namespace rigid_body_sim

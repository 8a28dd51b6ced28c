#pragma once

#include <functional>
#include <memory>

namespace rigid_body_sim {

/// Threads that share work among them (oneTBB). They sleep when there is none.
class Crew {
 public:
  /// @param threads how many, with the one that calls; 0: as many as the processor has
  explicit Crew(int threads);
  ~Crew();

  int threads() const;

  /// Calls `work(first, last)` for parts of [0, count), none smaller than `least` unless it is all,
  /// from several threads at the same time. Returns when all is done.
  void share(std::size_t count, std::size_t least,
             const std::function<void(std::size_t, std::size_t)>& work);

 private:
  struct Arena;
  std::unique_ptr<Arena> arena_;
};

}  // namespace rigid_body_sim

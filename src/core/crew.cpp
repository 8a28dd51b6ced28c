#include "core/crew.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <thread>

namespace rigid_body_sim {

struct Crew::Arena {
  tbb::task_arena tasks;
};

Crew::Crew(int threads) : arena_(std::make_unique<Arena>()) {
  if (threads == 0) threads = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  arena_->tasks.initialize(threads);
}

Crew::~Crew() = default;

int Crew::threads() const { return arena_->tasks.max_concurrency(); }

void Crew::share(std::size_t count, std::size_t least,
                 const std::function<void(std::size_t, std::size_t)>& work) {
  arena_->tasks.execute([&] {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, least),
                      [&](const auto& part) { work(part.begin(), part.end()); });
  });
}

}  // namespace rigid_body_sim

#if defined(__x86_64__)

#include "integrators/batch/instruction_sets.hpp"
#include "integrators/batch/table.hpp"

namespace rigid_body_sim::batch {

void fillSse2(Kernels& table) {
  table.name = "sse2";
  fillTable<Pair<Pack<2>>>(table);
}

}  // namespace rigid_body_sim::batch

#endif

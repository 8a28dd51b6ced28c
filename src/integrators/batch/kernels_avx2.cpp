#if defined(__x86_64__)

#include "integrators/batch/instruction_sets.hpp"
#include "integrators/batch/table.hpp"

namespace rigid_body_sim::batch {

void fillAvx2(Kernels& table) {
  table.name = "avx2";
  fillTable<Pair<Pack<4>>>(table);
}

}  // namespace rigid_body_sim::batch

#endif

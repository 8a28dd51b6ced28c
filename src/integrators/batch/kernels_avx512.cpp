#if defined(__x86_64__)

#include "integrators/batch/instruction_sets.hpp"
#include "integrators/batch/table.hpp"

namespace rigid_body_sim::batch {

void fillAvx512(Kernels& table) {
  table.name = "avx512";
  fillTable<Pair<Pack<8>>>(table);
}

}  // namespace rigid_body_sim::batch

#endif

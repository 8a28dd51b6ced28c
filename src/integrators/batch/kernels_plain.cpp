#include "integrators/batch/instruction_sets.hpp"
#include "integrators/batch/table.hpp"

namespace rigid_body_sim::batch {

void fillPlain(Kernels& table) {
  table.name = "plain";
  fillTable<double>(table);
}

}  // namespace rigid_body_sim::batch

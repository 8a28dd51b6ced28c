#pragma once

#include "integrators/batch/kernels.hpp"

namespace rigid_body_sim::batch {

// Each is in a source file of its own, compiled for its instruction set.
void fillPlain(Kernels& table);
void fillSse2(Kernels& table);
void fillAvx2(Kernels& table);
void fillAvx512(Kernels& table);

}  // namespace rigid_body_sim::batch

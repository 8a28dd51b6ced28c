#include "integrators/batch/kernels.hpp"

#include <cstdlib>
#include <stdexcept>
#include <string>

#include "integrators/batch/instruction_sets.hpp"

namespace rigid_body_sim::batch {
namespace {

std::vector<Kernels> makeAvailable() {
  std::vector<Kernels> all;
  const auto add = [&](void (*fill)(Kernels&)) { fill(all.emplace_back()); };
  add(fillPlain);
#if defined(__x86_64__)
  add(fillSse2);
  __builtin_cpu_init();
  if (__builtin_cpu_supports("avx2")) add(fillAvx2);
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq")) add(fillAvx512);
#endif
  return all;
}

const Kernels& choose() {
  const std::vector<Kernels>& all = availableKernels();
  const char* wanted = std::getenv("RIGID_BODY_SIM_KERNELS");
  if (!wanted) return all.back();
  std::string names;
  for (const Kernels& one : all) {
    if (std::string(one.name) == wanted) return one;
    names += std::string(names.empty() ? "" : ", ") + one.name;
  }
  throw std::runtime_error("RIGID_BODY_SIM_KERNELS=" + std::string(wanted) +
                           ": this processor has " + names);
}

}  // namespace

const std::vector<Kernels>& availableKernels() {
  static const std::vector<Kernels> kAll = makeAvailable();
  return kAll;
}

const Kernels& kernels() {
  static const Kernels& chosen = choose();
  return chosen;
}

}  // namespace rigid_body_sim::batch

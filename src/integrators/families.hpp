#pragma once

#include <memory>

#include "rigid_body_sim/integrator.hpp"

// The makers of all methods, for the registry; each family has its own source file.
namespace rigid_body_sim {

std::unique_ptr<Integrator> makeExplicitEulerVelocity(const IntegratorOptions& options);
std::unique_ptr<Integrator> makeSemiImplicitVelocity(const IntegratorOptions& options);
std::unique_ptr<Integrator> makeSplit2(const IntegratorOptions& options);
std::unique_ptr<Integrator> makeExact(const IntegratorOptions& options);

}  // namespace rigid_body_sim

#pragma once

#include <memory>

#include "rigid_body_sim/integrator.hpp"

// The makers of all methods, for the registry; each family has its own source file.
namespace rigid_body_sim {

std::unique_ptr<Integrator> makeExplicitEulerVelocity(const IntegratorOptions& options);
std::unique_ptr<Integrator> makeSemiImplicitVelocity(const IntegratorOptions& options);
std::unique_ptr<Integrator> makeSemiImplicitNewton(const IntegratorOptions& options);
std::unique_ptr<Integrator> makeExplicitEuler(const IntegratorOptions& options);
std::unique_ptr<Integrator> makeSemiImplicit(const IntegratorOptions& options);
std::unique_ptr<Integrator> makeSplit2(const IntegratorOptions& options);
std::unique_ptr<Integrator> makeRk4(const IntegratorOptions& options);
std::unique_ptr<Integrator> makeRk8(const IntegratorOptions& options);
std::unique_ptr<Integrator> makeExact(const IntegratorOptions& options);
std::unique_ptr<Integrator> makeExact4(const IntegratorOptions& options);
std::unique_ptr<Integrator> makeExact6(const IntegratorOptions& options);
std::unique_ptr<Integrator> makeAdaptive(const IntegratorOptions& options);

}  // namespace rigid_body_sim

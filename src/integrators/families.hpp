#pragma once

#include <memory>

#include "rigid_body_sim/integrator.hpp"

// The makers of all methods, for the registry; each family has its own source file.
namespace rigid_body_sim {

std::unique_ptr<Integrator> makeExplicitEulerVelocity(Gyroscopic gyroscopic);
std::unique_ptr<Integrator> makeSemiImplicitVelocity(Gyroscopic gyroscopic);
std::unique_ptr<Integrator> makeSplit2(Gyroscopic gyroscopic);
std::unique_ptr<Integrator> makeExact(Gyroscopic gyroscopic);

}  // namespace rigid_body_sim

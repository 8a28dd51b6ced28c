#include "core/scene_body.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <stdexcept>

namespace rigid_body_sim {
namespace {

/// Three numbers are the diagonal, six the tensor elements in URDF's order: ixx ixy ixz iyy iyz
/// izz.
Matrix3d readTensor(const Parameters& block) {
  const std::vector<double> e = block.numbers("inertia", {3, 6}, finite("kg m^2"));
  Matrix3d tensor;
  if (e.size() == 3)
    tensor = Vector3d(e[0], e[1], e[2]).asDiagonal();
  else
    tensor << e[0], e[1], e[2], e[1], e[3], e[4], e[2], e[4], e[5];
  return tensor;
}

MassProperties readNumbers(const Parameters& block) {
  MassProperties body;
  body.mass = block.number("mass", positive("kg"));
  body.p_FBcm = block.vector3("com", finite("m"), Vector3d::Zero());
  body.I_BBcm_F = readTensor(block);
  return body;
}

MassProperties readShape(const Parameters& block, const std::string& shape) {
  const Parameters numbers = block.child(shape);
  const double density = numbers.number("density", positive("kg/m^3"));
  MassProperties body;
  if (shape == "box") {
    body = solidBox(numbers.vector3("size", positive("m")), density);
  } else {
    const double radius = numbers.number("radius", positive("m"));
    body = shape == "sphere"
               ? solidSphere(radius, density)
               : solidCylinder(radius, numbers.number("length", positive("m")), density);
  }
  numbers.refuseUnknown();
  return body;
}

MassProperties readParticles(const Parameters& block) {
  std::vector<Particle> particles;
  for (const Parameters& particle : block.children("particles")) {
    particles.push_back(
        {particle.number("mass", positive("kg")), particle.vector3("position", finite("m"))});
    particle.refuseUnknown();
  }
  return massPropertiesOfParticles(particles);
}

constexpr const char* kWays[] = {"mass", "box", "sphere", "cylinder", "particles", "point_mass"};

}  // namespace

bool saysWhatItIs(const Parameters& block) {
  return std::any_of(std::begin(kWays), std::end(kWays),
                     [&](const char* way) { return block.has(way); });
}

SceneBody bodyFromNumbers(const Parameters& block, const std::string& name) {
  requireName(name, "body");
  SceneBody body;
  body.name = name;
  std::string found;
  for (const std::string way : kWays) {
    if (!block.has(way)) continue;
    if (!found.empty()) block.refuse(way, "the body already has '" + found + "'; give one of them");
    found = way;
  }
  if (found.empty()) {
    throw std::invalid_argument(
        "bodies." + name +
        ": no URDF has a root link of this name, and there is no mass, box, "
        "sphere, cylinder, particles or point_mass");
  }
  if (found == "mass") {
    body.mass_properties = readNumbers(block);
  } else if (found == "particles") {
    body.mass_properties = readParticles(block);
  } else if (found == "point_mass") {
    body.mass_properties.mass = block.number("point_mass", positive("kg"));
    body.is_point_mass = true;
    return body;
  } else {
    body.mass_properties = readShape(block, found);
  }
  const std::string why = invalidity(body.mass_properties);
  if (!why.empty()) block.refuse(found == "mass" ? "inertia" : found, why);
  return body;
}

void readInitialMotion(const Parameters& block, SceneBody& body) {
  body.X_WL.translation() =
      block.vector3("position", finite("m"), Vector3d(body.X_WL.translation()));
  if (block.has("orientation")) {
    const std::vector<double> xyzw = block.numbers("orientation", {4}, finite("x, y, z, w"));
    const Quaterniond q_WL(xyzw[3], xyzw[0], xyzw[1], xyzw[2]);
    // Typed numbers are rounded; more than a percent off is a mistake.
    if (std::abs(q_WL.norm() - 1) > 0.01)
      block.refuse("orientation",
                   "a unit quaternion x, y, z, w is wanted, this one has the length " +
                       std::to_string(q_WL.norm()));
    body.X_WL.linear() = q_WL.normalized().toRotationMatrix();
  }
  body.v_WBcm = block.vector3("linear_velocity", finite("m/s"), Vector3d::Zero());
  if (body.is_point_mass && block.has("angular_velocity"))
    block.refuse("angular_velocity", "a point mass has no rotation");
  body.w_WB_L = block.vector3("angular_velocity", finite("rad/s"), Vector3d::Zero());
}

}  // namespace rigid_body_sim

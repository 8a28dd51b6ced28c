#include "rigid_body_sim/mass_properties.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <sstream>
#include <stdexcept>

namespace rigid_body_sim {
namespace {

constexpr double kPi = 3.14159265358979323846;

/// Relative slack of the triangle inequality, for numbers that were rounded to seven digits. A flat
/// plate rounded to six may fail it; it is refused with the nearest tensor that does not.
constexpr double kTriangleSlack = 1e-6;

void requirePositive(double value, const char* what) {
  if (!(value > 0) || !std::isfinite(value)) {
    std::ostringstream message;
    message << what << " is " << value << ", must be positive and finite";
    throw std::invalid_argument(message.str());
  }
}

/// Tensor of a mass concentrated at r, about the origin: m (r.r E - r r^T).
Matrix3d pointInertia(double mass, const Vector3d& r) {
  return mass * (r.squaredNorm() * Matrix3d::Identity() - r * r.transpose());
}

/// Flips columns of `axes` so that they are right-handed and, of the four ways to be so, the one
/// with the largest trace, that is the smallest angle of rotation from identity.
Matrix3d nearestRightHanded(const Matrix3d& axes) {
  Matrix3d best = axes;
  double best_trace = -4;  // below any trace of a rotation
  for (int signs = 0; signs < 8; ++signs) {
    const Vector3d flip((signs & 1) ? -1 : 1, (signs & 2) ? -1 : 1, (signs & 4) ? -1 : 1);
    const Matrix3d candidate = axes * flip.asDiagonal();
    if (candidate.determinant() < 0 || candidate.trace() <= best_trace) continue;
    best_trace = candidate.trace();
    best = candidate;
  }
  return best;
}

}  // namespace

MassProperties massPropertiesOfParticles(const std::vector<Particle>& particles) {
  if (particles.empty()) throw std::invalid_argument("no particle");
  std::vector<MassProperties> parts;
  parts.reserve(particles.size());
  for (const Particle& particle : particles) {
    requirePositive(particle.mass, "mass of a particle");
    parts.push_back({particle.mass, particle.p_FQ, Matrix3d::Zero()});
  }
  return combined(parts);
}

MassProperties solidBox(const Vector3d& size, double density) {
  for (int i = 0; i < 3; ++i) requirePositive(size(i), "size of a box");
  requirePositive(density, "density");
  MassProperties box;
  box.mass = density * size.prod();
  const Vector3d squares = size.cwiseProduct(size);
  for (int i = 0; i < 3; ++i)
    box.I_BBcm_F(i, i) = box.mass / 12 * (squares((i + 1) % 3) + squares((i + 2) % 3));
  return box;
}

MassProperties solidSphere(double radius, double density) {
  requirePositive(radius, "radius");
  requirePositive(density, "density");
  MassProperties sphere;
  sphere.mass = density * (4.0 / 3.0) * kPi * radius * radius * radius;
  sphere.I_BBcm_F = 0.4 * sphere.mass * radius * radius * Matrix3d::Identity();
  return sphere;
}

MassProperties solidCylinder(double radius, double length, double density) {
  requirePositive(radius, "radius");
  requirePositive(length, "length");
  requirePositive(density, "density");
  MassProperties cylinder;
  cylinder.mass = density * kPi * radius * radius * length;
  const double across = cylinder.mass / 12 * (3 * radius * radius + length * length);
  cylinder.I_BBcm_F.diagonal() << across, across, cylinder.mass / 2 * radius * radius;
  return cylinder;
}

MassProperties expressedIn(const Isometry3d& X_GF, const MassProperties& body_F) {
  const Matrix3d R_GF = X_GF.linear();
  return {body_F.mass, X_GF * body_F.p_FBcm, R_GF * body_F.I_BBcm_F * R_GF.transpose()};
}

MassProperties combined(const std::vector<MassProperties>& parts) {
  MassProperties sum;
  Vector3d first_moment = Vector3d::Zero();
  for (const MassProperties& part : parts) {
    sum.mass += part.mass;
    first_moment += part.mass * part.p_FBcm;
  }
  if (sum.mass == 0) return {};
  sum.p_FBcm = first_moment / sum.mass;
  for (const MassProperties& part : parts) {
    if (part.mass == 0) continue;
    sum.I_BBcm_F += part.I_BBcm_F + pointInertia(part.mass, part.p_FBcm - sum.p_FBcm);
  }
  return sum;
}

Matrix3d inertiaAboutPoint(const MassProperties& body, const Vector3d& p_FQ) {
  return body.I_BBcm_F + pointInertia(body.mass, body.p_FBcm - p_FQ);
}

double inertiaAboutAxis(const MassProperties& body, const Vector3d& p_FQ,
                        const Vector3d& direction) {
  const double length = direction.norm();
  if (!(length > 0) || !std::isfinite(length))
    throw std::invalid_argument("direction of an axis must be finite and not zero");
  const Vector3d u = direction / length;
  return u.dot(inertiaAboutPoint(body, p_FQ) * u);
}

PrincipalInertia principalInertia(const Matrix3d& I_BBcm_F) {
  Vector3d moments = I_BBcm_F.diagonal();
  Matrix3d axes = Matrix3d::Identity();
  if (I_BBcm_F.isDiagonal(0)) {  // taken as it stands: no solver, no rounding
    std::array<int, 3> order = {0, 1, 2};
    std::stable_sort(order.begin(), order.end(),
                     [&](int i, int j) { return moments(i) < moments(j); });
    for (int i = 0; i < 3; ++i) axes.col(i) = Vector3d::Unit(order[i]);
    moments = axes.transpose() * moments;
  } else {
    // The iterative solver, not the closed form: computeDirect() loses half the digits of a rod's
    // smallest moment.
    const Eigen::SelfAdjointEigenSolver<Matrix3d> solver(I_BBcm_F);
    axes = solver.eigenvectors();
    moments = solver.eigenvalues();
  }
  return {moments, Quaterniond(nearestRightHanded(axes)).normalized()};
}

std::string invalidity(const MassProperties& body) {
  std::ostringstream why;
  if (!(body.mass > 0) || !std::isfinite(body.mass)) {
    why << "mass is " << body.mass << " kg, must be positive and finite";
    return why.str();
  }
  if (!body.p_FBcm.allFinite()) return "centre of mass is not finite";
  if (!body.I_BBcm_F.allFinite()) return "inertia tensor is not finite";
  // What a sum of parts may be off by: sixteen ulps of the largest element.
  const double rounding =
      16 * std::numeric_limits<double>::epsilon() * body.I_BBcm_F.cwiseAbs().maxCoeff();
  if ((body.I_BBcm_F - body.I_BBcm_F.transpose()).cwiseAbs().maxCoeff() > rounding)
    return "inertia tensor is not symmetric";
  const Vector3d moments = principalInertia(body.I_BBcm_F).I_BBcm_B;
  why << "principal moments (" << moments(0) << ", " << moments(1) << ", " << moments(2)
      << ") kg m^2 ";
  // Below the smallest normal number a moment cannot be inverted without loss. A full tensor does
  // not hold a moment below its own rounding: particles in a line leave noise there, of any sign.
  const double least = body.I_BBcm_F.isDiagonal(0)
                           ? std::numeric_limits<double>::min()
                           : std::max(std::numeric_limits<double>::min(), rounding);
  if (!(moments(0) >= least)) {
    why << "must be positive";
    return why.str();
  }
  if (moments(0) + moments(1) < moments(2) * (1 - kTriangleSlack)) {
    why << "break the triangle inequality: " << moments(0) << " + " << moments(1) << " < "
        << moments(2);
    return why.str();
  }
  return {};
}

Matrix3d nearestValidInertia(const Matrix3d& I_BBcm_F) {
  const Matrix3d symmetric = 0.5 * (I_BBcm_F + I_BBcm_F.transpose());
  const Eigen::SelfAdjointEigenSolver<Matrix3d> solver(symmetric);
  // Second moments s_i = sum m x_i^2: I_1 = s_2 + s_3 and so on; mass puts none of them below zero.
  const Vector3d I = solver.eigenvalues();
  const Vector3d s = (Vector3d::Constant(0.5 * I.sum()) - I).cwiseMax(0);
  const Vector3d valid = Vector3d::Constant(s.sum()) - s;
  return solver.eigenvectors() * valid.asDiagonal() * solver.eigenvectors().transpose();
}

}  // namespace rigid_body_sim

// What the mechanism of effects costs: the same bodies under the same effects, stepped by an
// integrator with its list of effects, and by one loop written for just these. For callgrind to
// count the instructions of flyTicks().
//
//   fused free|all list|fused BODIES TICKS
//
// Prints the least time of a body's tick, in 15 runs of at least 20 ticks, and the last state of
// the last body: both ways are the same physics.
#include <algorithm>
#include <cstdlib>
#include <ctime>
#include <iomanip>
#include <iostream>
#include <string>

#include "rigid_body_sim/rotation.hpp"
#include "rigid_body_sim/simulator.hpp"

using namespace rigid_body_sim;

namespace {

constexpr double kStep = 0.02;
const Vector3d kGravity(0.1, -0.2, -9.8), kWind(3, 0, 1), kField(1e-3, 2e-3, -1e-3),
    kDipole(0.1, 0.2, 0.3), kTurn(0, 1e-3, 2e-3), kFluidGravity(0.1, -0.2, -9.8), kAnchor(0, 0, 30),
    kCenter(0, 0, -1e4), kPushF(0.1, 0.2, -0.1), kPushT(0.01, -0.02, 0.01);
constexpr double kLinear = 0.01, kAngular = 0.02, kAir = 1.2, kArea = 0.01, kMu = 1e6, kFluid = 1.2,
                 kVolume = 1e-3, kStiffness = 2, kDashpot = 0.3, kRest = 5;
const Vector3d kBuoyant(0.01, 0.02, 0.03), kHook(0.1, 0.05, -0.08);

const char* const kEffects = R"(
gravity: {acceleration: [0.1, -0.2, -9.8]}
damping: {linear: 0.01, angular: 0.02}
drag: {air_density: 1.2, drag_area: 0.01, wind: [3, 0, 1]}
central_gravity: {mu: 1.0e+6, center: [0, 0, -1.0e+4]}
magnetic_dipole: {field: [1.0e-3, 2.0e-3, -1.0e-3], dipole: [0.1, 0.2, 0.3]}
buoyancy: {fluid_density: 1.2, volume: 1.0e-3, center: [0.01, 0.02, 0.03], acceleration: [0.1, -0.2, -9.8]}
rotating_frame: {angular_velocity: [0, 1.0e-3, 2.0e-3]}
)";

Value number(double x) { return {x}; }
Value list(std::initializer_list<double> numbers) {
  Value::List values;
  for (const double x : numbers) values.push_back(number(x));
  return {values};
}

/// Bodies whose principal axes are those of their links, with their centres of mass at the origin.
Scene sceneOf(int bodies, bool has_effects) {
  Value::Map scene, blocks, effects;
  Value::List springs;
  if (has_effects) effects = std::get<Value::Map>(readYaml(kEffects, "effects").data);
  for (int i = 0; i < bodies; ++i) {
    const std::string name = "b" + std::to_string(i);
    const double x = 0.001 * i;
    blocks[name] = {Value::Map{{"mass", number(2 + x / 100)},
                               {"inertia", list({0.1, 0.2, 0.25})},
                               {"position", list({x, -x, 2 * x})},
                               {"linear_velocity", list({1, 2, 3})},
                               {"angular_velocity", list({1, 2 - x / 10, 3})}}};
    springs.push_back({Value::Map{{"body", {name}},
                                  {"point", list({0.1, 0.05, -0.08})},
                                  {"anchor", list({0, 0, 30})},
                                  {"stiffness", number(2)},
                                  {"damping", number(0.3)},
                                  {"rest_length", number(5)}}});
  }
  if (has_effects) effects["spring"] = {springs};
  scene["bodies"] = {blocks};
  scene["effects"] = {effects};
  return readScene(Parameters({scene}, ""), {});
}

struct Fused {
  static Vector3d vector(const Column3& column, Eigen::Index i) {
    return {column(i, 0), column(i, 1), column(i, 2)};
  }
  static void set(Column3& column, Eigen::Index i, const Vector3d& v) {
    for (int k = 0; k < 3; ++k) column(i, k) = v(k);
  }

  /// Friction and the dashpot for half the step, as they come before the drift or after it.
  static void damp(Vector3d& P, Vector3d& L, double linear, double angular) {
    P *= linear;
    L *= angular;
  }
  static void drag(Vector3d& P, double mass) {
    const Vector3d through = P - mass * kWind;
    const double c_h = 0.5 * kAir * kArea * 0.5 * kStep;
    P = mass * kWind + through / (1 + c_h * (through.norm() / mass) / mass);
  }
  static void dashpot(const Vector3d& p, Vector3d& P, Vector3d& L, const Matrix3d& R,
                      const Vector3d& I, double mass, double drift_s) {
    const Vector3d r = R * kHook, d = kAnchor - p - r;
    const double l2 = d.squaredNorm(), l = std::sqrt(l2);
    const Vector3d n = d / l, arm = r.cross(n);
    const double inverse = 1 / mass + (R * (R.transpose() * arm).cwiseQuotient(I)).dot(arm);
    const Vector3d w = R * (R.transpose() * L).cwiseQuotient(I), turning = w.cross(r);
    const Vector3d v = -(P / mass + turning);
    const double rate = n.dot(v), across2 = std::max(0.0, v.squaredNorm() - rate * rate);
    const double s2 = drift_s * drift_s;
    double wanted = 0;
    if (std::max(w.squaredNorm(), across2 / l2) * s2 < 0.25)
      wanted =
          -drift_s * (across2 / (l + std::sqrt(l2 - across2 * s2)) - 0.5 * n.dot(w.cross(turning)));
    const double impulse =
        -std::expm1(-kDashpot * 0.5 * kStep * inverse) / inverse * (rate - wanted);
    P += impulse * n;
    L += impulse * arm;
  }

  /// Forces and torques that depend on pose alone.
  static void kick(const Vector3d& p, Vector3d& P, Vector3d& L, const Matrix3d& R, double mass) {
    const Vector3d from = p - kCenter;
    const double inverse = 1 / from.norm();
    Vector3d f = mass * kGravity - kMu * mass * (inverse * inverse * inverse) * from;
    f -= kFluid * kVolume * kFluidGravity;
    Vector3d t =
        (R * kDipole).cross(kField) - kFluid * kVolume * (R * kBuoyant).cross(kFluidGravity);
    const Vector3d r = R * kHook, d = kAnchor - p - r;
    const Vector3d pull = kStiffness * (1 - kRest / d.norm()) * d;
    f += pull;
    t += r.cross(pull);
    f += R * kPushF;
    t += R * kPushT;
    P += kStep * f;
    L += kStep * t;
  }

  static void drift(Vector3d& p, const Vector3d& P, Quaterniond& q, const Vector3d& L,
                    const Vector3d& I, double mass) {
    p += (kStep / mass) * P;
    const Vector3d w = (q.conjugate() * L).cwiseQuotient(I);
    q = renormalized(q * rotationExp(kStep * w));
  }

  static void stepAll(Bodies& bodies) {
    const double linear = std::exp(-kLinear * 0.5 * kStep),
                 angular = std::exp(-kAngular * 0.5 * kStep);
    const Quaterniond back = rotationExp(-kStep * kTurn);
    const Matrix3d R_back = back.toRotationMatrix();
    for (Eigen::Index i = 0; i < bodies.count(); ++i) {
      const double mass = bodies.mass(i);
      const Vector3d I = vector(bodies.I_BBcm_B, i);
      Vector3d p = vector(bodies.p_WBcm, i), P = vector(bodies.P_WB, i),
               L = vector(bodies.L_WBcm_W, i);
      Quaterniond q(bodies.q_WB(i, 3), bodies.q_WB(i, 0), bodies.q_WB(i, 1), bodies.q_WB(i, 2));
      Matrix3d R = q.toRotationMatrix();
      kick(p, P, L, R, mass);
      damp(P, L, linear, angular);
      drag(P, mass);
      dashpot(p, P, L, R, I, mass, kStep);
      P += mass * kTurn.cross(p);
      L += R * I.cwiseProduct(R.transpose() * kTurn);
      drift(p, P, q, L, I, mass);
      p = R_back * p;
      P = R_back * P;
      L = R_back * L;
      q = renormalized(back * q);
      R = q.toRotationMatrix();
      P -= mass * kTurn.cross(p);
      L -= R * I.cwiseProduct(R.transpose() * kTurn);
      dashpot(p, P, L, R, I, mass, -kStep);
      drag(P, mass);
      damp(P, L, linear, angular);
      set(bodies.p_WBcm, i, p);
      set(bodies.P_WB, i, P);
      set(bodies.L_WBcm_W, i, L);
      for (int k = 0; k < 4; ++k) bodies.q_WB(i, k) = q.coeffs()(k);
    }
  }

  static void stepFree(Bodies& bodies) {
    for (Eigen::Index i = 0; i < bodies.count(); ++i) {
      Vector3d p = vector(bodies.p_WBcm, i);
      Quaterniond q(bodies.q_WB(i, 3), bodies.q_WB(i, 0), bodies.q_WB(i, 1), bodies.q_WB(i, 2));
      drift(p, vector(bodies.P_WB, i), q, vector(bodies.L_WBcm_W, i), vector(bodies.I_BBcm_B, i),
            bodies.mass(i));
      set(bodies.p_WBcm, i, p);
      for (int k = 0; k < 4; ++k) bodies.q_WB(i, k) = q.coeffs()(k);
    }
  }
};

}  // namespace

/// What is counted; by this name, and never inlined.
extern "C" __attribute__((noinline)) void flyTicks(Integrator* integrator, Bodies& bodies,
                                                   ActiveEffects& effects, int ticks) {
  for (int i = 0; i < ticks; ++i) {
    if (integrator)
      integrator->step(bodies, effects, i * kStep, kStep);
    else if (effects.empty())
      Fused::stepFree(bodies);
    else
      Fused::stepAll(bodies);
  }
}

int main(int count, char** words) {
  if (count != 5) return 2;
  const bool has_effects = words[1] == std::string("all");
  const bool is_fused = words[2] == std::string("fused");
  const Scene scene = sceneOf(std::atoi(words[3]), has_effects);
  Bodies bodies = Simulator(scene).bodies();
  ActiveEffects effects;
  for (const auto& effect : scene.effects) effects.add(effect.get());
  AppliedWrenches applied;
  std::vector<WrenchInput> pushes;
  for (Eigen::Index i = 0; i < bodies.count(); ++i) {
    pushes.emplace_back();
    pushes.back().body = i;
    pushes.back().applied = {Axes::kBody, {kPushF, kPushT}, {0, 0, 0}};
  }
  applied.update(pushes, 0);
  if (has_effects) effects.add(&applied);
  const auto integrator = integratorNamed("semi_implicit").make({});
  flyTicks(is_fused ? nullptr : integrator.get(), bodies, effects, 1);  // the first allocates
  const Bodies start = bodies;
  const int ticks = std::atoi(words[4]);
  double least_ns = 1e300;  // of a body and tick; under valgrind one run of few ticks is enough
  for (int round = 0; round < (ticks < 20 ? 1 : 15); ++round) {
    bodies = start;
    const std::clock_t begin = std::clock();
    flyTicks(is_fused ? nullptr : integrator.get(), bodies, effects, ticks);
    const double ns = 1e9 * static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
    least_ns = std::min(least_ns, ns / ticks / static_cast<double>(bodies.count()));
  }
  std::cout << std::setprecision(4) << least_ns << " ns\n";
  const BodyState last = bodies.state(bodies.count() - 1);
  std::cout << std::setprecision(17) << last.p_WBcm.transpose() << " "
            << last.q_WB.coeffs().transpose() << " " << last.P_WB.transpose() << " "
            << last.L_WBcm_W.transpose() << "\n";
}

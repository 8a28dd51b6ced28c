// The least that a step can be: semi-implicit Euler's method for velocities and a quaternion, in
// one loop over plain arrays that the compiler vectorises for each processor, with nothing around
// it. What the other rows of ours are measured against where memory is the limit.
#include <cmath>
#include <memory>
#include <vector>

#include "peer.hpp"

namespace rigid_body_sim::bench {
namespace {

/// Of every body one number.
using Column = std::vector<double>;

struct Arrays {
  Column mass, I[3], p[3], v[3], q[4], w[3], f[3], t[3];  // w in B, p, v, f and t in W
};

#if defined(__x86_64__)
#define FOR_EACH_PROCESSOR __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#define FOR_EACH_PROCESSOR
#endif

/// One step of h [s] of all. Restricted pointers, as the compiler checks no more than some pairs of
/// arrays for overlap.
FOR_EACH_PROCESSOR void step(Arrays& a, const double g[3], double gyroscopic, double h) {
  const auto n = static_cast<std::ptrdiff_t>(a.mass.size());
  const double *__restrict m = a.mass.data(), *__restrict I1 = a.I[0].data(),
               *__restrict I2 = a.I[1].data(), *__restrict I3 = a.I[2].data(),
               *__restrict f1 = a.f[0].data(), *__restrict f2 = a.f[1].data(),
               *__restrict f3 = a.f[2].data(), *__restrict t1 = a.t[0].data(),
               *__restrict t2 = a.t[1].data(), *__restrict t3 = a.t[2].data();
  double *__restrict p1 = a.p[0].data(), *__restrict p2 = a.p[1].data(),
         *__restrict p3 = a.p[2].data(), *__restrict v1 = a.v[0].data(),
         *__restrict v2 = a.v[1].data(), *__restrict v3 = a.v[2].data(),
         *__restrict w1 = a.w[0].data(), *__restrict w2 = a.w[1].data(),
         *__restrict w3 = a.w[2].data(), *__restrict q1 = a.q[0].data(),
         *__restrict q2 = a.q[1].data(), *__restrict q3 = a.q[2].data(),
         *__restrict q0 = a.q[3].data();
  const double g1 = g[0], g2 = g[1], g3 = g[2];
#pragma GCC ivdep
  for (std::ptrdiff_t i = 0; i < n; ++i) {
    v1[i] += h * (g1 + f1[i] / m[i]);
    v2[i] += h * (g2 + f2[i] / m[i]);
    v3[i] += h * (g3 + f3[i] / m[i]);
    p1[i] += h * v1[i];
    p2[i] += h * v2[i];
    p3[i] += h * v3[i];
    const double x = q1[i], y = q2[i], z = q3[i], s = q0[i];
    // R^T t = t - 2 s u x t + 2 u x (u x t)
    const double c1 = 2 * (y * t3[i] - z * t2[i]), c2 = 2 * (z * t1[i] - x * t3[i]),
                 c3 = 2 * (x * t2[i] - y * t1[i]);
    const double b1 = t1[i] - s * c1 + (y * c3 - z * c2), b2 = t2[i] - s * c2 + (z * c1 - x * c3),
                 b3 = t3[i] - s * c3 + (x * c2 - y * c1);
    const double a1 = w1[i], a2 = w2[i], a3 = w3[i];
    const double r1 = a1 + h * (b1 - gyroscopic * (I3[i] - I2[i]) * a2 * a3) / I1[i],
                 r2 = a2 + h * (b2 - gyroscopic * (I1[i] - I3[i]) * a3 * a1) / I2[i],
                 r3 = a3 + h * (b3 - gyroscopic * (I2[i] - I1[i]) * a1 * a2) / I3[i];
    w1[i] = r1;
    w2[i] = r2;
    w3[i] = r3;
    const double half = 0.5 * h;
    const double nx = x + half * (s * r1 + y * r3 - z * r2),
                 ny = y + half * (s * r2 + z * r1 - x * r3),
                 nz = z + half * (s * r3 + x * r2 - y * r1),
                 ns = s - half * (x * r1 + y * r2 + z * r3);
    const double unit = 1 / std::sqrt(nx * nx + ny * ny + nz * nz + ns * ns);
    q1[i] = unit * nx;
    q2[i] = unit * ny;
    q3[i] = unit * nz;
    q0[i] = unit * ns;
  }
}

Arrays arraysOf(const Scene& scene) {
  const Eigen::Index n = scene.bodies.count();
  Arrays a;
  const auto put = [&](Column* columns, Eigen::Index i, const auto& numbers) {
    for (int k = 0; k < static_cast<int>(numbers.size()); ++k) {
      columns[k].resize(static_cast<std::size_t>(n));
      columns[k][static_cast<std::size_t>(i)] = numbers[k];
    }
  };
  const Vector3d none = Vector3d::Zero();
  for (Eigen::Index i = 0; i < n; ++i) {
    const BodyState state = scene.bodies.state(i);
    a.mass.push_back(scene.bodies.mass(i));
    put(a.I, i, scene.bodies.moments(i));
    put(a.p, i, state.p_WBcm);
    put(a.v, i, scene.v_WBcm(i));
    put(a.q, i, state.q_WB.coeffs());
    put(a.w, i, scene.w_WB_B(i));
    const bool is_pushed = scene.load.has_wrenches;
    put(a.f, i, is_pushed ? Vector3d(scene.wrenches->f_W.row(i)) : none);
    put(a.t, i, is_pushed ? Vector3d(scene.wrenches->t_Bcm_W.row(i)) : none);
  }
  return a;
}

struct Loop {
  Scene scene;
  Arrays start, now;

  void reset() { now = start; }
  void step(int steps) {
    const double gyroscopic = scene.load.gyroscopic == Gyroscopic::kOn ? 1 : 0;
    for (int k = 0; k < steps; ++k) bench::step(now, scene.g_W.data(), gyroscopic, scene.step_s);
  }
  Motion motionOf(Eigen::Index i) const {
    const auto at = [&](const Column* columns) {
      const auto k = static_cast<std::size_t>(i);
      return Vector3d(columns[0][k], columns[1][k], columns[2][k]);
    };
    const Vector3d u = at(now.q);
    const Quaterniond q_WB(now.q[3][static_cast<std::size_t>(i)], u.x(), u.y(), u.z());
    return {at(now.p), q_WB, at(now.v), q_WB * at(now.w)};
  }
};

}  // namespace

std::vector<PeerRow> peerRows() {
  return {{"rigid_body_sim", "bare loop", "semi-implicit Euler in one loop over arrays",
           [](const Scene& scene) {
             const Arrays arrays = arraysOf(scene);
             return peerOf(std::make_shared<Loop>(Loop{scene, arrays, arrays}));
           }}};
}

}  // namespace rigid_body_sim::bench

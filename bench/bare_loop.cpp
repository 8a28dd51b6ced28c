// Semi-implicit Euler's method for velocities and a quaternion, in one loop over plain arrays of
// the state, the moments and the wrenches, which the compiler vectorises for each processor, with
// nothing around it: a measure for the other rows of ours.
#include <cmath>
#include <memory>
#include <vector>

#include "peer.hpp"

namespace rigid_body_sim::bench {
namespace {

/// Columns of numbers, one a body. Each begins two lines of a cache further on than the last one,
/// lest they all fall onto the same places of it.
class Arrays {
 public:
  enum Column {
    kMass,
    kI,
    kP = kI + 3,
    kV = kP + 3,
    kQ = kV + 3,
    kW = kQ + 4,
    kF = kW + 3,
    kT = kF + 3,
    kCount = kT + 3
  };

  explicit Arrays(std::ptrdiff_t count)
      : count_(count),
        stride_((count + kLine - 1) / kLine * kLine + 2 * kLine),
        numbers_(static_cast<std::size_t>(kCount * stride_)) {}

  std::ptrdiff_t count() const { return count_; }
  double* column(int k) { return numbers_.data() + k * stride_; }

  /// The numbers of body i in a column and those after it.
  template <class Numbers>
  void put(Column first, std::ptrdiff_t i, const Numbers& numbers) {
    for (int k = 0; k < static_cast<int>(numbers.size()); ++k) column(first + k)[i] = numbers[k];
  }
  template <int count>
  Eigen::Matrix<double, count, 1> get(Column first, std::ptrdiff_t i) {
    Eigen::Matrix<double, count, 1> numbers;
    for (int k = 0; k < count; ++k) numbers[k] = column(first + k)[i];
    return numbers;
  }

 private:
  static constexpr std::ptrdiff_t kLine = 8;

  std::ptrdiff_t count_, stride_;
  std::vector<double> numbers_;
};

#if defined(__x86_64__)
#define FOR_EACH_PROCESSOR __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#define FOR_EACH_PROCESSOR
#endif

/// One step of h [s] of all; angular velocities in B, all else in W.
FOR_EACH_PROCESSOR void step(Arrays& a, const double g[3], double gyroscopic, double h) {
  const std::ptrdiff_t n = a.count();
  const double* m = a.column(a.kMass);
  const double *I1 = a.column(a.kI), *I2 = a.column(a.kI + 1), *I3 = a.column(a.kI + 2);
  const double *f1 = a.column(a.kF), *f2 = a.column(a.kF + 1), *f3 = a.column(a.kF + 2);
  const double *t1 = a.column(a.kT), *t2 = a.column(a.kT + 1), *t3 = a.column(a.kT + 2);
  double *p1 = a.column(a.kP), *p2 = a.column(a.kP + 1), *p3 = a.column(a.kP + 2);
  double *v1 = a.column(a.kV), *v2 = a.column(a.kV + 1), *v3 = a.column(a.kV + 2);
  double *q1 = a.column(a.kQ), *q2 = a.column(a.kQ + 1), *q3 = a.column(a.kQ + 2),
         *q0 = a.column(a.kQ + 3);
  double *w1 = a.column(a.kW), *w2 = a.column(a.kW + 1), *w3 = a.column(a.kW + 2);
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
  Arrays a(scene.bodies.count());
  for (Eigen::Index i = 0; i < a.count(); ++i) {
    const BodyState state = scene.bodies.state(i);
    a.column(a.kMass)[i] = scene.bodies.mass(i);
    a.put(a.kI, i, scene.bodies.moments(i));
    a.put(a.kP, i, state.p_WBcm);
    a.put(a.kV, i, scene.v_WBcm(i));
    a.put(a.kQ, i, state.q_WB.coeffs());
    a.put(a.kW, i, scene.w_WB_B(i));
    if (!scene.load.has_wrenches) continue;
    a.put(a.kF, i, Vector3d(scene.wrenches->f_W.row(i)));
    a.put(a.kT, i, Vector3d(scene.wrenches->t_Bcm_W.row(i)));
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
  Motion motionOf(Eigen::Index i) {
    const Quaterniond q_WB(now.get<4>(Arrays::kQ, i));
    return {now.get<3>(Arrays::kP, i), q_WB, now.get<3>(Arrays::kV, i),
            q_WB * now.get<3>(Arrays::kW, i)};
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

#include "reference/flight.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <utility>

namespace rigid_body_sim::reference {
namespace {

/// p, q (x, y, z, w), P, and the angular momentum in body axes: a thin rod's spin would drown in
/// the rounding of R^T L.
using Column = Eigen::Matrix<Real, 13, 1>;

Column packed(const State& body) {
  Column y;
  y << body.p_WBcm, body.q_WB.coeffs(), body.P_WB, body.q_WB.conjugate() * body.L_WBcm_W;
  return y;
}

State unpacked(const Column& y) {
  const Quaternionr q_WB(Eigen::Matrix<Real, 4, 1>(y.segment<4>(3)));
  return {y.segment<3>(0), q_WB, y.segment<3>(7), q_WB * Vector3r(y.segment<3>(10))};
}

struct Equations {
  Real mass;
  Vector3r I;
  const PushLaw& law;

  Column operator()(Real t, const Column& y) const {
    const State body = unpacked(y);
    const Push push = law(t, body);
    const Vector3r L_B = y.segment<3>(10);
    const Vector3r w_B = L_B.cwiseQuotient(I);
    const Vector3r half_w = Real(0.5) * (body.q_WB * w_B);
    const Quaternionr rate = Quaternionr(0, half_w.x(), half_w.y(), half_w.z()) * body.q_WB;
    Column slope;
    slope << body.P_WB / mass, rate.coeffs(), push.f_W,
        L_B.cross(w_B) + body.q_WB.conjugate() * push.t_Bcm_W;
    return slope;
  }
};

constexpr int kColumns = 8;  // order 16

/// One step of `span` [s]: midpoint rule with 2, 4, ... 16 substeps, extrapolated in their squares.
Column extrapolatedStep(const Equations& f, Real t, const Column& y, Real span) {
  std::array<Column, kColumns> table;
  for (int j = 0; j < kColumns; ++j) {
    const int n = 2 * (j + 1);
    const Real h = span / n;
    Column before = y;
    Column now = y + h * f(t, y);
    for (int i = 1; i < n; ++i) {
      const Column next = before + 2 * h * f(t + i * h, now);
      before = now;
      now = next;
    }
    table[j] = now;
    for (int k = j; k > 0; --k) {
      const Real ratio = Real(j + 1) / Real(k);
      table[k - 1] = table[k] + (table[k] - table[k - 1]) / (ratio * ratio - 1);
    }
  }
  return table[0];
}

Column run(const Equations& f, Column y, Real time_s, int steps) {
  const Real span = time_s / steps;
  for (int i = 0; i < steps; ++i) {
    y = extrapolatedStep(f, i * span, y, span);
    y.segment<4>(3).normalize();
  }
  return y;
}

constexpr Real kWanted = 1e-12L;   // far below what any integrator here is measured at
constexpr Real kBearable = 1e-9L;  // still no figure of a test hangs on it

Real differenceOf(const Column& a, const Column& b) {
  // Far too long a step overflows: that is no agreement.
  if (!a.allFinite() || !b.allFinite()) return std::numeric_limits<Real>::infinity();
  Real worst = 0;
  for (const auto& [first, size] :
       {std::pair(0, 3), std::pair(3, 4), std::pair(7, 3), std::pair(10, 3)}) {
    const Real scale = std::max(Real(1), a.segment(first, size).norm());
    worst = std::max(worst, (a - b).segment(first, size).cwiseAbs().maxCoeff() / scale);
  }
  return worst;
}

}  // namespace

State extended(const BodyState& body) {
  return {body.p_WBcm.cast<Real>(), body.q_WB.cast<Real>(), body.P_WB.cast<Real>(),
          body.L_WBcm_W.cast<Real>()};
}

BodyState rounded(const State& body) {
  return {body.p_WBcm.cast<double>(), body.q_WB.cast<double>(), body.P_WB.cast<double>(),
          body.L_WBcm_W.cast<double>()};
}

Flight fly(const State& start, double mass, const Vector3d& I_BBcm_B, const PushLaw& law,
           double time_s) {
  const Equations equations = {mass, I_BBcm_B.cast<Real>(), law};
  State first = start;
  first.q_WB.normalize();  // first of all: by a longer one the momentum would be turned askew
  const Column y0 = packed(first);
  Column coarse = run(equations, y0, time_s, 4);
  Column best = coarse;
  Real least = std::numeric_limits<Real>::infinity();
  for (int steps = 8; steps <= 1 << 14 && least >= kWanted; steps *= 2) {
    const Column fine = run(equations, y0, time_s, steps);
    const Real doubt = differenceOf(fine, coarse);
    // No longer falling: rounding, which a flight that spreads differences has more of.
    if (least < kBearable && doubt >= least) break;
    if (doubt < least) {
      least = doubt;
      best = fine;
    }
    coarse = fine;
  }
  if (!(least < kBearable)) {
    std::ostringstream why;
    why << "the reference flight does not settle: too fast, too long or chaotic; doubt " << least;
    throw std::runtime_error(why.str());
  }
  const State end = unpacked(best);
  return {rounded(end), end, static_cast<double>(least)};
}

}  // namespace rigid_body_sim::reference

#include "reference/answers.hpp"

#include <cmath>

#include "reference/flight.hpp"
#include "reference/free_rotation.hpp"
#include "rigid_body_sim/rotation.hpp"

namespace rigid_body_sim::reference {
namespace {

/// Attitude of a body with this angular momentum at the end.
using AttitudeOf = std::function<Quaternionr(const BodyState& start, const Vector3d& I_BBcm_B)>;

constexpr double kUlps = 32;  // enough for the change to stand out of its own rounding

/// The state with its angular momentum changed by so many last bits.
BodyState nudged(BodyState state) {
  const Vector3d along_no_axis(0.36, -0.48, 0.8);
  state.L_WBcm_W += state.L_WBcm_W.stableNorm() * kUlps * 0x1p-52 * along_no_axis;
  return state;
}

double angleBetween(const Quaternionr& a, const Quaternionr& b) {
  const Quaternionr turn = a.conjugate() * b;
  return static_cast<double>(2 * std::atan2(turn.vec().norm(), std::abs(turn.w())));
}

/// Attitudes by `attitude`, straight on by the momentum, both momenta constant.
Answer coasted(const Bodies& start, double time_s, const AttitudeOf& attitude) {
  Answer answer;
  for (Eigen::Index i = 0; i < start.count(); ++i) {
    BodyState end = start.state(i);
    const Vector3d I = start.moments(i);
    const Quaternionr q = attitude(end, I);
    const double turn = angleBetween(attitude(nudged(end), I), q) / kUlps;
    answer.turn_of_an_ulp = std::max(answer.turn_of_an_ulp, turn);
    end.q_WB = q.cast<double>();
    const Vector3r path = Real(time_s) / Real(start.mass(i)) * end.P_WB.cast<Real>();
    end.p_WBcm = (end.p_WBcm.cast<Real>() + path).cast<double>();
    answer.end.push_back(end);
  }
  return answer;
}

/// Half of the rotation by r in extended precision, r being of any length.
Quaternionr turnBy(const Vector3r& r) {
  const Real angle = r.norm();
  if (angle == 0) return Quaternionr::Identity();
  const Vector3r v = std::sin(angle / 2) / angle * r;
  return {std::cos(angle / 2), v.x(), v.y(), v.z()};
}

Vector3r rateOf(const BodyState& start, const Vector3d& I) {
  const Quaternionr q = start.q_WB.cast<Real>().normalized();
  return q * Vector3r((q.conjugate() * start.L_WBcm_W.cast<Real>()).cwiseQuotient(I.cast<Real>()));
}

/// After `turning_s` [s] of rotation and `moving_s` [s] of translation.
Answer freely(const Bodies& start, double turning_s, double moving_s) {
  return coasted(start, moving_s, [=](const BodyState& body, const Vector3d& I) {
    return freeAttitudes(I, body.q_WB, body.L_WBcm_W, turning_s, 1).back();
  });
}

}  // namespace

Answer freeFlight(const Bodies& start, double time_s, double) {
  return freely(start, time_s, time_s);
}

Answer freeTops(const Bodies& start, double time_s, double) {
  return coasted(start, time_s, [=](const BodyState& body, const Vector3d& I) {
    const int axis = I(0) == I(1) ? 2 : 0;
    const Real across = I(1);
    const Quaternionr q = body.q_WB.cast<Real>().normalized();
    const Vector3r L = body.L_WBcm_W.cast<Real>();
    const Real own = (across - Real(I(axis))) / (Real(I(axis)) * across) *
                     Vector3r(q.conjugate() * L)(axis) * Real(time_s);
    return Quaternionr(turnBy(Real(time_s) / across * L) * q * turnBy(own * Vector3r::Unit(axis)));
  });
}

Answer steadyTurn(const Bodies& start, double time_s, double) {
  return coasted(start, time_s, [=](const BodyState& body, const Vector3d& I) {
    return Quaternionr(turnBy(Real(time_s) * rateOf(body, I)) * body.q_WB.cast<Real>());
  });
}

Answer rest(const Bodies& start, double, double) {
  Answer answer;
  for (Eigen::Index i = 0; i < start.count(); ++i) answer.end.push_back(start.state(i));
  return answer;
}

AnswerOf freeFall(const Vector3d& g_W) {
  return [g_W](const Bodies& start, double time_s, double) {
    Answer answer = freely(start, time_s, time_s);
    for (Eigen::Index i = 0; i < start.count(); ++i) {
      BodyState& end = answer.end[static_cast<std::size_t>(i)];
      end.p_WBcm += 0.5 * time_s * time_s * g_W;
      end.P_WB += start.mass(i) * time_s * g_W;
    }
    return answer;
  };
}

AnswerOf damped(double c) {
  return [c](const Bodies& start, double time_s, double) {
    const double warped_s = -std::expm1(-c * time_s) / c;
    Answer answer = freely(start, warped_s, warped_s);
    for (BodyState& end : answer.end) {
      end.P_WB *= std::exp(-c * time_s);
      end.L_WBcm_W *= std::exp(-c * time_s);
    }
    return answer;
  };
}

AnswerOf dragged(double k, double k_w) {
  return [=](const Bodies& start, double time_s, double) {
    Answer answer;
    for (Eigen::Index i = 0; i < start.count(); ++i) {
      BodyState end = start.state(i);
      const double mass = start.mass(i), moment = start.moments(i)(0);
      const double x = k / mass * (end.P_WB.norm() / mass) * time_s;
      const double y = k_w / moment * (end.L_WBcm_W.norm() / moment) * time_s;
      end.p_WBcm += std::log1p(x) * (mass / k) * end.P_WB.normalized();
      end.q_WB = rotationExp(std::log1p(y) * (moment / k_w) * end.L_WBcm_W.normalized()) * end.q_WB;
      end.P_WB /= 1 + x;
      end.L_WBcm_W /= 1 + y;
      answer.end.push_back(end);
    }
    return answer;
  };
}

AnswerOf swing(double rate) {
  return [rate](const Bodies& start, double time_s, double) {
    Answer answer = rest(start, 0, 0);
    for (Eigen::Index i = 0; i < start.count(); ++i) {
      BodyState& end = answer.end[static_cast<std::size_t>(i)];
      end.P_WB = -start.mass(i) * rate * std::sin(rate * time_s) * end.p_WBcm;
      end.p_WBcm *= std::cos(rate * time_s);
    }
    return answer;
  };
}

AnswerOf switchedTorque(const Vector3d& t_W) {
  return [t_W](const Bodies& start, double time_s, double step_s) {
    const auto ticks = std::llround(time_s / step_s);
    State state = extended(start.state(0));
    for (long long tick = 0; tick < ticks; ++tick) {
      const Vector3r t = (tick % 2 == 0 ? 1 : -1) * t_W.cast<Real>();
      const PushLaw law = [t](Real, const State&) { return Push{Vector3r::Zero(), t}; };
      state = fly(state, start.mass(0), start.moments(0), law, step_s).extended_end;
    }
    return Answer{{rounded(state)}};
  };
}

AnswerOf gaining(const Vector3d& L_W) {
  return [L_W](const Bodies& start, double, double) {
    Answer answer = rest(start, 0, 0);
    for (BodyState& end : answer.end) end.L_WBcm_W += L_W;
    return answer;
  };
}

}  // namespace rigid_body_sim::reference

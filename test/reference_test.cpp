// The references are held against each other and against what others published.
#include <cmath>

#include "generic.hpp"
#include "reference/flight.hpp"
#include "reference/free_rotation.hpp"
#include "rigid_body_sim/conserved.hpp"

namespace rigid_body_sim {
namespace {

using reference::Flight;
using reference::fly;

BodyState startOf(const reference::Case& one, const Quaterniond& q_WB) {
  BodyState body;
  body.q_WB = q_WB;
  body.L_WBcm_W = q_WB * one.I_BBcm_B.cwiseProduct(one.w_WB_B);
  return body;
}

TEST(Reference, EveryCaseIsABodyThatCanBe) {
  for (const reference::Case& one : reference::cases()) {
    MassProperties body;
    body.mass = one.mass;
    body.I_BBcm_F = one.I_BBcm_B.asDiagonal();
    EXPECT_EQ(invalidity(body), "") << one.name;
    EXPECT_EQ(principalInertia(body.I_BBcm_F).q_FB.coeffs(), Quaterniond::Identity().coeffs())
        << one.name << ": moments do not ascend";
    EXPECT_EQ(&reference::caseNamed(one.name), &one);
  }
  EXPECT_TRUE(contains(refusal([] { reference::caseNamed("x"); }), {"no case 'x'"}));
}

TEST(Reference, FlightOfASymmetricBodyIsItsClosedForm) {
  for (const char* name : {"prolate_top", "oblate_top", "thin_rod", "sphere"}) {
    const reference::Case& one = reference::caseNamed(name);
    const BodyState start = startOf(one, genericAttitude());
    const Flight flight = fly(start, one.mass, one.I_BBcm_B, reference::nothing, 10);
    const auto exact = reference::symmetricTop(one.I_BBcm_B, {genericAttitude(), one.w_WB_B}, 10);
    EXPECT_LT(flight.doubt, 1e-12) << name;
    // The start's rounding, kEps in every part, grows with the angle turned: the thin rod's spin
    // of 10 rad/s comes out of a momentum a hundred thousandth of the whole.
    const double tolerance = name == std::string("thin_rod") ? 4 * 1e6 * 10 * kEps : 100 * kEps;
    EXPECT_LE(angleBetween(flight.end.q_WB, exact.q_WB), tolerance) << name;
  }
}

TEST(Reference, SymmetricTopPrecessesAtMomentumOverTransverseMoment) {
  // The axis of symmetry is back after one period 2 pi I_t / L, the body has turned about it.
  const reference::Case& top = reference::caseNamed("oblate_top");
  const double L = top.I_BBcm_B.cwiseProduct(top.w_WB_B).norm();
  const double period = 2 * kPi * top.I_BBcm_B(0) / L;
  const auto after = reference::symmetricTop(top.I_BBcm_B, {genericAttitude(), top.w_WB_B}, period);
  EXPECT_LE(difference(after.q_WB * Vector3d::UnitZ(), genericAttitude() * Vector3d::UnitZ()),
            16 * kEps);
  const double turned = period * top.w_WB_B(2) * (1 - top.I_BBcm_B(2) / top.I_BBcm_B(0));
  EXPECT_LE(angleBetween(after.q_WB, genericAttitude() *
                                         Quaterniond(Eigen::AngleAxisd(turned, Vector3d::UnitZ()))),
            32 * kEps);
}

TEST(Reference, SymmetricTopRefusesThreeDifferentMoments) {
  EXPECT_TRUE(contains(refusal([] {
                         reference::symmetricTop({1, 2, 3}, {}, 1);
                       }),
                       {"no two principal moments are equal"}));
}

TEST(Reference, FreeFlightKeepsEnergyAndMomentum) {
  for (const reference::Case& one : reference::cases()) {
    if (one.name == "thin_rod") continue;  // its energy hangs on digits that |L| does not have
    const BodyState start = startOf(one, genericAttitude());
    const BodyState end = fly(start, one.mass, one.I_BBcm_B, reference::nothing, 30).end;
    EXPECT_LE(difference(end.L_WBcm_W, start.L_WBcm_W), 16 * kEps * start.L_WBcm_W.norm());
    EXPECT_NEAR(
        kineticEnergy(end, one.mass, one.I_BBcm_B) / kineticEnergy(start, one.mass, one.I_BBcm_B),
        1, 16 * kEps)
        << one.name;
  }
}

TEST(Reference, FlightObeysEulersEquations) {
  // t = I w' + w x I w, with w' by central differences extrapolated once: h^4 and kEps / h.
  const reference::Case& stone = reference::caseNamed("tumbling_stone");
  const BodyState start = startOf(stone, genericAttitude());
  const Vector3d& I = stone.I_BBcm_B;
  const Vector3d t_B(0.4, 0.9, -1.6);
  const auto law = [&](reference::Real, const reference::State& body) {
    return reference::Push{reference::Vector3r::Zero(), body.q_WB * t_B.cast<reference::Real>()};
  };
  const auto rate = [&](double time_s) {
    return angularVelocityInBody(fly(start, stone.mass, I, law, time_s).end, I);
  };
  const auto slope = [&](double h) { return Vector3d((rate(h) - rate(-h)) / (2 * h)); };
  const double h = 1e-3;
  const Vector3d w = stone.w_WB_B, w_dot = (4 * slope(h / 2) - slope(h)) / 3;
  EXPECT_LE(difference(I.cwiseProduct(w_dot) + w.cross(I.cwiseProduct(w)), t_B), 16 * kEps / h);
}

TEST(Reference, FlightOfTheBrickIsNasas) {
  const reference::Case& brick = reference::caseNamed("nesc_brick");
  ASSERT_TRUE(brick.published);
  const Flight flight = fly(startOf(brick, Quaterniond::Identity()), brick.mass, brick.I_BBcm_B,
                            reference::nothing, brick.published->time_s);
  EXPECT_LE(angleBetween(flight.end.q_WB, brick.published->q_B0B.normalized()),
            brick.published->attitude_rounding);
  EXPECT_LE(difference(angularVelocityInBody(flight.end, brick.I_BBcm_B), brick.published->w_WB_B),
            brick.published->rate_rounding);
}

TEST(Reference, FlightFallsAlongTheParabola) {
  const BodyState start = {{1, 2, 3}, genericAttitude(), {0.3, -0.8, 4}, {0, 0, 0}};
  const Vector3d f_W(0.2, 0.1, -9.81);
  const auto law = [&](reference::Real, const reference::State&) {
    return reference::Push{f_W.cast<reference::Real>(), reference::Vector3r::Zero()};
  };
  const BodyState end = fly(start, 2, {1, 2, 3}, law, 3).end;
  EXPECT_LE(difference(end.p_WBcm, start.p_WBcm + 3 * start.P_WB / 2 + 4.5 * f_W / 2), 64 * kEps);
  EXPECT_LE(difference(end.P_WB, start.P_WB + 3 * f_W), 64 * kEps);
  EXPECT_LE(difference(end.q_WB.coeffs(), start.q_WB.coeffs()), kEps);
}

TEST(Reference, FlightOfASpunUpSphereFollowsItsAngle) {
  // t = I w' about one axis: w = (t/I) T and angle (t/I) T^2 / 2; also with a law of time.
  const Vector3d u = Vector3d(0.48, -0.6, 0.64);
  const auto law = [&](reference::Real t, const reference::State&) {
    return reference::Push{reference::Vector3r::Zero(), 6 * t * u.cast<reference::Real>()};
  };
  const BodyState end = fly(BodyState(), 1, {0.5, 0.5, 0.5}, law, 1.1).end;  // angle 2 t^3
  EXPECT_LE(angleBetween(end.q_WB, rotationExp(2 * 1.1 * 1.1 * 1.1 * u)), 32 * kEps);
  EXPECT_LE(difference(end.L_WBcm_W, 3 * 1.1 * 1.1 * u), 32 * kEps);
}

}  // namespace
}  // namespace rigid_body_sim

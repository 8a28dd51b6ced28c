// What pushes mean: frames, axes, points, over real topics.

#include <tf2_msgs/TFMessage.h>

#include "probe_inputs.hpp"
#include "reference/flight.hpp"

namespace rigid_body_sim {
namespace {

const Vector3d kForce(2.1, -1.4, 0.9);
const Vector3d kTorque(-0.3, 0.5, 0.2);

class Inputs : public PushTest {
 protected:
  /// Frames that a push on the probe may be given in.
  static const std::vector<std::string>& frames() {
    static const std::vector<std::string> names = {"world", "probe", "probe/com", "thruster"};
    return names;
  }

  /// What naming the frame means.
  Meaning meaningOf(const std::string& frame) {
    if (frame == "world") return {true, Matrix3d::Identity(), body.p_LBcm};
    const Isometry3d X_LF = poseOf(frame);
    return {false, X_LF.linear(), X_LF.translation()};
  }

  Isometry3d poseOf(const std::string& frame) {
    if (frame == "probe") return Isometry3d::Identity();
    return frame == "thruster" ? thrusterInProbe() : comInProbe();
  }

  /// Of the axes at the centre of mass only the node knows the signs; tf_test checks the rest.
  Isometry3d comInProbe() {
    static const Isometry3d X_LB = [this] {
      Recording<tf2_msgs::TFMessage> recording(sim, "/tf_static");
      recording.expect(1);
      Isometry3d X = Isometry3d::Identity();
      for (const auto& one : recording.messages[0].transforms) {
        if (one.child_frame_id != "probe/com") continue;
        X.linear() = toEigen(one.transform.rotation).toRotationMatrix();
        X.translation() = toEigen(one.transform.translation);
      }
      return X;
    }();
    return X_LB;
  }

  /// The velocities too are those of the closed form, at the attitude that is published with them.
  void expectVelocities(const BodyStates& states, const Momentum& wanted) {
    const Motion found = motionOf(states, "probe");
    const Motion closed = withMomentum(body, found, wanted);
    EXPECT_LE((found.v_WL_L - closed.v_WL_L).norm(), kRelative * closed.v_WL_L.norm());
    EXPECT_LE((found.w_WL_L - closed.w_WL_L).norm(), kRelative * closed.w_WL_L.norm());
  }
};

TEST_F(Inputs, AnOffCentreImpulseOnATurnedSpinningBodyGivesTheClosedFormsVelocities) {
  for (const std::string& frame : frames()) {
    SCOPED_TRACE(frame);
    const BodyStates before = sim.step(5);
    impulse.send(impulseIn(frame, kForce, kTorque));
    const BodyStates after = sim.step();
    const Momentum wanted =
        momentumOf(body, before) +
        given(body, meaningOf(frame), motionOf(before, "probe").R_WL(), kForce, kTorque);
    expectMomentum(momentumOf(body, after), wanted);
    expectVelocities(after, wanted);
  }
}

TEST_F(Inputs, AnImpulseActsExactlyOnce) {
  impulse.send(impulseIn("thruster", kForce, kTorque));
  const Momentum after = momentumOf(body, sim.step());
  expectMomentum(momentumOf(body, sim.step(100)), after);
}

TEST_F(Inputs, AnImpulseMovesNoOtherBody) {
  impulse.send(impulseIn("world", kForce, kTorque));
  expectMomentum(momentumOf(puck(), sim.step()), momentumAtStart(puck()));
}

TEST_F(Inputs, ImpulsesAddInOneTick) {
  const Momentum start = momentumAtStart(body);
  impulse.send({impulseIn("world", kForce), impulseIn("/world", kForce, kTorque)});
  sendImpulses(bodyImpulse("probe", "world", kForce, kTorque),
               bodyImpulse("probe", "world", kForce, kTorque));
  expectMomentum(momentumOf(body, sim.step()), start + Momentum{4 * kForce, 3 * kTorque});
}

// Axes from one frame, point from another, for all pairs; an empty point_frame means the frame of
// the axes, and the centre of mass' for world axes.
TEST_F(Inputs, AnArraysImpulseActsAtItsPointInItsAxes) {
  const Vector3d point(0.17, -0.08, 0.24);
  for (const std::string& frame : frames()) {
    for (const std::string point_frame : {"", "probe", "/probe/com", "thruster"}) {
      SCOPED_TRACE(frame + " at " + point_frame);
      const BodyStates before = sim.step(3);
      BodyImpulse entry = bodyImpulse("probe", frame, kForce, kTorque);
      entry.point_frame = point_frame;
      entry.point = toPoint(point);
      sendImpulses(entry);
      const BodyStates after = sim.step();

      Meaning meaning = meaningOf(frame);
      const std::string from = !point_frame.empty() ? point_frame.substr(point_frame[0] == '/')
                               : frame == "world"   ? "probe/com"
                                                    : frame;
      meaning.p_LQ = poseOf(from) * point;
      expectMomentum(momentumOf(body, after),
                     momentumOf(body, before) +
                         given(body, meaning, motionOf(before, "probe").R_WL(), kForce, kTorque));
    }
  }
}

// The kick of a tick is half at its beginning and half at its end, and the attitudes of both are
// published.
TEST_F(Inputs, AnArraysWrenchActsAtItsPointInItsAxes) {
  const Vector3d point(0.17, -0.08, 0.24);
  for (const std::string& frame : frames()) {
    for (const std::string point_frame : {"probe", "thruster"}) {
      SCOPED_TRACE(frame + " at " + point_frame);
      const BodyStates before = sim.step(3);
      BodyWrench entry = bodyWrench("probe", frame, 30 * kForce, 30 * kTorque, kStep_s);
      entry.point_frame = point_frame;
      entry.point = toPoint(point);
      sendWrenches(entry);
      const BodyStates after = sim.step();

      Meaning meaning = meaningOf(frame);
      meaning.p_LQ = poseOf(point_frame) * point;
      const auto half = [&](const BodyStates& states) {
        return 0.5 * kStep_s *
               given(body, meaning, motionOf(states, "probe").R_WL(), 30 * kForce, 30 * kTorque);
      };
      expectMomentum(momentumOf(body, after),
                     momentumOf(body, before) + half(before) + half(after));
    }
  }
}

// Constant force and torque in the world: momentum grows by F t and T t, and the centre of mass is
// on its parabola, however the body turns.
TEST_F(Inputs, AWrenchHeldInWorldAxesDoesNotTurnWithTheBody) {
  wrench.send(wrenchIn("world", kForce, kTorque));
  const BodyStates after = sim.step(40);
  const double time_s = 40 * kStep_s;
  expectMomentum(momentumOf(body, after),
                 momentumAtStart(body) + Momentum{time_s * kForce, time_s * kTorque});
  const Vector3d p_WBcm =
      body.X_WL * body.p_LBcm + time_s * body.v_WBcm + 0.5 * time_s * time_s / body.mass * kForce;
  EXPECT_LE((centreOfMass(body, motionOf(after, "probe")) - p_WBcm).norm(), kRelative);
}

// The puck spins about its x axis at a constant rate w, so that a force fixed to it gives
// R0 * integral of Rx(w t) f dt. The steps' trapezoids add up to that times
// (w h / 2) / tan(w h / 2), exactly.
TEST_F(Inputs, AWrenchHeldInBodyAxesTurnsWithTheBody) {
  const Solid disc = puck();
  puck_wrench.send(wrenchIn("puck", kForce));
  const BodyStates after = sim.step(45);
  const double w = disc.w_WL_L.x(), angle = w * 45 * kStep_s, x = 0.5 * w * kStep_s;
  const double sine = std::sin(angle) / w, cosine = (1 - std::cos(angle)) / w;
  const Vector3d turning(0, kForce.y() * sine - kForce.z() * cosine,
                         kForce.y() * cosine + kForce.z() * sine);
  const Vector3d along(45 * kStep_s * kForce.x(), 0, 0);
  const Momentum start = momentumAtStart(disc);
  const Vector3d wanted = disc.X_WL.linear() * (along + x / std::tan(x) * turning);
  expectMomentum(momentumOf(disc, after), {start.P_WB + wanted, start.L_WBcm_W});

  const Vector3d exact = disc.X_WL.linear() * (along + turning);  // the trapezoids' error is x^2/3
  EXPECT_LE((momentumOf(disc, after).P_WB - start.P_WB - exact).norm(), x * x / 2 * exact.norm());
}

TEST_F(Inputs, ATorqueHeldAlongAPrincipalAxisSpinsTheBodyUpAtAConstantRate) {
  const Solid disc = puck();
  puck_wrench.send(wrenchIn("puck", Vector3d::Zero(), Vector3d(0.07, 0, 0)));
  const BodyStates after = sim.step(30);
  const double w = disc.w_WL_L.x() + 0.07 * 30 * kStep_s / disc.I_BBcm_L(0, 0);
  EXPECT_LE((motionOf(after, "puck").w_WL_L - Vector3d(w, 0, 0)).norm(), kRelative * w);
}

// No closed form for a generic body, but the equations of motion to 16 digits. The default method
// is of second order: measured 1.5e-4 after half a second; it would be 0.5 with world axes.
TEST_F(Inputs, AWrenchHeldThroughTheThrusterFollowsTheEquationsOfMotion) {
  wrench.send(wrenchIn("thruster", kForce, kTorque));
  const BodyStates after = sim.step(25);

  const Isometry3d X_LB = comInProbe();
  const Isometry3d X_BT = X_LB.inverse() * thrusterInProbe();
  const Vector3d f_B = X_BT.linear() * kForce;
  const Vector3d t_B = X_BT.linear() * kTorque + X_BT.translation().cross(f_B);
  const reference::PushLaw law = [&](reference::Real, const reference::State& state) {
    return reference::Push{state.q_WB * f_B.cast<reference::Real>(),
                           state.q_WB * t_B.cast<reference::Real>()};
  };
  const Vector3d I_B = (X_LB.linear().transpose() * body.I_BBcm_L * X_LB.linear()).diagonal();
  const Momentum start = momentumAtStart(body);
  const Quaterniond q_WB(Matrix3d(body.X_WL.linear() * X_LB.linear()));
  const BodyState end =
      reference::fly(BodyState{body.X_WL * body.p_LBcm, q_WB, start.P_WB, start.L_WBcm_W},
                     body.mass, I_B, law, 25 * kStep_s)
          .end;
  const Momentum momentum = momentumOf(body, after);
  const Motion motion = motionOf(after, "probe");
  EXPECT_LE((momentum.P_WB - end.P_WB).norm(), 5e-4);
  EXPECT_LE((momentum.L_WBcm_W - end.L_WBcm_W).norm(), 5e-4);
  EXPECT_LE((centreOfMass(body, motion) - end.p_WBcm).norm(), 5e-4);
  EXPECT_LE((motion.R_WL() * X_LB.linear() - end.q_WB.toRotationMatrix()).norm(), 5e-4);
}

}  // namespace
}  // namespace rigid_body_sim

int main(int argc, char** argv) { return rigid_body_sim::runRostest(argc, argv, "inputs_test"); }

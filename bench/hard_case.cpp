#include "hard_case.hpp"

#include <algorithm>
#include <sstream>

namespace rigid_body_sim::bench {
namespace {

using reference::HardCase;
using reference::TorqueInput;
using reference::Verdict;

/// Why the case cannot be told to an engine; empty if it can.
std::string whyUnasked(const PeerRow& row, const HardCase& one, const Simulator& simulator) {
  if (!one.urdf.empty()) return "what is made of a URDF is its importer's, not the engine's";
  for (const std::string& effect : simulator.effectNames())
    if (effect != "gravity" && effect != "gyroscopic") return "has no " + effect + " of its own";
  if (simulator.scene().gyroscopic == Gyroscopic::kOff && !row.is_gyroscopic_optional)
    return "cannot leave w x I w out";
  return "";
}

Scene sceneOf(const HardCase& one, const Simulator& simulator) {
  Scene scene;
  scene.load.name = one.name;
  scene.load.gyroscopic = simulator.scene().gyroscopic;
  scene.load.has_wrenches = static_cast<bool>(one.input);
  scene.step_s = simulator.scene().step_s();
  scene.bodies = simulator.bodies();
  scene.g_W = simulator.wrenchOn(0).f_F / scene.bodies.mass(0);  // gravity, or nothing
  scene.load.has_gravity = !scene.g_W.isZero(0);
  scene.wrenches->setZero(scene.bodies.count());
  scene.p_OBcm_B.resize(scene.bodies.count(), 3);
  for (Eigen::Index i = 0; i < scene.bodies.count(); ++i) {
    const BodyFrame& frame = simulator.bodyFrame(i);
    scene.p_OBcm_B.row(i) = frame.q_LB.conjugate() * frame.p_LBcm;
  }
  return scene;
}

/// A scene's bodies as the engine has them.
class Flown {
 public:
  Flown(const Scene& scene, Peer peer) : peer_(std::move(peer)), bodies_(scene.bodies) {
    peer_.reset();
  }

  void step() { peer_.step(1); }
  bool hasStartedAnew() const { return peer_.has_started_anew && peer_.has_started_anew(); }

  bool isFinite() const {
    for (Eigen::Index i = 0; i < bodies_.count(); ++i) {
      const Motion now = peer_.motionOf(i);
      if (!now.p_WBcm.allFinite() || !now.q_WB.coeffs().allFinite() || !now.v_WBcm.allFinite() ||
          !now.w_WB.allFinite())
        return false;
    }
    return true;
  }

  /// As they are now, with momenta from the engine's velocities.
  const Bodies& bodies() {
    for (Eigen::Index i = 0; i < bodies_.count(); ++i) {
      const Motion now = peer_.motionOf(i);
      BodyState state;
      state.p_WBcm = now.p_WBcm;
      state.q_WB = now.q_WB.normalized();
      state.P_WB = bodies_.mass(i) * now.v_WBcm;
      state.L_WBcm_W =
          state.q_WB * bodies_.moments(i).cwiseProduct(state.q_WB.conjugate() * now.w_WB);
      bodies_.setState(i, state);
    }
    return bodies_;
  }

 private:
  Peer peer_;
  Bodies bodies_;
};

/// What the case gives its first body during a tick: an engine takes an impulse as the torque that
/// makes it in a step.
void push(const HardCase& one, Tick tick, const Scene& scene) {
  const TorqueInput input = one.input(tick);
  scene.wrenches->t_Bcm_W.row(0) = input.t_W + input.J_W / scene.step_s;
}

std::string inALine(const std::string& fate, const Verdict& verdict, const std::string& why) {
  std::ostringstream text;
  text.precision(17);
  text << fate << '\t' << verdict.end_s << '\t' << verdict.energy_change << '\t'
       << verdict.momentum_error << '\t' << verdict.errors.size();
  for (const auto* numbers : {&verdict.errors, &verdict.bounds})
    for (const double number : *numbers) text << '\t' << number;
  std::string words = why;
  std::replace(words.begin(), words.end(), '\n', ' ');
  text << '\t' << words;
  return text.str();
}

}  // namespace

std::string flyHardCase(const PeerRow& row, const HardCase& one) {
  const Simulator simulator(reference::sceneOf(one, "exact"));
  const std::string why = whyUnasked(row, one, simulator);
  if (!why.empty()) return inALine("unasked", {}, why);
  const Scene scene = sceneOf(one, simulator);
  Tick done = 0;
  bool is_taken = false;
  try {
    Flown flown(scene, row.make(scene));
    is_taken = true;
    const Verdict verdict =
        judge(one,
              {scene.bodies, scene.step_s, !one.input && !scene.load.has_gravity,
               [&](Tick tick) {
                 if (one.input) push(one, tick, scene);
                 flown.step();
                 ++done;
               },
               [&]() -> const Bodies& { return flown.bodies(); },
               [&] { return flown.hasStartedAnew() || !flown.isFinite(); }},
              one.ticks);
    if (flown.hasStartedAnew()) return inALine("anew", verdict, "");
    return inALine(nameOf(verdict.outcome), verdict, "");
  } catch (const std::exception& error) {
    Verdict verdict;
    verdict.end_s = static_cast<double>(done) * scene.step_s;
    return inALine(is_taken ? "throws" : "refused", verdict, error.what());
  }
}

}  // namespace rigid_body_sim::bench

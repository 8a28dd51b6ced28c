#pragma once

// Topic and service names of the node, in one place. Body topics are `<body>/<name>`.
namespace rigid_body_sim::names {

constexpr char kWrench[] = "wrench";                 // in, a body's
constexpr char kImpulse[] = "impulse";               // in, a body's
constexpr char kTwist[] = "twist";                   // out, a body's
constexpr char kOdom[] = "odom";                     // out, a body's
constexpr char kAppliedWrench[] = "applied_wrench";  // out, a body's

constexpr char kWrenches[] = "wrenches";               // in
constexpr char kImpulses[] = "impulses";               // in
constexpr char kStates[] = "states";                   // out
constexpr char kEffectWrenches[] = "effect_wrenches";  // out
constexpr char kTf[] = "/tf";                          // out
constexpr char kClock[] = "/clock";                    // out
constexpr char kImportReport[] = "import_report";      // out
constexpr char kAccuracyBill[] = "accuracy_bill";      // out

constexpr char kPause[] = "pause";                 // service, private
constexpr char kStep[] = "step";                   // service, private
constexpr char kReset[] = "reset";                 // service, private
constexpr char kSwitchEffect[] = "switch_effect";  // service, private

}  // namespace rigid_body_sim::names

#include "node/input_rules.hpp"

#include <cmath>
#include <sstream>

#include "node/conversions.hpp"

namespace rigid_body_sim {
namespace {

constexpr double kMaxAhead_s = 10;
constexpr std::size_t kMaxWaiting = 10'000;

Wrench toWrench(const geometry_msgs::Vector3& force, const geometry_msgs::Vector3& torque) {
  return {toVector(force), toVector(torque)};
}

std::string withoutSlash(const std::string& frame) {
  return !frame.empty() && frame.front() == '/' ? frame.substr(1) : frame;
}

/// Names to choose from, at most ten of them.
template <class Map>
std::string namesIn(const Map& map) {
  std::string names;
  int count = 0;
  for (const auto& entry : map) {
    if (++count > 10) return names + ", ...";
    names += (names.empty() ? "" : ", ") + entry.first;
  }
  return names;
}

/// Quoted for a message, bounded in length and without control characters.
std::string quoted(const std::string& name) {
  std::string text = name.substr(0, 60);
  for (char& c : text)
    if (static_cast<unsigned char>(c) < ' ') c = '?';
  return "'" + text + (name.size() > 60 ? "..." : "") + "'";
}

[[noreturn]] void refuseSize(const char* what, double size, double limit, const char* unit) {
  std::ostringstream text;
  text << what << " " << size << " " << unit << " is above the limit of " << limit << " " << unit;
  throw RefusedInput(Refusal::kLimit, text.str());
}

}  // namespace

const char* toText(Refusal refusal) {
  switch (refusal) {
    case Refusal::kNotFinite:
      return "not finite";
    case Refusal::kUnknownBody:
      return "unknown body";
    case Refusal::kUnknownFrame:
      return "unknown frame";
    case Refusal::kStale:
      return "stale";
    case Refusal::kTooFarAhead:
      return "too far ahead";
    case Refusal::kTooManyWaiting:
      return "too many waiting";
    case Refusal::kDuration:
      return "bad duration";
    case Refusal::kLimit:
      return "above a limit";
    case Refusal::kPointMass:
      return "torque on a point mass";
  }
  return "";
}

InputRules::InputRules(const Simulator& simulator, const SimTime& time, const NodeOptions& options)
    : simulator_(simulator), time_(time), options_(options) {
  const std::vector<SceneBody>& bodies = simulator.scene().bodies;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const auto body = static_cast<Eigen::Index>(i);
    bodies_[bodies[i].name] = body;
    const BodyFrame& B = simulator.bodyFrame(body);
    Isometry3d X_LB = Isometry3d::Identity();
    X_LB.linear() = B.q_LB.toRotationMatrix();
    X_LB.translation() = B.p_LBcm;
    const Isometry3d X_BL = X_LB.inverse();
    std::map<std::string, Isometry3d> frames = {
        {bodies[i].name, X_BL}, {comFrameName(bodies[i].name), Isometry3d::Identity()}};
    for (const FixedFrame& frame : bodies[i].frames) frames[frame.name] = X_BL * frame.X_LF;
    frames_.push_back(frames);
  }
}

Eigen::Index InputRules::bodyNamed(const std::string& name) const {
  const auto found = bodies_.find(name);
  if (found != bodies_.end()) return found->second;
  throw RefusedInput(Refusal::kUnknownBody,
                     "there is no body " + quoted(name) + "; there are " + namesIn(bodies_));
}

InputRules::Frame InputRules::frameNamed(Eigen::Index body, const std::string& frame_id) const {
  const std::string name = withoutSlash(frame_id);
  if (name == options_.world_frame) return {Axes::kWorld, Isometry3d::Identity()};
  const auto found = frames_[body].find(name);
  if (found != frames_[body].end()) return {Axes::kBody, found->second};
  throw RefusedInput(
      Refusal::kUnknownFrame,
      (name.empty() ? "the frame is empty" : "frame " + quoted(name) + " is not this body's") +
          "; there are " + options_.world_frame + ", " + namesIn(frames_[body]));
}

AppliedWrench InputRules::applied(Eigen::Index body, const std::string& frame_id,
                                  const Wrench& wrench) const {
  const Frame frame = frameNamed(body, frame_id);
  const Matrix3d R = frame.X_BF.linear();
  return {frame.axes, {R * wrench.f_F, R * wrench.t_Q_F}, frame.X_BF.translation()};
}

AppliedWrench InputRules::appliedAt(Eigen::Index body, const std::string& frame_id,
                                    const std::string& point_frame, const Vector3d& point,
                                    const Wrench& wrench) const {
  AppliedWrench result = applied(body, frame_id, wrench);
  Frame from = frameNamed(body, frame_id);
  if (!point_frame.empty()) {
    from = frameNamed(body, point_frame);
    if (from.axes == Axes::kWorld) {
      throw RefusedInput(Refusal::kUnknownFrame, "point_frame " + quoted(point_frame) +
                                                     " is not fixed to the body; there are " +
                                                     namesIn(frames_[body]));
    }
  }
  result.p_BcmQ_B = from.X_BF * point;
  return result;
}

void InputRules::requireRoom(bool is_ahead) const {
  // As many again may act at once: only a paused simulation lets those wait.
  const std::size_t room = is_ahead ? kMaxWaiting : 2 * kMaxWaiting;
  if (simulator_.pendingCount() < room) return;
  throw RefusedInput(Refusal::kTooManyWaiting,
                     std::to_string(room) + " inputs are waiting for their tick");
}

Tick InputRules::startTick(const ros::Time& stamp) const {
  if (stamp.isZero()) {
    requireRoom(false);
    return simulator_.tick();
  }
  const ros::Time now = time_.at(simulator_.tick());
  // Not as a ros::Duration, which throws for 68 years and more.
  const double age_s = 1e-9 * static_cast<double>(static_cast<std::int64_t>(now.toNSec()) -
                                                  static_cast<std::int64_t>(stamp.toNSec()));
  std::ostringstream text;
  if (options_.stale_after_s > 0 && age_s > options_.stale_after_s) {
    text << "stamp is " << age_s << " s old, stale_after_s is " << options_.stale_after_s;
    throw RefusedInput(Refusal::kStale, text.str());
  }
  if (age_s < -kMaxAhead_s) {
    text << "stamp is " << -age_s << " s ahead of " << now << ", at most " << kMaxAhead_s
         << " s can wait; is the sender on another clock?";
    throw RefusedInput(Refusal::kTooFarAhead, text.str());
  }
  requireRoom(age_s < 0);
  return std::max(simulator_.tick(), time_.firstTickFrom(stamp));
}

InputRules::Bounds InputRules::wrenchBounds() const {
  return {"force",
          "torque",
          "N",
          "N m",
          options_.limits.force,
          options_.limits.torque,
          simulator_.scene().step_s()};
}

InputRules::Bounds InputRules::impulseBounds() const {
  return {"linear impulse",
          "angular impulse",
          "N s",
          "N m s",
          options_.limits.linear_impulse,
          options_.limits.angular_impulse,
          1};
}

void InputRules::check(Eigen::Index body, const AppliedWrench& applied,
                       const Bounds& bounds) const {
  if (!applied.wrench.f_F.allFinite() || !applied.wrench.t_Q_F.allFinite() ||
      !applied.p_BcmQ_B.allFinite())
    throw RefusedInput(Refusal::kNotFinite, "a component is not finite");
  // Squares overflow before the numbers do; a norm that is infinite fails the comparisons too.
  const double force = applied.wrench.f_F.norm();
  const double torque = applied.wrench.t_Q_F.norm();
  if (!(force <= bounds.max_force))
    refuseSize(bounds.force, force, bounds.max_force, bounds.force_unit);
  if (!(torque <= bounds.max_torque))
    refuseSize(bounds.torque, torque, bounds.max_torque, bounds.torque_unit);

  const BodyFrame& B = simulator_.bodyFrame(body);
  const double torque_about_com = torque + applied.p_BcmQ_B.norm() * force;  // at most
  // Exactly, as the simulator does: products of tiny numbers are zero.
  if (simulator_.scene().bodies[body].is_point_mass &&
      !(applied.wrench.t_Q_F.isZero(0) && applied.p_BcmQ_B.isZero(0)))
    throw RefusedInput(Refusal::kPointMass, "a point mass takes no torque, and forces only at it");
  const double speed = force * bounds.seconds / B.mass;
  const double spin = torque_about_com * bounds.seconds / B.I_BBcm_B(0);
  if (!(speed <= options_.limits.speed))
    refuseSize("change of speed", speed, options_.limits.speed, "m/s");
  if (!(spin <= options_.limits.angular_speed))
    refuseSize("change of angular speed", spin, options_.limits.angular_speed, "rad/s");
}

Tick InputRules::heldTicks() const {
  if (options_.wrench_timeout_s == 0) return 0;
  return std::max<Tick>(
      1,
      static_cast<Tick>(std::ceil(options_.wrench_timeout_s / simulator_.scene().step_s() - 1e-9)));
}

WrenchInput InputRules::checked(Eigen::Index body, const AppliedWrench& applied) const {
  check(body, applied, wrenchBounds());
  WrenchInput input;
  input.body = body;
  input.applied = applied;
  return input;
}

ImpulseInput InputRules::checkedImpulse(Eigen::Index body, const AppliedWrench& applied) const {
  check(body, applied, impulseBounds());
  ImpulseInput input;
  input.body = body;
  input.applied = applied;
  return input;
}

WrenchInput InputRules::held(Eigen::Index body, const geometry_msgs::WrenchStamped& message) const {
  const Wrench wrench = toWrench(message.wrench.force, message.wrench.torque);
  WrenchInput input = checked(body, applied(body, message.header.frame_id, wrench));
  input.start = startTick(message.header.stamp);
  input.ticks = heldTicks();
  input.replaces = true;
  return input;
}

WrenchInput InputRules::scheduled(const BodyWrench& message) const {
  const Eigen::Index body = bodyNamed(message.body);
  const Wrench wrench = toWrench(message.wrench.force, message.wrench.torque);
  WrenchInput input = checked(
      body, appliedAt(body, message.frame, message.point_frame, toVector(message.point), wrench));
  input.start = startTick(message.start);
  input.replaces = message.duration.isZero();
  input.ticks = input.replaces ? heldTicks() : time_.wholeTicks(message.duration);
  if (!input.replaces && input.ticks <= 0) {
    std::ostringstream text;
    text << "duration " << message.duration << " s is not a positive whole number of steps of "
         << simulator_.scene().step_s() << " s";
    throw RefusedInput(Refusal::kDuration, text.str());
  }
  return input;
}

ImpulseInput InputRules::impulse(Eigen::Index body, const ImpulseStamped& message) const {
  const Wrench impulse = toWrench(message.linear, message.angular);
  ImpulseInput input = checkedImpulse(body, applied(body, message.header.frame_id, impulse));
  input.start = startTick(message.header.stamp);
  return input;
}

ImpulseInput InputRules::impulse(const BodyImpulse& message) const {
  const Eigen::Index body = bodyNamed(message.body);
  const Wrench impulse = toWrench(message.linear, message.angular);
  ImpulseInput input = checkedImpulse(
      body, appliedAt(body, message.frame, message.point_frame, toVector(message.point), impulse));
  input.start = startTick(message.start);
  return input;
}

}  // namespace rigid_body_sim

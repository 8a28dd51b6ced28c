// An example of a user's controller: it listens to `states` and pushes the demo's bodies.
//   astrobee    kept where it was first seen, by wrenches in its own axes; now and then pushed
//   nesc_brick  spun up by an angular impulse, and down again by the opposite one
//   ball        thrown up again whenever it comes down, by an impulse at a stated time
//   t_handle    left alone; its stem's tip leaves a trail
// All of it is timed by the stamps of `states`: the same at any speed at which messages arrive in
// time, waiting while paused. Only the picture (`demo/*`) follows the wall clock.

#include <geometry_msgs/WrenchStamped.h>
#include <nav_msgs/Path.h>
#include <rigid_body_sim/BodyStates.h>
#include <rigid_body_sim/ImpulseStamped.h>
#include <ros/ros.h>
#include <visualization_msgs/MarkerArray.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <map>
#include <string>

namespace {

using Eigen::Vector3d;
using rigid_body_sim::BodyStates;
using rigid_body_sim::ImpulseStamped;
using visualization_msgs::Marker;

constexpr double kGravity = 9.80665;  // [m/s^2]
constexpr double kNever = -1e9;       // [s] long before any stamp

// An impulse is sent this long before it acts: 3 ticks, whatever ROS takes. Where that is not
// enough the lead doubles.
constexpr double kLead = 0.06;   // [s]
constexpr double kMaxLead = 8;   // [s] the simulator takes stamps up to 10 s ahead
constexpr double kPeriod = 5.0;  // [s] between pushes, of the astrobee and of the brick

// Astrobee, about 10 kg and 0.17 kg m^2: 1.2 rad/s and 2 rad/s of bandwidth, damping ratio 0.8.
constexpr double kHoldPeriod = 0.05;         // [s] between wrenches
constexpr double kHoldStiffness = 14.4;      // [N/m]    m w^2
constexpr double kHoldDamping = 19.2;        // [N s/m]  2 * 0.8 m w
constexpr double kHoldTurnStiffness = 0.68;  // [N m/rad]
constexpr double kHoldTurnDamping = 0.54;    // [N m s/rad]
constexpr double kPush = 2.0;                // [N s] a disturbance

// The brick: spun up and down in turn.
constexpr double kKick = 0.02;                                     // [N m s]
const Vector3d kKickAxis = Vector3d(0.3, -0.6, 0.7).normalized();  // in the world

constexpr double kBallMass = 0.6085;                 // [kg]
constexpr double kBallRadius = 0.1217;               // [m]
constexpr double kBallLow = 0.35, kBallHigh = 1.35;  // [m] its centre, thrown from and up to

constexpr double kShown = 0.5;         // [s] a push, as an arrow and in words
constexpr double kTrailShown = 6.8;    // [s] two flips
constexpr double kTrailGap = 0.015;    // [s] between points: at most 454 of them
constexpr double kLabelHeight = 1.77;  // [m]
const Vector3d kStemTip(0, 0, 0.27);   // [m] in t_handle

struct Motion {
  Vector3d p_WL;            // [m] link origin in the world
  Eigen::Quaterniond q_WL;  // link in the world
  Vector3d v_WL_L;          // [m/s] of the link's origin, in the link's axes
  Vector3d w_WL_L;          // [rad/s], in the link's axes
};

Vector3d toEigen(const geometry_msgs::Vector3& v) { return {v.x, v.y, v.z}; }

template <typename Message>
Message fromEigen(const Vector3d& v) {
  Message msg;
  msg.x = v.x(), msg.y = v.y(), msg.z = v.z();
  return msg;
}

const auto toVector3 = fromEigen<geometry_msgs::Vector3>;
const auto toPoint = fromEigen<geometry_msgs::Point>;

Motion toMotion(const geometry_msgs::Pose& pose, const geometry_msgs::Twist& twist) {
  const auto& p = pose.position;
  const auto& q = pose.orientation;
  return {{p.x, p.y, p.z}, {q.w, q.x, q.y, q.z}, toEigen(twist.linear), toEigen(twist.angular)};
}

// [N], [N m] in the body's axes: a spring and a damper towards `home`.
geometry_msgs::Wrench holdWrench(const Motion& motion, const Motion& home) {
  const Vector3d error_L = motion.q_WL.conjugate() * (home.p_WL - motion.p_WL);
  const Eigen::AngleAxisd turn(motion.q_WL.conjugate() * home.q_WL);
  geometry_msgs::Wrench wrench;
  wrench.force = toVector3(kHoldStiffness * error_L - kHoldDamping * motion.v_WL_L);
  wrench.torque =
      toVector3(kHoldTurnStiffness * turn.angle() * turn.axis() - kHoldTurnDamping * motion.w_WL_L);
  return wrench;
}

using Color = std::array<float, 3>;
constexpr Color kWhite{1, 1, 1}, kAmber{1, 0.8f, 0.3f}, kGreen{0.45f, 0.95f, 0.45f};

// How an impulse is shown.
struct Arrow {
  Vector3d tail, head;  // [m]
  std::string text;
  std::string frame = {};
  double time = kNever;  // [s] when the impulse acts
};

class DemoPilot {
 public:
  DemoPilot() {
    for (const char* body : {"astrobee", "nesc_brick", "ball"}) {
      impulse_pubs_[body] = nh_.advertise<ImpulseStamped>(std::string(body) + "/impulse", 100);
    }
    wrench_pub_ = nh_.advertise<geometry_msgs::WrenchStamped>("astrobee/wrench", 10);
    marker_pub_ = nh_.advertise<visualization_msgs::MarkerArray>("demo/markers", 1);
    trail_pub_ = nh_.advertise<nav_msgs::Path>("demo/t_handle_trail", 1);
    states_sub_ = nh_.subscribe("states", 10, &DemoPilot::onStates, this);
    draw_timer_ = nh_.createWallTimer(ros::WallDuration(0.05), &DemoPilot::draw, this);
  }

 private:
  // What is known of the simulation; forgotten when its time starts again.
  struct Memory {
    double now = kNever;      // [s]
    std_msgs::Header header;  // of the newest states: its time and the world frame
    std::map<std::string, Motion> motions, homes;
    std::map<std::string, Arrow> arrows;
    double held = kNever, pushed = kNever, kicked = kNever, thrown = kNever;  // [s] when last
    double lead = kLead;                                                      // [s]
    bool spun_up = false, has_risen = true, is_too_late = false;
    nav_msgs::Path trail;
  };

  void onStates(const BodyStates& states) {
    const double now = states.header.stamp.toSec();
    if (now < m_.now) m_ = Memory();
    if (m_.now == kNever) m_.pushed = m_.kicked = now - kPeriod + 1.0;  // the first ones soon
    m_.now = now;
    m_.header = states.header;
    for (std::size_t i = 0; i < states.names.size(); ++i) {
      const Motion motion = toMotion(states.poses[i], states.twists[i]);
      m_.homes.emplace(states.names[i], motion);
      m_.motions.insert_or_assign(states.names[i], motion);
    }
    if (m_.motions.count("t_handle")) extendTrail();
    if (m_.motions.count("ball")) juggleBall();
    if (m_.is_too_late) return;
    if (m_.motions.count("astrobee")) flyAstrobee();
    if (m_.motions.count("nesc_brick")) spinBrick();
  }

  void flyAstrobee() {
    if (m_.now >= m_.held + kHoldPeriod) {
      m_.held = m_.now;
      geometry_msgs::WrenchStamped msg;
      msg.header.stamp = m_.header.stamp;
      msg.header.frame_id = "astrobee";  // its axes, at its origin: turns with it while it is held
      msg.wrench = holdWrench(m_.motions.at("astrobee"), m_.homes.at("astrobee"));
      wrench_pub_.publish(msg);
    }
    if (m_.now >= m_.pushed + kPeriod) {
      m_.pushed = m_.now;
      push("astrobee", "astrobee_nozzle", {-kPush, 0, 0}, Vector3d::Zero(),
           {{0.40, 0, 0}, {0.04, 0, 0}, "pushed off centre"});
    }
  }

  void spinBrick() {
    if (m_.now < m_.kicked + kPeriod) return;
    m_.kicked = m_.now;
    m_.spun_up = !m_.spun_up;
    const Vector3d kick_W = (m_.spun_up ? kKick : -kKick) * kKickAxis;
    const Vector3d& p_WL = m_.motions.at("nesc_brick").p_WL;
    push("nesc_brick", m_.header.frame_id, Vector3d::Zero(), kick_W,
         {p_WL, p_WL + 0.40 * kick_W.normalized(), m_.spun_up ? "spun up" : "spun down"});
  }

  // The throw is computed for the height and the velocity the ball will have when it acts.
  void juggleBall() {
    const Motion& ball = m_.motions.at("ball");
    const double v_now = (ball.q_WL * ball.v_WL_L).z();
    const double v = v_now - kGravity * m_.lead;
    const double z = ball.p_WL.z() + v_now * m_.lead - 0.5 * kGravity * m_.lead * m_.lead;
    if (v_now > 0) {  // thrown in time, or reset
      m_.has_risen = true;
      m_.is_too_late = false;
      m_.lead = kLead;
    }
    if (v > 0 || z > kBallLow || m_.now < m_.thrown + 2 * m_.lead || m_.is_too_late) return;
    if (!m_.has_risen) return throwEarlier();
    m_.has_risen = false;
    m_.thrown = m_.now;
    const double impulse = kBallMass * (std::sqrt(2 * kGravity * (kBallHigh - z)) - v);
    const Vector3d below(ball.p_WL.x(), ball.p_WL.y(), kBallLow - kBallRadius);
    push("ball", m_.header.frame_id, {0, 0, impulse}, Vector3d::Zero(),
         {below - Vector3d(0, 0, 0.3), below, "thrown up again"}, m_.lead);
  }

  // The last throw came too late: the ball still falls. The next one has twice the time.
  void throwEarlier() {
    m_.has_risen = true;  // forgiven
    m_.lead *= 2;
    // As fast as possible can be faster than messages travel: then nothing can be flown from here.
    m_.is_too_late = m_.lead > kMaxLead;
    if (m_.is_too_late) ROS_WARN("the simulation is too fast to be flown from here: hands off");
  }

  // Gives the impulse [N s], [N m s] in the axes and at the origin of `frame`.
  void push(const std::string& body, const std::string& frame, const Vector3d& linear,
            const Vector3d& angular, Arrow arrow, double lead = kLead) {
    ImpulseStamped msg;
    msg.header.stamp = m_.header.stamp + ros::Duration(lead);
    msg.header.frame_id = frame;
    msg.linear = toVector3(linear);
    msg.angular = toVector3(angular);
    impulse_pubs_.at(body).publish(msg);
    arrow.frame = frame;
    arrow.time = m_.now + lead;
    m_.arrows[body] = arrow;
  }

  void extendTrail() {
    auto& points = m_.trail.poses;
    if (!points.empty() && m_.now < points.back().header.stamp.toSec() + kTrailGap) return;
    const Motion& handle = m_.motions.at("t_handle");
    m_.trail.header = m_.header;
    points.emplace_back();
    points.back().header = m_.header;
    points.back().pose.position = toPoint(handle.p_WL + handle.q_WL * kStemTip);
    points.back().pose.orientation.w = 1;
    while (m_.now > points.front().header.stamp.toSec() + kTrailShown) points.erase(points.begin());
  }

  void draw(const ros::WallTimerEvent&) {
    markers_.markers.clear();
    label("t_handle", "T-handle", "left alone: it flips");
    const char* too_fast = m_.is_too_late ? "too fast to be flown" : nullptr;
    label("astrobee", "Astrobee", too_fast ? too_fast : "held: force red, torque violet");
    label("nesc_brick", "NESC brick", "tumbling freely");
    label("ball", "Ball", too_fast ? too_fast : "falling freely");
    drawBallRange();
    for (const auto& [body, arrow] : m_.arrows) {
      Marker& marker = addMarker("impulse/" + body, arrow.frame, Marker::ARROW, kAmber);
      marker.action = wasPushed(body) ? Marker::ADD : Marker::DELETE;
      marker.points = {toPoint(arrow.tail), toPoint(arrow.head)};
      marker.scale.x = 0.035, marker.scale.y = 0.08, marker.scale.z = 0.12;
    }
    marker_pub_.publish(markers_);
    if (!m_.trail.poses.empty()) trail_pub_.publish(m_.trail);
  }

  bool wasPushed(const std::string& body) const {
    const auto arrow = m_.arrows.find(body);
    return arrow != m_.arrows.end() && m_.now >= arrow->second.time &&
           m_.now < arrow->second.time + kShown;
  }

  // Without a stamp, a marker is drawn with the newest transform.
  Marker& addMarker(const std::string& ns, const std::string& frame, int type, const Color& c,
                    const Vector3d& p = Vector3d::Zero()) {
    markers_.markers.emplace_back();
    Marker& marker = markers_.markers.back();
    marker.header.frame_id = frame;
    marker.ns = ns;
    marker.type = type;
    marker.color.r = c[0], marker.color.g = c[1], marker.color.b = c[2], marker.color.a = 1;
    marker.pose.position = toPoint(p);
    marker.pose.orientation.w = 1;
    return marker;
  }

  void label(const std::string& body, const char* name, const char* calm) {
    if (!m_.homes.count(body)) return;
    const Vector3d& home = m_.homes.at(body).p_WL;
    const Vector3d p(home.x(), home.y(), kLabelHeight);
    Marker& top =
        addMarker("name/" + body, m_.header.frame_id, Marker::TEXT_VIEW_FACING, kWhite, p);
    top.text = name;
    top.scale.z = 0.13;
    const bool is_pushed = wasPushed(body);
    Marker& status = addMarker("status/" + body, m_.header.frame_id, Marker::TEXT_VIEW_FACING,
                               is_pushed ? kAmber : kGreen, p - Vector3d(0, 0, 0.13));
    status.text = is_pushed ? m_.arrows.at(body).text : calm;
    status.scale.z = 0.085;
  }

  // Bars where the ball's lowest point is thrown and where its highest should turn.
  void drawBallRange() {
    if (!m_.homes.count("ball")) return;
    const Vector3d& home = m_.homes.at("ball").p_WL;
    const Vector3d p(home.x(), home.y(), 0);
    Marker& bars = addMarker("ball range", m_.header.frame_id, Marker::LINE_LIST, kWhite, p);
    bars.scale.x = 0.008;
    for (const double z : {kBallLow - kBallRadius, kBallHigh + kBallRadius}) {
      for (const double y : {-0.16, 0.16}) bars.points.push_back(toPoint({0, y, z}));
    }
  }

  ros::NodeHandle nh_;
  std::map<std::string, ros::Publisher> impulse_pubs_;
  ros::Publisher wrench_pub_, marker_pub_, trail_pub_;
  ros::Subscriber states_sub_;
  ros::WallTimer draw_timer_;
  Memory m_;
  visualization_msgs::MarkerArray markers_;
};

}  // namespace

int main(int argc, char** argv) {
  ros::init(argc, argv, "demo_pilot");
  DemoPilot pilot;
  ros::spin();
}

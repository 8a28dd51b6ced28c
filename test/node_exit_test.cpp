// How the node starts and how it ends: the real program, with the parameters and signals that a
// user gives it.

#include <geometry_msgs/WrenchStamped.h>
#include <tf2_msgs/TFMessage.h>

#include <algorithm>
#include <fstream>
#include <thread>

#include "generic.hpp"
#include "ros_fixture.hpp"
#include "tools/child_process.hpp"
#include "xml_rpc_tree.hpp"

namespace rigid_body_sim {
namespace {

constexpr char kBall[] = "bodies: {ball: {sphere: {radius: 0.1, density: 1000}}}";

/// A node with private parameters, alone in a namespace of its own.
class Node : public ChildProcess {
 public:
  explicit Node(const std::string& yaml, const std::string& space = newSpace())
      : ChildProcess(command(yaml, space)), space_(space) {}
  ~Node() { ros::param::del(space_); }

  const std::string& space() const { return space_; }

  /// Waits until it has sent the states of `ticks` ticks.
  bool runs(std::uint64_t ticks = 0) {
    bool is_there = false;
    const boost::function<void(const BodyStates&)> take = [&](const BodyStates& states) {
      is_there = is_there || states.tick >= ticks;
    };
    const ros::Subscriber subscriber =
        ros::NodeHandle().subscribe<BodyStates>(space_ + "/states", 100, take);
    return waitFor([&] { return is_there; });
  }

  bool pauses() {
    std_srvs::SetBool call;
    call.request.data = true;
    return ros::service::waitForService(space_ + "/sim/pause", 10'000) &&
           ros::service::call(space_ + "/sim/pause", call) && call.response.success;
  }

 private:
  static std::vector<std::string> command(const std::string& yaml, const std::string& space) {
    ros::param::set(space + "/sim", toXmlRpc(readYaml(yaml, "test")));
    return {PROGRAM_DIR "/rigid_body_sim_node", "__ns:=" + space, "__name:=sim"};
  }

  static std::string newSpace() {
    static int count = 0;
    return "/space" + std::to_string(++count);
  }

  std::string space_;
};

/// The line that says why the node ends.
std::string fatalLine(const std::string& said) {
  const std::size_t begin = said.find("[FATAL]");
  if (begin == std::string::npos) return {};
  return said.substr(begin, said.find('\n', begin) - begin);
}

void expectRefusal(const std::string& yaml, const std::vector<std::string>& parts) {
  SCOPED_TRACE(yaml);
  Node node(yaml);
  EXPECT_EQ(node.exitCode(), 1) << node.said();
  EXPECT_TRUE(contains(fatalLine(node.said()), parts)) << node.said();
}

/// A file that is there as long as this is.
class TemporaryFile {
 public:
  TemporaryFile(const std::string& name, const std::string& text)
      : path_(testing::TempDir() + std::to_string(getpid()) + "_" + name) {
    std::ofstream(path_) << text;
  }
  ~TemporaryFile() { std::remove(path_.c_str()); }
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

std::string ballUrdf(const std::string& mass) {
  return "<robot name='r'><link name='hull'><inertial><mass value='" + mass +
         "'/><inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' izz='1'/></inertial></link></robot>";
}

// ---- Errors

struct Bad {
  std::string yaml;                ///< beside the ball
  std::vector<std::string> parts;  ///< of the line: key, value, what is allowed, unit
};

void PrintTo(const Bad& bad, std::ostream* out) { *out << bad.yaml; }

class ABadParameter : public testing::TestWithParam<Bad> {};

TEST_P(ABadParameter, EndsTheNodeWithOneAndALineThatNamesKeyValueAndWhatIsAllowed) {
  expectRefusal(kBall + ("\n" + GetParam().yaml), GetParam().parts);
}

// clang-format off
INSTANTIATE_TEST_SUITE_P(Table, ABadParameter, testing::Values(
    Bad{"step_s: 0", {"step_s: 0 is not", "from 1e-06 to 1 [s]"}},
    Bad{"step_s: -1", {"step_s: -1 is not", "from 1e-06 to 1 [s]"}},
    Bad{"step_s: .nan", {"step_s: nan is not", "from 1e-06 to 1 [s]"}},
    Bad{"step_s: .inf", {"step_s: inf is not", "from 1e-06 to 1 [s]"}},
    Bad{"step_s: 10", {"step_s: 10 is not", "from 1e-06 to 1 [s]"}},
    Bad{"step_s: '0.02'", {"step_s: '0.02' is not", "from 1e-06 to 1 [s]", "leave the quotes out"}},
    Bad{"step_s: 1e-2", {"step_s: '1e-2' is not", "write 1.0e-2"}},
    Bad{"step_s: true", {"step_s: true is not", "from 1e-06 to 1 [s]"}},
    Bad{"step_s: [0.02]", {"step_s: [0.02] is not", "from 1e-06 to 1 [s]"}},
    Bad{"steps: 0.02", {"steps: unknown key", "'step_s'"}},
    Bad{"integrator: split3", {"integrator:", "split3", "split2"}},
    Bad{"integrator: 2", {"integrator: 2", "string"}},
    Bad{"effects: {gravty: {acceleration: [0, 0, -9.8]}}", {"effects.gravty: unknown key", "'gravity'"}},
    Bad{"effects: {gravity: {acceleration: [0, -9.8]}}", {"effects.gravity.acceleration: [0, -9.8] is not a list of 3 numbers [m/s^2]"}},
    Bad{"effects: {gravity: {acceleration: [0, [0], 1]}}", {"effects.gravity.acceleration[1]: [0] is not", "[m/s^2]"}},
    Bad{"effects: {gravity: {acceleration: [0, '0', 1]}}", {"effects.gravity.acceleration[1]: '0' is not", "[m/s^2]"}},
    Bad{"effects: [gravity]", {"effects: ['gravity']", "map"}},
    Bad{"joints: free", {"joints: 'free'", "refuse or lock"}},
    Bad{"urdf: nowhere.urdf", {"urdf: 'nowhere.urdf'", "list"}},
    Bad{"urdf: [/nowhere/at_all.urdf]", {"/nowhere/at_all.urdf", "cannot be read"}},
    Bad{"urdf_parameter: no_such_description", {"urdf_parameter", "no_such_description", "string"}},
    Bad{"urdf_parameter: sim/paused\npaused: true", {"urdf_parameter", "sim/paused", "string"}},
    Bad{"world_frame: ball", {"world_frame", "'ball'"}},
    Bad{"real_time_factor: -1", {"real_time_factor: -1 is not", "from 0 to 1000000 [times real time]"}},
    Bad{"real_time_factor: 1.0e-12", {"real_time_factor: 1e-12", "0", "1e-06 [times real time]"}},
    Bad{"wrench_timeout_s: '1'", {"wrench_timeout_s: '1' is not", "[s]"}},
    Bad{"limits: {force: 0}", {"limits.force: 0 is not", "> 0 [N]"}},
    Bad{"paused: 1", {"paused: 1 is not true or false"}}));
// clang-format on

TEST(ABadBody, EndsTheNodeWithOneAndALineThatNamesIt) {
  expectRefusal("{}", {"bodies", "no body"});
  expectRefusal("paused: true", {"bodies", "no body"});
  expectRefusal("bodies: {ball: {sphere: {radius: 0.1, density: 1000}, position: [1, 2]}}",
                {"bodies.ball.position: [1, 2] is not a list of 3 numbers [m]"});
  expectRefusal("bodies: {ball: {sphere: {radius: -0.1, density: 1000}}}",
                {"bodies.ball.sphere.radius: -0.1 is not", "> 0 [m]"});
  expectRefusal("bodies: {ball: {sphere: {radius: 0.1, density: 1000}, shape: true}}",
                {"bodies.ball.shape: unknown key"});
  expectRefusal("bodies: {ball: {mass: 1, inertia: [1, 1, 3]}}", {"bodies.ball", "triangle"});
  expectRefusal("bodies: {hull: {position: [0, 0, 0]}}", {"bodies.hull", "no URDF", "mass"});
}

TEST(ABadUrdf, EndsTheNodeWithOneAndALineThatNamesFileLinkAndRule) {
  const TemporaryFile negative("negative.urdf", ballUrdf("-1"));
  expectRefusal("urdf: [" + negative.path() + "]", {negative.path(), "hull", "mass", "-1"});
  const TemporaryFile comma("comma.urdf", ballUrdf("0,5"));
  expectRefusal("urdf: [" + comma.path() + "]", {comma.path(), "hull", "mass", "0,5"});
  const TemporaryFile cut("cut.urdf", ballUrdf("1").substr(0, 60));
  expectRefusal("urdf: [" + cut.path() + "]", {cut.path()});
}

TEST(ABadUrdf, InAParameterEndsTheNodeWithOneAndALineThatNamesTheParameter) {
  ros::param::set("/bad_description", ballUrdf("nan"));
  expectRefusal("urdf_parameter: bad_description", {"bad_description", "hull", "mass", "nan"});
  ros::param::del("/bad_description");
}

TEST(AnEmptyBlock, ThatTheParameterServerDroppedEndsTheNodeWithOneAndItsPath) {
  const auto dropped = [](const std::string& scene, const std::string& path) {
    const TemporaryFile file("dropped.yaml", scene);
    expectRefusal("scene_file: " + file.path() + "\n" + kBall,
                  {path + ": empty in " + file.path()});
  };
  dropped("effects: {gravity: {}}\n" + std::string(kBall), "effects.gravity");
  dropped("bodies: {ball: {added_mass: {}}}", "bodies.ball.added_mass");
  dropped("accuracy: {}\n" + std::string(kBall), "accuracy");
  // What means the same by not being there may be empty, and what is there is not dropped.
  const TemporaryFile file("whole.yaml", "effects: {}\nlimits: {}\n" + std::string(kBall));
  EXPECT_TRUE(Node("scene_file: " + file.path() + "\n" + kBall).runs());
}

TEST(ASceneFile, ThatCannotBeReadEndsTheNodeWithOneAndSaysFromWhere) {
  expectRefusal("scene_file: nowhere.yaml\n" + std::string(kBall),
                {"scene_file", "'nowhere.yaml'", "cannot be read", "absolute"});
}

TEST(SimTimeWithoutAClock, EndsTheNodeWithOneAndALineThatNamesBoth) {
  ros::param::set("/use_sim_time", true);
  expectRefusal(std::string(kBall) + "\npublish_clock: false",
                {"publish_clock: false", "/use_sim_time is true"});
  ros::param::del("/use_sim_time");
}

TEST(AUrdf, IsFoundBesideTheSceneFileAndInAParameter) {
  const TemporaryFile file("ball.urdf", ballUrdf("1"));
  const std::size_t slash = file.path().rfind('/');
  const TemporaryFile scene("scene.yaml", "");
  Node from_file("scene_file: " + scene.path() + "\nurdf: [" + file.path().substr(slash + 1) + "]");
  EXPECT_TRUE(from_file.runs()) << from_file.said();
  ros::param::set("/good_description", ballUrdf("1"));
  Node from_parameter("urdf_parameter: good_description");
  EXPECT_TRUE(from_parameter.runs()) << from_parameter.said();
  ros::param::del("/good_description");
}

// ---- Signals

constexpr double kEnd_s = 1;  // promised

void expectCleanEnd(Node& node) {
  node.signal(SIGINT);
  EXPECT_EQ(node.exitCode(kEnd_s), 0) << node.said();
}

TEST(SigInt, EndsARunningNodeWithZeroWithinASecond) {
  for (const std::uint64_t ticks : {0, 1, 2, 3, 5, 8, 13}) {
    Node node(kBall);
    ASSERT_TRUE(node.runs(ticks)) << node.said();
    expectCleanEnd(node);
  }
}

TEST(SigInt, EndsAPausedNodeWithZeroWithinASecond) {
  Node node(kBall);
  ASSERT_TRUE(node.pauses()) << node.said();
  expectCleanEnd(node);
  Node born_paused(std::string(kBall) + "\npaused: true");
  ASSERT_TRUE(born_paused.runs()) << born_paused.said();
  expectCleanEnd(born_paused);
}

TEST(SigInt, EndsANodeThatRunsAsFastAsItCanWithZeroWithinASecond) {
  Node node(std::string(kBall) + "\nreal_time_factor: 0");
  ASSERT_TRUE(node.runs(1000)) << node.said();
  expectCleanEnd(node);
}

TEST(SigInt, EndsANodeWhoseNextTickIsFarAwayWithZeroWithinASecond) {
  Node node(std::string(kBall) + "\nstep_s: 1.0\nreal_time_factor: 0.001");
  // Its first states were sent before anybody listened, the next ones come in 1000 s.
  ASSERT_TRUE(waitFor([&] { return ros::service::exists(node.space() + "/sim/reset", false); }))
      << node.said();
  expectCleanEnd(node);
}

TEST(SigInt, EndsANodeInAMillionStepsWithZeroWithinASecond) {
  Node node(std::string(kBall) + "\npaused: true");
  ASSERT_TRUE(node.runs()) << node.said();
  std::thread caller([&] {
    Step call;
    call.request.ticks = 1'000'000;
    ros::service::call(node.space() + "/sim/step", call);
  });
  EXPECT_TRUE(node.runs(1000)) << node.said();
  expectCleanEnd(node);
  caller.join();
}

TEST(SigInt, EndsANodeThatTheMasterHasJustHeardOf) {
  Node node(kBall);
  ASSERT_TRUE(waitFor([&] {
    std::vector<std::string> nodes;
    ros::master::getNodes(nodes);
    return std::count(nodes.begin(), nodes.end(), node.space() + "/sim") > 0;
  }));
  expectCleanEnd(node);
}

// ---- Others

TEST(TwoNodesOfOneName, TheFirstEndsWithZeroAndTheReason) {
  Node first(kBall);
  ASSERT_TRUE(first.runs()) << first.said();
  Node second(kBall, first.space());
  EXPECT_EQ(first.exitCode(), 0);
  EXPECT_TRUE(contains(first.said(), {"new node registered with same name"}));
  EXPECT_TRUE(second.runs(1)) << second.said();
}

TEST(ANodeWhoseOutputNobodyReads, GoesOn) {
  Node node(kBall);
  ASSERT_TRUE(node.runs()) << node.said();
  node.closeOutput();
  const ros::Publisher publisher =
      ros::NodeHandle().advertise<geometry_msgs::WrenchStamped>(node.space() + "/ball/wrench", 10);
  ASSERT_TRUE(waitFor([&] { return publisher.getNumSubscribers() > 0; }));
  publisher.publish(geometry_msgs::WrenchStamped());  // without a frame: it is warned about
  EXPECT_TRUE(node.runs(50));
}

TEST(AHundredBodies, AreReadySoon) {
  std::string urdf = "<robot name='swarm'><link name='world'/>";
  for (int i = 0; i < 100; ++i) {
    const std::string name = "body" + std::to_string(i);
    urdf += "<link name='" + name +
            "'><inertial><origin xyz='0.1 0.2 0.3' rpy='0.4 0.5 0.6'/><mass value='2'/>"
            "<inertia ixx='1' ixy='0.1' ixz='0.2' iyy='1.1' iyz='0.3' izz='1.2'/></inertial></link>"
            "<joint name='to_" +
            name + "' type='floating'><parent link='world'/><child link='" + name + "'/></joint>";
  }
  const TemporaryFile file("swarm.urdf", urdf + "</robot>");
  bool is_ready = false;
  const boost::function<void(const tf2_msgs::TFMessage&)> take =
      [&](const tf2_msgs::TFMessage& tf) { is_ready = is_ready || tf.transforms.size() == 100; };
  const ros::Subscriber subscriber =
      ros::NodeHandle().subscribe<tf2_msgs::TFMessage>("/tf", 10, take);
  Node node("urdf: [" + file.path() + "]");
  ASSERT_TRUE(waitFor([&] { return is_ready; })) << node.said();
  const double ready_s = node.secondsSinceStart();
  EXPECT_LE(ready_s, 3);  // one second is promised of an idle machine: measured 0.5 s
  RecordProperty("ready_ms", static_cast<int>(1000 * ready_s));
  std::cout << "first /tf of 100 bodies after " << ready_s << " s\n";
  expectCleanEnd(node);
}

}  // namespace
}  // namespace rigid_body_sim

int main(int argc, char** argv) { return rigid_body_sim::runRostest(argc, argv, "node_exit_test"); }

#include "node/options.hpp"

#include "generic.hpp"

namespace rigid_body_sim {
namespace {

constexpr std::int64_t kWall_ns = 1'700'000'000'123'456'789;

NodeOptions read(const std::string& yaml, bool use_sim_time = true) {
  const Parameters parameters(readYaml(yaml, "test"), "");
  NodeOptions options = readNodeOptions(parameters, use_sim_time, kWall_ns);
  parameters.refuseUnknown();
  return options;
}

std::vector<int> ticksIn(const PublishEvery& every) {
  return {every.tf,    every.states, every.effect_wrenches,
          every.twist, every.odom,   every.applied_wrench};
}

TEST(NodeOptions, HaveTheseDefaults) {
  const NodeOptions options = read("{}");
  EXPECT_EQ(options.scene_folder, "");
  EXPECT_EQ(options.world_frame, "world");
  EXPECT_TRUE(options.publish_clock);
  EXPECT_TRUE(options.publish_link_frames);
  for (const int ticks : ticksIn(options.publish_every)) EXPECT_EQ(ticks, 1);
  EXPECT_TRUE(options.body_inputs);
  EXPECT_FALSE(options.paused);
  EXPECT_EQ(options.real_time_factor, 1);
  EXPECT_EQ(options.wrench_timeout_s, 1);
  EXPECT_EQ(options.stale_after_s, 1);
  EXPECT_EQ(options.limits.force, 1e12);
  EXPECT_EQ(options.limits.torque, 1e12);
  EXPECT_EQ(options.limits.linear_impulse, 1e12);
  EXPECT_EQ(options.limits.angular_impulse, 1e12);
  EXPECT_EQ(options.limits.speed, 1e8);
  EXPECT_EQ(options.limits.angular_speed, 1e6);
}

TEST(NodeOptions, TakeEveryValueThatIsGiven) {
  const NodeOptions options = read(R"(
    scene_file: /some/where/scene.yaml
    world_frame: map/odom
    publish_clock: true
    publish_link_frames: false
    publish_every: {tf: 0, states: 2, effect_wrenches: 3, twist: 4, odom: 5,
                    applied_wrench: 1000000}
    body_inputs: false
    paused: true
    real_time_factor: 0.5
    wrench_timeout_s: 0
    stale_after_s: 2.5
    start_time_s: 100.001
    limits: {force: 1, torque: 2, linear_impulse: 3, angular_impulse: 4, speed: 5,
             angular_speed: 6.5})");
  EXPECT_EQ(options.scene_folder, "/some/where");
  EXPECT_EQ(options.world_frame, "map/odom");
  EXPECT_FALSE(options.publish_link_frames);
  EXPECT_EQ(ticksIn(options.publish_every), (std::vector<int>{0, 2, 3, 4, 5, 1'000'000}));
  EXPECT_FALSE(options.body_inputs);
  EXPECT_TRUE(options.paused);
  EXPECT_EQ(options.real_time_factor, 0.5);
  EXPECT_EQ(options.wrench_timeout_s, 0);
  EXPECT_EQ(options.stale_after_s, 2.5);
  EXPECT_EQ(options.start_time_ns, 100'001'000'000);
  EXPECT_EQ(options.limits.force, 1);
  EXPECT_EQ(options.limits.torque, 2);
  EXPECT_EQ(options.limits.linear_impulse, 3);
  EXPECT_EQ(options.limits.angular_impulse, 4);
  EXPECT_EQ(options.limits.speed, 5);
  EXPECT_EQ(options.limits.angular_speed, 6.5);
}

TEST(NodeOptions, PublishTheClockExactlyWhenOthersTakeTheirTimeFromIt) {
  EXPECT_TRUE(read("{}", true).publish_clock);
  EXPECT_FALSE(read("{}", false).publish_clock);
  EXPECT_TRUE(read("publish_clock: true", false).publish_clock);
}

TEST(NodeOptions, RefuseToGiveNoClockToThoseWhoWaitForIt) {
  EXPECT_TRUE(contains(refusal([] { read("publish_clock: false", true); }),
                       {"publish_clock: false", "/use_sim_time is true"}));
  EXPECT_FALSE(read("publish_clock: false", false).publish_clock);
}

TEST(NodeOptions, StartAtOneSecondWithAClockAndAtTheWallTimeWithout) {
  EXPECT_EQ(read("publish_clock: true", true).start_time_ns, 1'000'000'000);
  EXPECT_EQ(read("publish_clock: true", false).start_time_ns, 1'000'000'000);
  EXPECT_EQ(read("{}", false).start_time_ns, kWall_ns);
  EXPECT_EQ(read("start_time_s: 5", false).start_time_ns, 5'000'000'000);
}

TEST(NodeOptions, NeverStartAtTheStampThatMeansLatest) {
  EXPECT_EQ(read("start_time_s: 0.001").start_time_ns, 1'000'000);
  EXPECT_TRUE(contains(refusal([] { read("start_time_s: 0"); }), {"start_time_s", "0.001", "[s]"}));
}

TEST(NodeOptions, FindTheSceneFolderInTheScenePath) {
  EXPECT_EQ(read("scene_file: scene.yaml").scene_folder, "");
  EXPECT_EQ(read("scene_file: config/scene.yaml").scene_folder, "config");
  EXPECT_EQ(read("scene_file: /scene.yaml").scene_folder, "/");
}

struct Bad {
  std::string yaml;
  std::vector<std::string> parts;  ///< of the message: key, value, what is allowed, unit
};

void PrintTo(const Bad& bad, std::ostream* out) { *out << bad.yaml; }

class BadNodeOptions : public testing::TestWithParam<Bad> {};

TEST_P(BadNodeOptions, AreRefusedInOneLineWithKeyValueAndWhatIsAllowed) {
  const std::string message = refusal([] { read(GetParam().yaml); });
  EXPECT_TRUE(contains(message, GetParam().parts));
  EXPECT_EQ(message.find('\n'), std::string::npos) << message;
}

// clang-format off
INSTANTIATE_TEST_SUITE_P(Table, BadNodeOptions, testing::Values(
    Bad{"world_frame: 3", {"world_frame", "3", "string"}},
    Bad{"world_frame: ''", {"world_frame", "''", "non-empty"}},
    Bad{"world_frame: 'two words'", {"world_frame", "two words"}},
    Bad{"world_frame: /world", {"world_frame", "/world"}},
    Bad{"world_frame: [a]", {"world_frame", "['a']", "string"}},
    Bad{"scene_file: 1.5", {"scene_file", "1.5", "string"}},
    Bad{"publish_clock: 1", {"publish_clock", "1", "true or false"}},
    Bad{"publish_clock: 'yes please'", {"publish_clock", "yes please", "true or false"}},
    Bad{"publish_link_frames: [true]", {"publish_link_frames", "[true]", "true or false"}},
    Bad{"publish_every: 5", {"publish_every", "5", "map"}},
    Bad{"publish_every: {tf: -1}", {"publish_every.tf", "-1", "0 to 1000000", "[ticks]"}},
    Bad{"publish_every: {odom: 1000001}", {"publish_every.odom", "1000001", "0 to 1000000", "[ticks]"}},
    Bad{"publish_every: {states: 0.5}", {"publish_every.states", "0.5", "whole number", "[ticks]"}},
    Bad{"publish_every: {twist: true}", {"publish_every.twist", "true", "whole number"}},
    Bad{"publish_every: {effect_wrenches: '2'}", {"publish_every.effect_wrenches", "'2'", "whole number"}},
    Bad{"publish_every: {applied_wrench: .inf}", {"publish_every.applied_wrench", "inf", "whole number"}},
    Bad{"publish_every: {odometry: 2}", {"publish_every.odometry", "unknown key", "'odom'"}},
    Bad{"publish_every: {clock: 2}", {"publish_every.clock", "unknown key", "applied_wrench"}},
    Bad{"body_inputs: 0", {"body_inputs", "0", "true or false"}},
    Bad{"paused: 'true'", {"paused", "'true'", "true or false"}},
    Bad{"real_time_factor: -1", {"real_time_factor", "-1", "0 to 1000000", "times real time"}},
    Bad{"real_time_factor: .nan", {"real_time_factor", "nan", "a number", "times real time"}},
    Bad{"real_time_factor: .inf", {"real_time_factor", "inf", "a number", "times real time"}},
    Bad{"real_time_factor: 1.0e+7", {"real_time_factor", "10000000", "0 to 1000000"}},
    Bad{"real_time_factor: 1.0e-300", {"real_time_factor", "1e-300", "0", "1e-06", "times real time"}},
    Bad{"real_time_factor: '1'", {"real_time_factor", "'1'", "string"}},
    Bad{"real_time_factor: true", {"real_time_factor", "true", "a number"}},
    Bad{"real_time_factor: 1e3", {"real_time_factor", "'1e3'", "write 1.0e+3"}},
    Bad{"wrench_timeout_s: -0.1", {"wrench_timeout_s", "-0.1", "0 to", "[s]"}},
    Bad{"wrench_timeout_s: .inf", {"wrench_timeout_s", "inf", "[s]"}},
    Bad{"stale_after_s: -1", {"stale_after_s", "-1", "0 to", "[s]"}},
    Bad{"stale_after_s: .nan", {"stale_after_s", "nan", "[s]"}},
    Bad{"start_time_s: -1", {"start_time_s", "-1", "0.001", "[s]"}},
    Bad{"start_time_s: 4.3e+9", {"start_time_s", "4300000000", "4000000000", "[s]"}},
    Bad{"limits: 5", {"limits", "5", "map"}},
    Bad{"limits: [1, 2]", {"limits", "[1, 2]", "map"}},
    Bad{"limits: {force: 0}", {"limits.force", "0", "> 0", "[N]"}},
    Bad{"limits: {torque: -2}", {"limits.torque", "-2", "> 0", "[N m]"}},
    Bad{"limits: {linear_impulse: .nan}", {"limits.linear_impulse", "nan", "> 0", "[N s]"}},
    Bad{"limits: {angular_impulse: '1'}", {"limits.angular_impulse", "'1'", "> 0", "[N m s]"}},
    Bad{"limits: {speed: .inf}", {"limits.speed", "inf", "> 0", "[m/s]"}},
    Bad{"limits: {angular_speed: [1]}", {"limits.angular_speed", "[1]", "> 0", "[rad/s]"}},
    Bad{"limits: {force_n: 1}", {"limits.force_n", "unknown key", "'force'"}},
    Bad{"real_time_facter: 1", {"real_time_facter", "unknown key", "'real_time_factor'"}},
    Bad{"wrench_timeout: 1", {"wrench_timeout", "unknown key", "'wrench_timeout_s'"}},
    Bad{"Paused: true", {"Paused", "unknown key", "'paused'"}}));
// clang-format on

}  // namespace
}  // namespace rigid_body_sim

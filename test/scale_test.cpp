// A short and generous form of scripts/scale: what it costs to carry a thousand bodies, in processor
// time, which other programs on the machine do not change much.

#include "scale/run.hpp"

#include <gtest/gtest.h>
#include <ros/ros.h>

#include "scale/subscriber.hpp"

namespace rigid_body_sim::scale {
namespace {

std::string self;

Result measure(const Load& load) { return measure(load, PROGRAM_DIR "/rigid_body_sim_node", self); }

// Measured: 4 % of a core of a virtual EPYC. With one look at each topic of each body a tick, by its
// name, as roscpp's publishers do, it was 42 %.
TEST(Scale, AThousandBodiesOnTfAndInStatesTakeLessThanAFifthOfACore) {
  Load load;
  load.bodies = 1000;
  load.topics = {"tf", "states"};
  load.seconds = 5;
  const Result result = measure(load);
  EXPECT_LT(result.cpu, 0.2);
  EXPECT_GT(result.messages, 0.9 * result.expected);
  EXPECT_GT(result.real_time_factor, 0.95);
}

// Without topics of single bodies, which the master would have to register one by one.
TEST(Scale, FiveThousandBodiesAreThereWithinSeconds) {
  Load load;
  load.bodies = 5000;
  load.topics = {"states"};
  load.is_lean = true;
  load.seconds = 2;
  const Result result = measure(load);
  EXPECT_LT(result.start_s, 10);
  EXPECT_GT(result.real_time_factor, 0.95);
}

}  // namespace
}  // namespace rigid_body_sim::scale

int main(int argc, char** argv) {
  using namespace rigid_body_sim::scale;
  if (argc > 1 && std::string(argv[1]) == "--subscribe")
    return subscribe(std::vector<std::string>(argv + 2, argv + argc));
  testing::InitGoogleTest(&argc, argv);
  setenv("ROSCONSOLE_STDOUT_LINE_BUFFERED", "1", 1);  // the node's lines, as they come
  self = argv[0];
  ros::init(argc, argv, "scale_test");
  const ros::NodeHandle nh;
  return RUN_ALL_TESTS();
}

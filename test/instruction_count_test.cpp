// What an effect that is not there costs: nothing, to the instruction. Counted by callgrind, which
// counts the same again each time.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "generic.hpp"
#include "tools/child_process.hpp"

namespace rigid_body_sim {
namespace {

namespace fs = std::filesystem;

constexpr int kTicks = 100;

class InstructionCount : public testing::TestWithParam<std::string> {
 protected:
  void SetUp() override {
    if (!fs::exists("/usr/bin/valgrind")) GTEST_SKIP() << "no valgrind";
  }
  ~InstructionCount() override { fs::remove_all(folder_); }

  /// A scene with these effects, of a body that turns, a sphere and a point mass.
  std::string scene(const std::string& effects) {
    const std::string path = (folder_ / (std::to_string(++scenes_) + ".yaml")).string();
    std::ofstream(path)
        << "integrator: " << GetParam() << "\neffects: {" << effects << "}\n"
        << "bodies:\n"
           "  a: {mass: 2, inertia: [0.1, 0.2, 0.25], com: [0.1, 0, 0.2],"
           " angular_velocity: [1, 2, 3]}\n"
           "  b: {sphere: {radius: 0.1, density: 500}, angular_velocity: [3, 2, 1]}\n"
           "  c: {point_mass: 3, linear_velocity: [1, 2, 3]}\n";
    return path;
  }

  /// Of kTicks ticks.
  long count(const std::string& program, const std::string& scene) {
    const std::string path = (folder_ / "callgrind.out").string();
    ChildProcess valgrind({"/usr/bin/valgrind", "--tool=callgrind", "--toggle-collect=flyTicks",
                           "--callgrind-out-file=" + path, TEST_PROGRAM_DIR "/" + program, scene,
                           std::to_string(kTicks)});
    EXPECT_EQ(valgrind.exitCode(60), 0) << valgrind.said();
    std::ifstream file(path);
    const std::string key = "totals: ";
    for (std::string line; std::getline(file, line);)
      if (line.rfind(key, 0) == 0) return std::stol(line.substr(key.size()));
    ADD_FAILURE() << "no count in " << path;
    return -1;
  }

 private:
  static fs::path makeFolder() {
    std::string path = (fs::temp_directory_path() / "instruction_count.XXXXXX").string();
    return mkdtemp(path.data());
  }

  fs::path folder_ = makeFolder();
  int scenes_ = 0;
};

constexpr const char* kGravity = "gravity: {acceleration: [0.1, 0.2, -9.8]}";

/// Every other effect, with nothing but zeros.
constexpr const char* kZeros =
    ", damping: {linear: 0, angular: 0}, drag: {air_density: 1.2, drag_area: 0},"
    " central_gravity: {mu: 0}, magnetic_dipole: {field: [0, 0, 0], dipole: [1, 2, 3]},"
    " buoyancy: {fluid_density: 1, volume: 0, acceleration: [0, 0, -9.8]}, spring: [],"
    " rotating_frame: {angular_velocity: [0, 0, 0]}, added_mass: {linear: [0, 0, 0]}";
/// Another effect, that does something.
constexpr const char* kDamping = ", damping: {linear: 0.1, angular: 0.2}";

TEST_P(InstructionCount, OfAFlightIsTheSameWhetherOrNotTheBinaryHasOtherEffects) {
  const std::string gravity = scene(kGravity), free = scene("");
  const long alone = count("fly_gravity_alone", gravity);
  EXPECT_EQ(count("fly_all_effects", gravity), alone);
  EXPECT_EQ(count("fly_all_effects", free), count("fly_gravity_alone", free));
  EXPECT_GT(alone, count("fly_gravity_alone", free)) << "gravity itself is counted";
}

TEST_P(InstructionCount, OfBlocksOfZerosIsThatOfNoBlocks) {
  const long without = count("fly_all_effects", scene(kGravity));
  EXPECT_EQ(count("fly_all_effects", scene(std::string(kGravity) + kZeros)), without);
  EXPECT_GT(count("fly_all_effects", scene(std::string(kGravity) + kDamping)), without);
}

INSTANTIATE_TEST_SUITE_P(By, InstructionCount, testing::Values("semi_implicit", "exact", "rk4"),
                         [](const auto& info) { return info.param; });

}  // namespace
}  // namespace rigid_body_sim

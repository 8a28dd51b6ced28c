#include <fcntl.h>
#include <gtest/gtest.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "bad_urdf_cases.hpp"
#include "generic.hpp"
#include "rigid_body_sim/urdf.hpp"

namespace rigid_body_sim {
namespace {

/// Exit code of `inspect_urdf path`, -1 if it did not exit by itself.
int inspect(std::string path, const std::string& stderr_path) {
  char program[] = PROGRAM_DIR "/inspect_urdf";
  char* arguments[] = {program, &path[0], nullptr};
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_addopen(&files, STDERR_FILENO, stderr_path.c_str(),
                                   O_WRONLY | O_CREAT | O_TRUNC, 0600);
  pid_t child = 0;
  int status = 0;
  const bool is_run = posix_spawn(&child, program, &files, nullptr, arguments, environ) == 0 &&
                      waitpid(child, &status, 0) == child;
  posix_spawn_file_actions_destroy(&files);
  return is_run && WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

class BadUrdfs : public ::testing::Test {
 protected:
  void SetUp() override { ASSERT_NE(mkdtemp(directory_.data()), nullptr); }
  void TearDown() override {
    for (const std::string& path : {path_, stderr_path()}) std::remove(path.c_str());
    rmdir(directory_.c_str());
  }

  std::string stderr_path() const { return directory_ + "/stderr"; }

  void expectOneLine(const std::string& line, const BadUrdf& bad) {
    EXPECT_EQ(line.find('\n'), std::string::npos) << line;
    EXPECT_LT(line.size(), 700u) << line;
    for (const std::string& part : bad.told) EXPECT_NE(line.find(part), std::string::npos) << line;
  }

  void expectRefused(const BadUrdf& bad) {
    SCOPED_TRACE(bad.name);
    try {
      readUrdf(bad.text, "some.urdf");
      ADD_FAILURE() << "was read";
    } catch (const std::invalid_argument& error) {
      EXPECT_EQ(std::string(error.what()).rfind("some.urdf: ", 0), 0u) << error.what();
      expectOneLine(error.what(), bad);
    }
  }

  void expectProgramRefuses(const BadUrdf& bad) {
    SCOPED_TRACE(bad.name);
    path_ = directory_ + "/bad.urdf";
    std::ofstream(path_, std::ios::binary) << bad.text;
    EXPECT_EQ(inspect(path_, stderr_path()), 1);
    std::ifstream file(stderr_path());
    const std::string said{std::istreambuf_iterator<char>(file), {}};
    ASSERT_FALSE(said.empty());
    EXPECT_EQ(said.back(), '\n');
    EXPECT_EQ(said.rfind(path_ + ": ", 0), 0u) << said;
    expectOneLine(said.substr(0, said.size() - 1), bad);
  }

  void expectRefusedByAll(const std::vector<BadUrdf>& table) {
    for (const BadUrdf& bad : table) {
      expectRefused(bad);
      expectProgramRefuses(bad);
    }
  }

 private:
  std::string directory_ = (std::filesystem::temp_directory_path() / "bad_urdf_XXXXXX").string();
  std::string path_;
};

TEST_F(BadUrdfs, NumbersOtherThanPlainDecimalsAreRefused) { expectRefusedByAll(badNumbers()); }
TEST_F(BadUrdfs, ImpossibleInertialsAreRefused) { expectRefusedByAll(kImpossibleInertials); }
TEST_F(BadUrdfs, WhatIsNotOneTreeIsRefused) { expectRefusedByAll(kBrokenTrees); }
TEST_F(BadUrdfs, BrokenAndHostileTextsAreRefused) { expectRefusedByAll(kHostileTexts); }
TEST_F(BadUrdfs, BytesThatAreNotUtf8AreRefused) { expectRefusedByAll(badUtf8()); }

TEST_F(BadUrdfs, EveryTruncationOfAGoodOneIsRefused) {
  const std::string good = "<?xml version='1.0'?><!-- c -->" +
                           robot(link("base") + link("tip") + joint("j", "fixed", "base", "tip"));
  ASSERT_NO_THROW(readUrdf(good, "some.urdf"));
  for (std::size_t length = 0; length < good.size(); ++length)
    expectRefused({"first " + std::to_string(length) + " bytes", good.substr(0, length), {}});
}

TEST_F(BadUrdfs, FilesThatCannotBeReadAreNamed) {
  for (const char* path : {"/nonexistent/x.urdf", "/"}) {
    try {
      readUrdfFile(path);
      ADD_FAILURE() << path << " was read";
    } catch (const std::invalid_argument& error) {
      expectOneLine(error.what(), {path, "", {path, "cannot be read"}});
    }
    EXPECT_EQ(inspect(path, stderr_path()), 1);
  }
}

TEST_F(BadUrdfs, SourceWithNewlinesStaysOneLine) {
  try {
    readUrdf("", "a\nb");
    ADD_FAILURE() << "was read";
  } catch (const std::invalid_argument& error) {
    expectOneLine(error.what(), {"", "", {"a?b"}});
  }
}

// ---- The suggestion in the refusal of a tensor

/// A URDF of one link with these moments, turned, in all their digits.
std::string tensor(const Vector3d& moments, const Quaterniond& q) {
  const Matrix3d R = q.toRotationMatrix();
  const Matrix3d I = R * moments.asDiagonal() * R.transpose();
  std::ostringstream text;
  text.precision(17);
  text << "ixx='" << I(0, 0) << "' ixy='" << I(0, 1) << "' ixz='" << I(0, 2) << "' iyy='" << I(1, 1)
       << "' iyz='" << I(1, 2) << "' izz='" << I(2, 2) << "'";
  return inertia(text.str());
}

/// A URDF of one link with the tensor that `what` suggests; empty if it suggests none.
std::string suggested(const std::string& what) {
  if (what.find("nearest valid tensor") == std::string::npos) return {};
  std::istringstream words(what.substr(what.find("ixx=")));
  std::string attributes;
  for (std::string word; words >> word;) {
    const std::size_t equals = word.find('=');
    attributes += word.substr(0, equals + 1) + "'" + word.substr(equals + 1) + "' ";
  }
  return inertia(attributes);
}

TEST(SuggestedTensor, IsAcceptedWhenItIsTyped) {
  // Flat bodies all: the suggestion is on the edge, where digits too few fall off.
  Sampler sample(29);
  for (const double scale : {3.7e-6, 1.0, 4.1e5}) {
    for (const Vector3d& moments : {Vector3d(1, 1, 3), Vector3d(0.31, 1.7, 2.9),
                                    Vector3d(1e-5, 1, 1.1), Vector3d(2, 3, 11)}) {
      for (int i = 0; i < 20; ++i) {
        const std::string broken = tensor(scale * moments, sample.attitude());
        const std::string text = suggested(refusal([&] { readUrdf(broken, "some.urdf"); }));
        EXPECT_NO_THROW(readUrdf(text, "some.urdf")) << text;
      }
    }
  }
}

TEST(SuggestedTensor, IsNotGivenIfItsNineDigitsSpoilIt) {
  // The nearest has the moments (2e-10, 1, 1): nine digits leave the first of them either sign.
  const Vector3d moments(-1e-7, 1, 1 + 1e-7 + 4e-10);
  Sampler sample(31);
  int count = 0;
  for (int i = 0; i < 40; ++i) {
    const std::string broken = tensor(moments, sample.attitude());
    const std::string what = refusal([&] { readUrdf(broken, "some.urdf"); });
    EXPECT_TRUE(contains(what, {"must be positive"}));
    const std::string text = suggested(what);
    if (text.empty()) continue;
    ++count;
    EXPECT_NO_THROW(readUrdf(text, "some.urdf")) << what;
  }
  EXPECT_LT(count, 40);
}

}  // namespace
}  // namespace rigid_body_sim

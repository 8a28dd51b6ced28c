#include <fcntl.h>
#include <gtest/gtest.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <vector>

#include "bad_urdf_cases.hpp"
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
  void SetUp() override { ASSERT_NE(mkdtemp(directory_), nullptr); }
  void TearDown() override {
    for (const std::string& path : {path_, stderr_path()}) std::remove(path.c_str());
    rmdir(directory_);
  }

  std::string stderr_path() const { return std::string(directory_) + "/stderr"; }

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
    path_ = std::string(directory_) + "/bad.urdf";
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
  char directory_[32] = "/tmp/bad_urdf_XXXXXX";
  std::string path_;
};

TEST_F(BadUrdfs, NumbersOtherThanPlainDecimalsAreRefused) { expectRefusedByAll(badNumbers()); }
TEST_F(BadUrdfs, ImpossibleInertialsAreRefused) { expectRefusedByAll(kImpossibleInertials); }
TEST_F(BadUrdfs, WhatIsNotOneTreeIsRefused) { expectRefusedByAll(kBrokenTrees); }
TEST_F(BadUrdfs, BrokenAndHostileTextsAreRefused) { expectRefusedByAll(kHostileTexts); }

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

}  // namespace
}  // namespace rigid_body_sim

#pragma once

// A program that another one starts, and all that it says. Nothing here sleeps: the end of the
// output is the end of the program.

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <stdexcept>
#include <string>
#include <vector>

extern char** environ;

namespace rigid_body_sim {

class ChildProcess {
 public:
  using Clock = std::chrono::steady_clock;

  /// Starts `command`: the program's path and its arguments; in `folder`, or where this program is.
  explicit ChildProcess(std::vector<std::string> command, const std::string& folder = "")
      : started_(Clock::now()) {
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0) throw std::runtime_error("no pipe");
    output_ = ends[0];
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, ends[1], STDOUT_FILENO);
    posix_spawn_file_actions_adddup2(&actions, ends[1], STDERR_FILENO);
    if (!folder.empty()) posix_spawn_file_actions_addchdir_np(&actions, folder.c_str());
    std::vector<char*> arguments;
    for (std::string& word : command) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    const int error =
        posix_spawn(&pid_, arguments[0], &actions, nullptr, arguments.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    close(ends[1]);
    if (error != 0) throw std::runtime_error("cannot start " + command[0]);
  }
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;
  ~ChildProcess() {
    if (pid_ != 0) {
      signal(SIGKILL);
      waitpid(pid_, nullptr, 0);
    }
    if (output_ >= 0) close(output_);
  }

  void signal(int number) const { kill(pid_, number); }
  pid_t pid() const { return pid_; }

  /// Whether exitCode() did not wait for its end.
  bool isGivenUp() const { return is_given_up_; }

  double secondsSinceStart() const {
    return std::chrono::duration<double>(Clock::now() - started_).count();
  }

  /// Waits until it has said `text`; false if it ends or `timeout_s` passes before.
  bool says(const std::string& text, double timeout_s = 10) {
    const auto end = deadline(timeout_s);
    while (said_.find(text) == std::string::npos)
      if (!readSome(end)) return false;
    return true;
  }

  /// Waits for more that it says; false as says().
  bool saysMore(double timeout_s = 10) { return readSome(deadline(timeout_s)); }

  /// From now on nobody reads what it says.
  void closeOutput() {
    close(output_);
    output_ = -1;
  }

  /// All that it has said.
  const std::string& said() const { return said_; }

  /// Waits for its end. Its exit code, or minus the signal that killed it: that is -SIGKILL if it
  /// had to be, after `timeout_s`.
  int exitCode(double timeout_s = 10) {
    const auto end = deadline(timeout_s);
    while (readSome(end)) continue;
    is_given_up_ = !is_over_;
    if (is_given_up_) signal(SIGKILL);
    int status = 0;
    waitpid(pid_, &status, 0);
    pid_ = 0;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
  }

 private:
  static Clock::time_point deadline(double timeout_s) {
    return Clock::now() + std::chrono::milliseconds(static_cast<int>(1000 * timeout_s));
  }

  /// Waits for output; false at the program's end or after `end`.
  bool readSome(Clock::time_point end) {
    using std::chrono::milliseconds;
    const auto left = std::chrono::duration_cast<milliseconds>(end - Clock::now()).count();
    pollfd wanted = {output_, POLLIN, 0};
    if (left <= 0 || poll(&wanted, 1, static_cast<int>(left)) <= 0) return false;
    char text[4096];
    const ssize_t count = read(output_, text, sizeof(text));
    is_over_ = count <= 0;
    if (!is_over_) said_.append(text, static_cast<std::size_t>(count));
    return !is_over_;
  }

  Clock::time_point started_;
  pid_t pid_ = 0;
  int output_ = -1;
  bool is_over_ = false;
  bool is_given_up_ = false;
  std::string said_;
};

}  // namespace rigid_body_sim

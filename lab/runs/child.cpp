#include "lab/runs/child.hpp"

#include <fcntl.h>
#include <fmt/core.h>
#include <poll.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <system_error>

namespace voxdag::lab {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

double seconds_of(const timeval& time) {
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

[[noreturn]] void fail(const std::string& program) {
  throw Error(program, "", std::system_category().message(errno));
}

/// An open file descriptor.
class Descriptor {
 public:
  Descriptor(int number, const std::string& program) : number_(number) {
    if (number < 0) fail(program);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() { close(number_); }
  int get() const { return number_; }

 private:
  int number_;
};

/// Runs in the child and never returns. Calls only functions that are safe between fork and exec.
[[noreturn]] void become(char* const* arguments, const char* directory, int out, int err) {
  setpgid(0, 0);
  prctl(PR_SET_PDEATHSIG, SIGTERM);  // ends the child if the benchmark is killed
  for (const int number : {SIGINT, SIGTERM, SIGHUP, SIGPIPE, SIGXFSZ}) signal(number, SIG_DFL);
  const int empty = open("/dev/null", O_RDONLY);
  dup2(empty, STDIN_FILENO);
  dup2(out, STDOUT_FILENO);
  dup2(err, STDERR_FILENO);
  if (chdir(directory) == 0) execvp(arguments[0], arguments);
  const char* const reason = strerrordesc_np(errno);
  if (write(STDERR_FILENO, reason, std::strlen(reason)) < 0) _exit(126);
  _exit(127);
}

std::string contents(int file) {
  std::string text;
  std::array<char, 1 << 16> part;
  for (ssize_t count, at = 0; (count = pread(file, part.data(), part.size(), at)) > 0; at += count)
    text.append(part.data(), static_cast<std::size_t>(count));
  return text;
}

/// Waits until the child ends. At the time limit or on cancellation, ends the child and its
/// children: first with SIGTERM, then with SIGKILL.
bool wait_for_end(pid_t child, const Descriptor& handle, Clock::time_point start, double limit,
                  const Progress& progress) {
  constexpr int kPollMilliseconds = 100;
  constexpr double kSecondsToTidyUp = 5;
  bool stopping = false;
  Clock::time_point stopped{};
  for (;;) {
    pollfd ended{handle.get(), POLLIN, 0};
    if (poll(&ended, 1, kPollMilliseconds) > 0) return stopping;
    const bool late = limit > 0 && seconds_since(start) > limit;
    if (!stopping && (late || progress.cancelled())) {
      stopping = true;
      stopped = Clock::now();
      kill(-child, SIGTERM);
    } else if (stopping && seconds_since(stopped) > kSecondsToTidyUp) {
      kill(-child, SIGKILL);
    }
  }
}

std::string first_line(const std::string& text) { return text.substr(0, text.find('\n')); }

}  // namespace

ChildResult run_child(const std::vector<std::string>& command,
                      const std::filesystem::path& directory, double seconds_limit,
                      const Progress& progress) {
  const Descriptor out(memfd_create("out", MFD_CLOEXEC), command[0]);
  const Descriptor err(memfd_create("err", MFD_CLOEXEC), command[0]);
  std::vector<char*> arguments;
  arguments.reserve(command.size() + 1);
  for (const std::string& argument : command)
    arguments.push_back(const_cast<char*>(argument.c_str()));
  arguments.push_back(nullptr);

  const Clock::time_point start = Clock::now();
  const pid_t child = fork();
  if (child < 0) fail(command[0]);
  if (child == 0) become(arguments.data(), directory.c_str(), out.get(), err.get());
  setpgid(child, child);  // both parent and child call it, because either may run first
  const Descriptor handle(static_cast<int>(syscall(SYS_pidfd_open, child, 0)), command[0]);

  ChildResult result;
  result.timed_out = wait_for_end(child, handle, start, seconds_limit, progress);
  result.cost.wall_seconds = seconds_since(start);
  int status = 0;
  struct rusage usage {};
  while (wait4(child, &status, 0, &usage) < 0)
    if (errno != EINTR) fail(command[0]);
  kill(-child, SIGKILL);  // ends processes that the child left running
  progress.throw_if_cancelled();
  result.status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  result.cost.user_seconds = seconds_of(usage.ru_utime);
  result.cost.system_seconds = seconds_of(usage.ru_stime);
  result.cost.peak_bytes = static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
  result.out = contents(out.get());
  result.err = contents(err.get());
  return result;
}

std::string failure_of(const ChildResult& result, double seconds_limit) {
  if (result.timed_out) return fmt::format("stopped at the time limit of {} s", seconds_limit);
  if (result.status == 0) return "";
  const std::string line = first_line(result.err);
  if (!line.empty()) return line.starts_with("voxdag: ") ? line.substr(8) : line;
  return result.status > 128 ? fmt::format("killed by signal {}", result.status - 128)
                             : fmt::format("exit status {}", result.status);
}

}  // namespace voxdag::lab

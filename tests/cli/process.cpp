#include "process.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <stdexcept>
#include <thread>
#include <utility>

#include "support/temp_dir.hpp"

namespace voxdag::cli {
namespace {

int nameless_file() {
  const int descriptor = open("/tmp", O_RDWR | O_TMPFILE | O_CLOEXEC, 0600);
  if (descriptor < 0) throw std::runtime_error("cannot make a temporary file");
  return descriptor;
}

/// Returns the text of the file, and leaves the offset where the program writes.
std::string text_of(int descriptor) {
  struct stat status {};
  if (fstat(descriptor, &status) != 0) throw std::runtime_error("cannot read a temporary file");
  std::string text(static_cast<std::size_t>(status.st_size), '\0');
  if (pread(descriptor, text.data(), text.size(), 0) != static_cast<ssize_t>(text.size()))
    throw std::runtime_error("cannot read a temporary file");
  return text;
}

std::string read_and_close(int& descriptor) {
  std::string text = text_of(descriptor);
  close(std::exchange(descriptor, -1));
  return text;
}

}  // namespace

Process::Process(const std::vector<std::string>& command, const std::string& stdout_path) {
  out_ = stdout_path.empty() ? nameless_file() : open(stdout_path.c_str(), O_RDWR | O_CLOEXEC);
  err_ = nameless_file();
  std::vector<char*> arguments;
  for (const std::string& argument : command)
    arguments.push_back(const_cast<char*>(argument.c_str()));
  arguments.push_back(nullptr);
  pid_ = fork();
  if (pid_ < 0) throw std::runtime_error("cannot fork");
  if (pid_ > 0) return;
  prctl(PR_SET_PDEATHSIG, SIGKILL);  // ends the program if the test is killed
  const int in = open("/dev/null", O_RDONLY);
  if (dup2(in, 0) < 0 || dup2(out_, 1) < 0 || dup2(err_, 2) < 0) _exit(126);
  execvp(arguments[0], arguments.data());
  _exit(127);
}

Process::~Process() {
  if (pid_ > 0) {
    kill(pid_, SIGKILL);
    waitpid(pid_, nullptr, 0);
  }
  if (out_ >= 0) close(out_);
  if (err_ >= 0) close(err_);
}

void Process::send_signal(int number) const { kill(pid_, number); }

void Process::wait_until_it_catches(int number) const {
  const std::string status = "/proc/" + std::to_string(pid_) + "/status";
  const std::string key = "SigCgt:\t";
  for (;; std::this_thread::sleep_for(std::chrono::milliseconds(5))) {
    const std::string text = read_text(status);
    const std::size_t at = text.find(key);
    if (at == std::string::npos || text.find("(zombie)") != std::string::npos) return;
    const unsigned long long mask = std::stoull(text.substr(at + key.size(), 16), nullptr, 16);
    if ((mask >> (number - 1) & 1) != 0) return;
  }
}

bool Process::wait_until_it_writes(const std::filesystem::path& folder) const {
  namespace fs = std::filesystem;
  const fs::path descriptors = "/proc/" + std::to_string(pid_) + "/fd";
  const auto is_written = [&](const fs::path& descriptor) {
    std::error_code closed;
    const fs::perms mode = fs::symlink_status(descriptor, closed).permissions();
    return (mode & fs::perms::owner_write) != fs::perms::none &&
           fs::read_symlink(descriptor, closed).parent_path() == folder &&
           fs::file_size(descriptor, closed) > 0 && !closed;
  };
  for (;; std::this_thread::sleep_for(std::chrono::milliseconds(5))) {
    std::error_code ended;
    fs::directory_iterator all(descriptors, ended);
    if (ended || all == fs::directory_iterator()) return false;
    for (; all != fs::directory_iterator(); all.increment(ended))
      if (is_written(all->path())) return true;
  }
}

bool Process::has_ended() const {
  siginfo_t state{};
  waitid(P_PID, static_cast<id_t>(pid_), &state, WEXITED | WNOHANG | WNOWAIT);
  return state.si_pid != 0;
}

bool Process::wait_until(const std::function<bool()>& is_so) const {
  for (;; std::this_thread::sleep_for(std::chrono::milliseconds(5))) {
    const bool is_last = has_ended();
    if (is_so()) return true;
    if (is_last) return false;
  }
}

bool Process::wait_until_it_warns(const std::string& text) const {
  for (;; std::this_thread::sleep_for(std::chrono::milliseconds(5))) {
    const bool is_last = has_ended();
    if (text_of(err_).find(text) != std::string::npos) return true;
    if (is_last) return false;
  }
}

std::string Process::wait_for_line() const {
  for (;; std::this_thread::sleep_for(std::chrono::milliseconds(5))) {
    const bool is_last = has_ended();
    const std::string text = text_of(out_);
    const std::size_t end = text.find('\n');
    if (end != std::string::npos || is_last) return text.substr(0, end);
  }
}

void Process::wait_until_it_maps(const std::filesystem::path& file) const {
  const std::string name = std::filesystem::canonical(file);
  for (;; std::this_thread::sleep_for(std::chrono::milliseconds(5))) {
    // The list of maps can be empty although the program runs: while exec() replaces the process.
    const bool is_last = has_ended();
    const std::string maps = read_text("/proc/" + std::to_string(pid_) + "/maps");
    if (is_last || maps.find(name) != std::string::npos) return;
  }
}

ProcessResult Process::wait() {
  int status = 0;
  waitpid(std::exchange(pid_, -1), &status, 0);
  ProcessResult result;
  result.status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  struct Stream {
    int& descriptor;
    std::string& text;
  };
  for (const Stream& stream : {Stream{out_, result.out}, Stream{err_, result.err}})
    stream.text = read_and_close(stream.descriptor);
  return result;
}

std::vector<std::string> voxdag_command(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), VOXDAG_PROGRAM);
  return arguments;
}

ProcessResult run_voxdag(std::vector<std::string> arguments, const std::string& stdout_path) {
  return Process(voxdag_command(std::move(arguments)), stdout_path).wait();
}

bool has_lab() { return VOXDAG_HAS_LAB; }

void expect_failure(const ProcessResult& result, int status, const std::string& text) {
  EXPECT_EQ(result.status, status);
  EXPECT_EQ(result.out, "");
  EXPECT_EQ(result.err.rfind("voxdag: ", 0), 0u) << result.err;
  EXPECT_NE(result.err.find(text), std::string::npos) << result.err;
  EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
  EXPECT_TRUE(result.err.ends_with('\n'));
}

bool lacks_matplotlib(const ProcessResult& result) {
  return result.status == 1 &&
         result.err.find("matplotlib draws the plots, and it is not installed") !=
             std::string::npos;
}

}  // namespace voxdag::cli

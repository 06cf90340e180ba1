#include "lab/runs/scratch_folder.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <string>
#include <system_error>
#include <utility>

#include "voxdag/core/error.hpp"

namespace voxdag::lab {
namespace {

/// Creates the folder, prints its name, waits for the end of standard input, and removes the
/// folder. It ignores SIGPIPE, so that it goes on if nobody reads the name.
constexpr const char* kKeeper =
    R"(trap '' PIPE; d=$(mktemp -d -- "$1") || exit 1; echo "$d"; read -r _; rm -rf -- "$d")";

[[noreturn]] void fail(const std::string& what, int error) {
  throw Error(what, "", "cannot create the folder: " + std::system_category().message(error));
}

/// The two ends of a pipe, closed where they are still open.
struct Pipe {
  int read_end = -1, write_end = -1;

  Pipe() {
    int ends[2];
    if (::pipe2(ends, O_CLOEXEC) != 0) fail("pipe", errno);
    read_end = ends[0], write_end = ends[1];
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;
  ~Pipe() {
    for (const int end : {read_end, write_end})
      if (end >= 0) ::close(end);
  }
};

std::string read_line(int file) {
  std::string line;
  std::array<char, 256> part;
  for (ssize_t count; (count = ::read(file, part.data(), part.size())) != 0;) {
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) break;
    line.append(part.data(), static_cast<std::size_t>(count));
    if (line.back() == '\n') break;
  }
  if (!line.empty() && line.back() == '\n') line.pop_back();
  return line;
}

}  // namespace

ScratchFolder::ScratchFolder(const std::filesystem::path& parent) {
  const std::string pattern = parent / "voxdag-bench-XXXXXX";
  Pipe input, output;
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, input.read_end, STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&actions, output.write_end, STDOUT_FILENO);
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSID);  // Ctrl-C does not end it.
  const char* const arguments[] = {"sh", "-c", kKeeper, "sh", pattern.c_str(), nullptr};
  const int error = ::posix_spawn(&keeper_, "/bin/sh", &actions, &attributes,
                                  const_cast<char* const*>(arguments), environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0) fail("/bin/sh", error);
  ::close(std::exchange(output.write_end, -1));
  path_ = read_line(output.read_end);
  keeper_input_ = std::exchange(input.write_end, -1);
  if (!path_.empty()) return;
  end_keeper();
  throw Error(pattern, "", "cannot create the folder");
}

ScratchFolder::~ScratchFolder() { end_keeper(); }

void ScratchFolder::end_keeper() {
  ::close(keeper_input_);
  while (::waitpid(keeper_, nullptr, 0) < 0 && errno == EINTR) {
  }
}

}  // namespace voxdag::lab

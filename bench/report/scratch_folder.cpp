#include "bench/report/scratch_folder.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <string>
#include <system_error>

#include "voxdag/core/error.hpp"

namespace voxdag {
namespace {

/// Starts a shell that waits for the end of its standard input and then removes `folder`. It is in
/// a session of its own, so that Ctrl-C does not end it. Returns its process and the end of the
/// pipe to its standard input, or an error number.
int start_remover(const std::string& folder, pid_t& remover, int& input) {
  int pipe[2];
  if (::pipe2(pipe, O_CLOEXEC) != 0) return errno;
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, pipe[0], STDIN_FILENO);
  // A reader of voxdag's output must not wait for this shell.
  for (const int number : {STDOUT_FILENO, STDERR_FILENO})
    posix_spawn_file_actions_addopen(&actions, number, "/dev/null", O_WRONLY, 0);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSID);
  const char* const arguments[] = {"sh", "-c",           "read -r _; rm -rf -- \"$1\"",
                                   "sh", folder.c_str(), nullptr};
  const int error = ::posix_spawn(&remover, "/bin/sh", &actions, &attributes,
                                  const_cast<char* const*>(arguments), environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
  ::close(pipe[0]);
  if (error != 0)
    ::close(pipe[1]);
  else
    input = pipe[1];
  return error;
}

}  // namespace

ScratchFolder::ScratchFolder() {
  std::string pattern = std::filesystem::temp_directory_path() / "voxdag-bench-XXXXXX";
  if (::mkdtemp(pattern.data()) == nullptr) throw Error(pattern, "", "cannot create the folder");
  path_ = pattern;
  if (const int error = start_remover(pattern, remover_, remover_input_); error != 0) {
    ::rmdir(pattern.c_str());
    throw Error("/bin/sh", "", std::system_category().message(error));
  }
}

ScratchFolder::~ScratchFolder() {
  ::close(remover_input_);
  while (::waitpid(remover_, nullptr, 0) < 0 && errno == EINTR) {
  }
}

}  // namespace voxdag

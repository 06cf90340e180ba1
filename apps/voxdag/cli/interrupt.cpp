#include "cli/interrupt.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <csignal>

#include "voxdag/core/io/unfinished_files.hpp"

namespace voxdag::cli {
namespace {

Progress* progress_to_cancel = nullptr;
volatile std::sig_atomic_t caught_signal = 0;

extern "C" void on_signal(int number) {
  if (caught_signal != 0) {
    remove_unfinished_files();
    std::signal(number, SIG_DFL);
    raise(number);  // Takes effect when this handler returns.
    return;
  }
  caught_signal = number;
  progress_to_cancel->cancel();
}

/// Handles SIGBUS: a page of a mapped file cannot be read, because another program truncated the
/// file or the disk failed.
extern "C" void on_bus_error(int) {
  static std::atomic_flag is_reported;
  while (is_reported.test_and_set()) pause();  // another thread, and the end is near
  static constexpr char kText[] =
      "voxdag: cannot read a mapped file any more: another program may have truncated it\n";
  remove_unfinished_files();
  if (write(STDERR_FILENO, kText, sizeof kText - 1) < 0) _exit(1);
  _exit(1);
}

}  // namespace

void make_writes_return_errors() {
  for (const int number : {SIGPIPE, SIGXFSZ}) std::signal(number, SIG_IGN);
  // /dev/null is opened read-only, so that writes to it fail. open() returns the lowest free
  // descriptor, so it returns `stream`.
  for (int stream = 0; stream <= 2; ++stream)
    if (fcntl(stream, F_GETFD) < 0 && errno == EBADF && open("/dev/null", O_RDONLY) != stream)
      return;
}

void cancel_on_signals(Progress& progress) {
  progress_to_cancel = &progress;
  struct sigaction action {};
  action.sa_handler = on_signal;
  // SA_RESTART is not set: with it, opening a pipe that nobody reads would never return. Blocked
  // reads and writes of pipes continue after the first signal; a second signal ends the program.
  action.sa_flags = 0;
  std::signal(SIGBUS, on_bus_error);
  for (const int number : {SIGINT, SIGTERM, SIGHUP}) {
    struct sigaction before {};
    // Signals that the caller ignores (nohup) stay ignored.
    if (sigaction(number, nullptr, &before) == 0 && before.sa_handler != SIG_IGN)
      sigaction(number, &action, nullptr);
  }
}

int cancelling_signal() { return caught_signal; }

}  // namespace voxdag::cli

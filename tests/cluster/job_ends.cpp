/// Ends a job of several ranks early. mpirun_test.cmake runs it and checks the exit status.
#include <chrono>
#include <cstdio>
#include <memory>
#include <string_view>
#include <thread>

#include "voxdag/cluster/join_ranks.hpp"
#include "voxdag/core/error.hpp"

namespace voxdag {
namespace {

[[noreturn]] void compute_forever() {
  for (;;) std::this_thread::sleep_for(std::chrono::seconds(1));
}

/// Calls abort(status) with the status 41 for Cancelled, and 42 if later calls throw as well.
void end_cancelled(Ranks& ranks, Progress& progress) {
  std::jthread canceller([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    progress.cancel();
  });
  int status = 1;
  try {
    ranks.barrier();
  } catch (const Cancelled&) {
    status = 41;
  }
  try {
    ranks.next(0);
  } catch (const Error&) {
    ++status;
  }
  ranks.abort(status);
}

int run(std::string_view how) {
  Progress progress;
  const std::unique_ptr<Ranks> ranks = join_ranks(&progress);
  const bool is_last = ranks->rank() == ranks->count() - 1;
  if (how == "abort") {
    if (is_last) ranks->abort(7);
    if (ranks->rank() == 0) compute_forever();
    ranks->barrier();
  } else if (how == "cancel") {
    if (is_last) end_cancelled(*ranks, progress);
    compute_forever();
  } else if (how == "throw") {
    if (is_last) throw Error("the last rank fails");
    ranks->barrier();
  } else if (how == "twice") {
    join_ranks();
  }
  return 0;
}

}  // namespace
}  // namespace voxdag

int main(int argc, char** argv) {
  try {
    return voxdag::run(argc > 1 ? argv[1] : "");
  } catch (const voxdag::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 3;
  }
}

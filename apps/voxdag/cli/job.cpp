#include "cli/job.hpp"

#include <algorithm>
#include <chrono>
#include <thread>

#include "voxdag/cluster/join_ranks.hpp"
#include "voxdag/cluster/ranks_per_machine.hpp"

namespace voxdag::cli {
namespace {

/// Returns the share of this rank in the processors of its machine, unless the launcher has bound
/// it to fewer.
std::size_t threads_of_rank(int ranks_here) {
  const std::size_t processors = std::thread::hardware_concurrency();
  return thread_count(processors / static_cast<std::size_t>(ranks_here));
}

}  // namespace

Job::Job(Session& session) : progress_(session.progress), ranks_(join_ranks(&session.progress)) {
  if (count() == 1) return;
  if (!is_first()) {
    session.quiet = session.is_silent = true;
    session.bar.enable(false);
  }
  // Also with --threads, because all ranks must take part, and their options may differ.
  const int here = ranks_per_machine(*ranks_).here;
  if (session.threads == 0) threads_.emplace(threads_of_rank(here));
}

bool Job::fails_first() {
  if (count() == 1) return true;
  if (ranks_->fails_first()) return true;
  // A signal gives the first rank less time to print its line.
  constexpr int kSteps = 1000, kStepsAfterSignal = 20;
  for (int step = 0; step < (progress_.cancelled() ? kStepsAfterSignal : kSteps); ++step)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  return false;
}

void Job::end(int status) {
  if (count() > 1) ranks_->abort(status);
}

Job& join_job(Session& session) {
  session.job = std::make_shared<Job>(session);
  return *session.job;
}

}  // namespace voxdag::cli

#pragma once
/// The processes of a job that mpirun or srun started, for subcommands that share their work.
#include <memory>
#include <optional>

#include "cli/session.hpp"
#include "voxdag/cluster/ranks.hpp"
#include "voxdag/core/parallel/thread_count.hpp"

namespace voxdag::cli {

/// Joins the job when it is made; one process alone is a job of its own. Only rank 0 shows
/// progress, warnings and the summary. Without --threads, the ranks of a machine share its
/// processors.
class Job {
 public:
  /// Collective. Throws Error.
  explicit Job(Session& session);

  Ranks& ranks() { return *ranks_; }
  bool is_first() const { return ranks_->rank() == 0; }
  int count() const { return ranks_->count(); }

  /// Returns true on the first rank that fails: it reports the failure and ends the job. Another
  /// one waits to be ended, because it probably has the same failure; after ten seconds or a signal
  /// it gets false.
  bool fails_first();
  /// Ends all ranks with this exit status, if they are several.
  void end(int status);

 private:
  const Progress& progress_;
  std::unique_ptr<Ranks> ranks_;
  std::optional<ThreadLimit> threads_;
};

/// Joins the job of this process, which lives as long as the session. Call it once.
Job& join_job(Session& session);

}  // namespace voxdag::cli

#pragma once
/// Joins the job that a process was started for.
#include <cstdint>
#include <memory>

#include "voxdag/cluster/ranks.hpp"
#include "voxdag/core/parallel/work.hpp"

namespace voxdag {

struct RankOptions {
  /// Longest message, in bytes: 1 to 2³⁰. Ranks send more bytes in several messages.
  std::uint64_t message_bytes = std::uint64_t{64} << 20;
};

/// Joins the job of `mpirun` or `srun` if one of them started this process (their environment
/// variables say so). Otherwise returns one rank alone. Call it once per process. What `work`
/// refers to must outlive the result.
///
/// Programs do not link MPI. This function loads the module voxdag_mpi.so, which does. Throws Error
/// if the module or MPI's library is missing, if this process has joined before, or if the
/// module's MPI sees another number of ranks than the launcher started.
std::unique_ptr<Ranks> join_ranks(Work work = {}, const RankOptions& options = {});

}  // namespace voxdag

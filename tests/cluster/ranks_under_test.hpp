#pragma once
/// The ranks that all tests of this process share: MPI can begin only once in a process.
#include "voxdag/cluster/join_ranks.hpp"

namespace voxdag {

/// Messages longer than this are sent in parts.
inline constexpr std::uint64_t kMessageBytes = 1000;

/// Returns the ranks of the job: one alone, or those of mpirun.
Ranks& ranks();

}  // namespace voxdag

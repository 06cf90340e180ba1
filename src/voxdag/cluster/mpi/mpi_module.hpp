#pragma once
/// The interface of the module that connects ranks through MPI: the only part that links MPI.
#include "voxdag/cluster/join_ranks.hpp"
#include "voxdag/core/parallel/work.hpp"

namespace voxdag {

struct MpiModule {
  /// Joins the job of this process. The caller owns the result. Throws Error.
  Ranks* (*join)(Work work, const RankOptions& options);
};

/// The name of its file, and of the MpiModule in it.
inline constexpr const char* kMpiModuleFile = "voxdag_mpi.so";
inline constexpr const char* kMpiModuleName = "voxdag_mpi_module";

}  // namespace voxdag

#include "voxdag/cluster/mpi/mpi_module.hpp"

#include "voxdag/cluster/mpi/mpi_ranks.hpp"

namespace voxdag {
namespace {

Ranks* join_in_module(Work work, const RankOptions& options) { return new MpiRanks(work, options); }

}  // namespace
}  // namespace voxdag

// NOLINTNEXTLINE(readability-identifier-naming): kMpiModuleName
extern "C" const voxdag::MpiModule voxdag_mpi_module = {voxdag::join_in_module};

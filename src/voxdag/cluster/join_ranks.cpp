#include "voxdag/cluster/join_ranks.hpp"

#include <cassert>
#include <cstdlib>
#include <string>

#include "voxdag/cluster/mpi/mpi_module.hpp"
#include "voxdag/cluster/one_rank.hpp"
#include "voxdag/core/error.hpp"
#include "voxdag/core/io/load_module.hpp"

namespace voxdag {
namespace {

/// Returns the number in an environment variable; 0 if it is not set.
int number_in(const char* variable) {
  const char* const text = std::getenv(variable);  // NOLINT(concurrency-mt-unsafe)
  return text == nullptr ? 0 : std::atoi(text);    // NOLINT(cert-err34-c)
}

bool is_set(const char* variable) {
  return std::getenv(variable) != nullptr;  // NOLINT(concurrency-mt-unsafe)
}

/// Returns whether a launcher of MPI programs started this process.
bool is_launched() {
  for (const char* variable : {"OMPI_COMM_WORLD_SIZE", "PMIX_RANK", "PMI_RANK"})
    if (is_set(variable)) return true;
  return false;
}

/// Returns how many processes the launcher says that it started; 0 if it does not say. Under
/// mpirun, Slurm's variables count mpirun's own processes, so mpirun's come first.
int launched_count() {
  for (const char* variable : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "SLURM_STEP_NUM_TASKS"})
    if (is_set(variable)) return number_in(variable);
  return 0;
}

}  // namespace

std::unique_ptr<Ranks> join_ranks(Work work, const RankOptions& options) {
  assert(options.message_bytes >= 1 && options.message_bytes <= std::uint64_t{1} << 30);
  if (!is_launched()) {
    // srun without PMI, which is its default.
    if (number_in("SLURM_STEP_NUM_TASKS") > 1)
      throw Error("srun started " + std::to_string(number_in("SLURM_STEP_NUM_TASKS")) +
                  " processes that cannot find each other: use mpirun, or `srun --mpi=pmix`");
    return std::make_unique<OneRank>();
  }
  std::string reason;
  const auto* const module =
      static_cast<const MpiModule*>(load_module(kMpiModuleFile, kMpiModuleName, reason));
  if (module == nullptr)
    throw Error(
        "mpirun or srun started this process, but the module for MPI cannot be loaded. Build "
        "voxdag where MPI is installed (Debian: libopenmpi-dev): " +
        reason);
  std::unique_ptr<Ranks> ranks(module->join(work, options));
  const int launched = launched_count();
  if (launched != 0 && ranks->count() != launched)
    throw Error("the launcher started " + std::to_string(launched) +
                " processes, but MPI sees a job of " + std::to_string(ranks->count()) +
                ". Use the mpirun of the MPI that voxdag was built with, or `srun --mpi=pmix`");
  return ranks;
}

}  // namespace voxdag

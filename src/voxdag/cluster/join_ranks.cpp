#include "voxdag/cluster/join_ranks.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cassert>
#include <cerrno>
#include <cstdlib>
#include <string>
#include <system_error>

#include "voxdag/cluster/mpi/mpi_module.hpp"
#include "voxdag/core/error.hpp"
#include "voxdag/core/io/descriptor.hpp"
#include "voxdag/core/io/load_module.hpp"

namespace voxdag {
namespace {

class LocalFile final : public RankFile {
 public:
  explicit LocalFile(const std::filesystem::path& path)
      : path_(path), descriptor_(::open(path.c_str(), O_WRONLY | O_CLOEXEC)) {
    if (!descriptor_.is_open()) fail(0, "cannot open: ");
  }

  void write_at(std::uint64_t offset, std::span<const std::byte> bytes) override {
    while (!bytes.empty()) {
      const ssize_t written =
          ::pwrite(descriptor_.get(), bytes.data(), bytes.size(), static_cast<off_t>(offset));
      if (written < 0 && errno == EINTR) continue;
      if (written < 0) fail(offset, "cannot write: ");
      bytes = bytes.subspan(static_cast<std::size_t>(written));
      offset += static_cast<std::uint64_t>(written);
    }
  }

  void close() override {
    // Some file systems (NFS, quotas) report a failed write only here.
    if (::close(descriptor_.release()) != 0) fail(0, "cannot write: ");
  }

 private:
  [[noreturn]] void fail(std::uint64_t offset, const char* what) const {
    throw Error(path_.string(), ErrorPlace::byte(offset),
                what + std::system_category().message(errno));
  }

  std::filesystem::path path_;
  Descriptor descriptor_;
};

/// A job of one process.
class OneRank final : public Ranks {
 public:
  int rank() const override { return 0; }
  int count() const override { return 1; }
  void barrier() override {}
  std::vector<std::uint64_t> all_gather(std::span<const std::uint64_t> values) override {
    return {values.begin(), values.end()};
  }
  void broadcast(std::vector<std::byte>&) override {}
  std::vector<std::vector<std::byte>> exchange(
      std::vector<std::vector<std::byte>> outgoing) override {
    return outgoing;
  }
  std::uint64_t next(int counter) override { return counters_[counter]++; }
  void reset(int counter) override { counters_[counter] = 0; }
  std::unique_ptr<RankFile> open_file(const std::filesystem::path& path) override {
    return std::make_unique<LocalFile>(path);
  }
  bool fails_first() override { return true; }
  [[noreturn]] void abort(int status) override { ::_exit(status); }
  std::uint64_t bytes_sent() const override { return 0; }

 private:
  std::array<std::atomic<std::uint64_t>, kCounters> counters_{};
};

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

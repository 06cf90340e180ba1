#pragma once
/// Ranks that MPI connects.
#include <atomic>

#include "voxdag/cluster/join_ranks.hpp"
#include "voxdag/cluster/mpi/mpi_counters.hpp"
#include "voxdag/cluster/mpi/mpi_session.hpp"
#include "voxdag/cluster/ranks.hpp"
#include "voxdag/core/parallel/work.hpp"

namespace voxdag {

class MpiRanks final : public Ranks {
 public:
  MpiRanks(Work work, const RankOptions& options);
  ~MpiRanks() override;

  int rank() const override { return session_.rank(); }
  int count() const override { return session_.count(); }
  void barrier() override { session_.barrier(); }
  std::vector<std::uint64_t> all_gather(std::span<const std::uint64_t> values) override;
  void broadcast(std::vector<std::byte>& bytes) override;
  std::vector<std::vector<std::byte>> exchange(
      std::vector<std::vector<std::byte>> outgoing) override;
  std::uint64_t next(int counter) override;
  void reset(int counter) override;
  std::unique_ptr<RankFile> open_file(const std::filesystem::path& path) override;
  bool fails_first() override { return counters_.next_after_failure(kCounters).value_or(0) == 0; }
  [[noreturn]] void abort(int status) override { session_.abort(status); }
  std::uint64_t bytes_sent() const override { return bytes_sent_; }

 private:
  void broadcast_from_0(void* bytes, std::size_t count);
  std::vector<std::uint64_t> exchange_sizes(const std::vector<std::vector<std::byte>>& outgoing);

  std::size_t message_bytes_;
  int exceptions_;  ///< In flight when this was made.
  MpiSession session_;
  MpiCounters counters_;
  std::atomic<std::uint64_t> bytes_sent_{0};
};

}  // namespace voxdag

#pragma once
/// A job of one process.
#include <array>
#include <atomic>

#include "voxdag/cluster/ranks.hpp"

namespace voxdag {

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
  std::unique_ptr<RankFile> open_file(const std::filesystem::path& path) override;
  bool fails_first() override { return true; }
  [[noreturn]] void abort(int status) override;
  std::uint64_t bytes_sent() const override { return 0; }

 private:
  std::array<std::atomic<std::uint64_t>, kCounters> counters_{};
};

}  // namespace voxdag

#include "voxdag/cluster/rank_queue.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <string>

#include "voxdag/core/error.hpp"

namespace voxdag {
namespace {

/// Throws Error unless all ranks have this number of items.
void check_counts(Ranks& ranks, std::uint64_t count) {
  const std::vector<std::uint64_t> counts = ranks.all_gather({&count, 1});
  for (std::size_t rank = 1; rank < counts.size(); ++rank)
    if (counts[rank] != counts[0])
      throw Error("rank 0 has " + std::to_string(counts[0]) + " items of work to share, but rank " +
                  std::to_string(rank) + " has " + std::to_string(counts[rank]) +
                  ": do all ranks see the same files?");
}

template <class T>
void append(std::vector<std::byte>& bytes, const T& values) {
  const auto added = std::as_bytes(std::span(values));
  bytes.insert(bytes.end(), added.begin(), added.end());
}

}  // namespace

std::vector<std::byte> RankQueue::run(std::size_t count, std::size_t result_bytes,
                                      const Work& work) {
  check_counts(ranks_, count);
  ranks_.reset(counter_);
  std::vector<std::byte> mine;  // for each item its number and its result
  std::vector<std::byte> result(result_bytes);
  for (std::uint64_t item; (item = ranks_.next(counter_)) < count;) {
    result.assign(result_bytes, std::byte{0});
    work(item, result);
    append(mine, std::array{item});
    append(mine, result);
  }
  const std::vector<std::vector<std::byte>> all =
      ranks_.exchange(std::vector<std::vector<std::byte>>(ranks_.count(), mine));
  std::vector<std::byte> results(count * result_bytes);
  for (const std::vector<std::byte>& of_rank : all)
    for (const std::byte* at = of_rank.data(); at < of_rank.data() + of_rank.size();) {
      std::uint64_t item = 0;
      std::memcpy(&item, at, sizeof item);
      at += sizeof item;
      std::copy_n(at, result_bytes,
                  results.begin() + static_cast<std::ptrdiff_t>(item * result_bytes));
      at += result_bytes;
    }
  return results;
}

}  // namespace voxdag

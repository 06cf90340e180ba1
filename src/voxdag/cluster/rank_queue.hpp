#pragma once
/// Shares the items of a queue among ranks.
#include "voxdag/cluster/ranks.hpp"
#include "voxdag/core/parallel/work_queue.hpp"

namespace voxdag {

/// Each rank takes the next item from a shared counter, so that a fast rank takes more items.
class RankQueue final : public WorkQueue {
 public:
  /// `counter` is one of the ranks' counters; nobody else may use it meanwhile.
  RankQueue(Ranks& ranks, int counter) : ranks_(ranks), counter_(counter) {}

  /// Waits for all ranks before the first item and after the last one. Throws also what functions
  /// of Ranks throw, and Error if the ranks have different counts. Memory: three times the results.
  std::vector<std::byte> run(std::size_t count, std::size_t result_bytes,
                             const Work& work) override;

 private:
  Ranks& ranks_;
  int counter_;
};

}  // namespace voxdag

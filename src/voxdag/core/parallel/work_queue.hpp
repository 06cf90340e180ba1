#pragma once
/// Numbered items of long work that several processes share.
#include <cstddef>
#include <cstring>
#include <functional>
#include <span>
#include <type_traits>
#include <vector>

namespace voxdag {

/// Each process takes one item after the other, in ascending order, until none are left. The
/// functions are collective: every process calls them, in one order and with equal counts.
class WorkQueue {
 public:
  /// Works on an item and writes its result, whose bytes are 0 before.
  using Work = std::function<void(std::size_t item, std::span<std::byte> result)>;

  WorkQueue() = default;
  WorkQueue(const WorkQueue&) = delete;
  WorkQueue& operator=(const WorkQueue&) = delete;
  virtual ~WorkQueue() = default;

  /// Calls work() once for each item from 0 to count - 1, in one of the processes. Returns the
  /// results of all items in every process, `result_bytes` each. Throws what work() throws; then
  /// the other processes wait for this one.
  virtual std::vector<std::byte> run(std::size_t count, std::size_t result_bytes,
                                     const Work& work) = 0;
};

/// Returns the results of work(item), of type Result, for all items.
template <class Result, class Work>
std::vector<Result> results_of(WorkQueue& queue, std::size_t count, const Work& work) {
  static_assert(std::is_trivially_copyable_v<Result>);
  const std::vector<std::byte> bytes =
      queue.run(count, sizeof(Result), [&](std::size_t item, std::span<std::byte> result) {
        const Result value = work(item);
        std::memcpy(result.data(), &value, sizeof value);
      });
  std::vector<Result> results(count);
  if (count > 0) std::memcpy(results.data(), bytes.data(), bytes.size());
  return results;
}

}  // namespace voxdag

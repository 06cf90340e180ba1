#pragma once
/// Threads for loops where TBB does not exist: in browsers, and in builds with VOXDAG_TBB=OFF.
#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace voxdag {

/// Runs loops on the thread that asks and on workers that have nothing else to do. Loops may run
/// inside of loops, and several threads may run loops at once.
class ThreadPool {
 public:
  /// Works on the items [begin, end).
  using Chunk = std::function<void(std::size_t begin, std::size_t end)>;

  /// Returns the pool of the program. Its workers start with the first loop.
  static ThreadPool& instance();

  ThreadPool(const ThreadPool&) = delete;
  ThreadPool& operator=(const ThreadPool&) = delete;
  ~ThreadPool();

  /// Returns how many threads work on a loop at once, with the one that asks.
  std::size_t thread_count() const { return thread_count_.load(std::memory_order_relaxed); }
  /// Lets at most `count` threads, at least 1, work on loops from now on.
  void limit_threads(std::size_t count);

  /// Calls chunk() for parts of [0, count), which are disjoint and in any order and have at least
  /// `grain` items, but for the last one. If a call throws, no new part begins, and one of the
  /// exceptions leaves.
  void run(std::size_t count, std::size_t grain, const Chunk& chunk);

 private:
  struct Loop {
    std::size_t count, grain;
    const Chunk& chunk;
    std::atomic<std::size_t> next{0};
    std::size_t helpers = 0;  ///< Workers in it. Guarded by mutex_, as is `error`.
    std::exception_ptr error;
  };

  ThreadPool();
  void work();
  void take_chunks(Loop& loop);
  void start_workers();

  std::mutex mutex_;
  std::condition_variable loop_begins_, helper_leaves_;
  std::vector<Loop*> loops_;  ///< With items that nobody has taken yet.
  std::vector<std::thread> workers_;
  std::size_t helping_ = 0;  ///< Workers that work on some loop.
  std::atomic<std::size_t> thread_count_;
  bool can_start_ = true;  ///< More threads.
  bool ends_ = false;
};

/// Returns a number of the calling thread that no other thread of the program has.
std::size_t thread_number();

}  // namespace voxdag

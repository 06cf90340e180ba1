#pragma once
/// How many threads work on a loop.
#include <algorithm>
#include <cstddef>
#ifndef VOXDAG_OWN_THREADS
#include <tbb/global_control.h>
#include <tbb/task_arena.h>
#else
#include "voxdag/core/parallel/thread_pool.hpp"
#endif

namespace voxdag {

#ifndef VOXDAG_OWN_THREADS

/// Returns how many threads work on a loop of the calling thread at once, at least 1.
inline std::size_t thread_count() {
  return std::max<std::size_t>(
      1, std::min(static_cast<std::size_t>(tbb::this_task_arena::max_concurrency()),
                  tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism)));
}

/// While it lives, at most `count` threads work on loops, in all of the program.
class ThreadLimit {
 public:
  explicit ThreadLimit(std::size_t count)
      : control_(tbb::global_control::max_allowed_parallelism, count) {}

 private:
  tbb::global_control control_;
};

#else

inline std::size_t thread_count() { return ThreadPool::instance().thread_count(); }

class ThreadLimit {
 public:
  explicit ThreadLimit(std::size_t count) : before_(thread_count()) {
    ThreadPool::instance().limit_threads(count);
  }
  ThreadLimit(const ThreadLimit&) = delete;
  ThreadLimit& operator=(const ThreadLimit&) = delete;
  ~ThreadLimit() { ThreadPool::instance().limit_threads(before_); }

 private:
  std::size_t before_;
};

#endif

/// Returns how many threads can work on a loop of `items` items, at least 1.
inline std::size_t thread_count(std::size_t items) {
  return std::max<std::size_t>(1, std::min(thread_count(), items));
}

}  // namespace voxdag

#include "voxdag/core/parallel/thread_pool.hpp"

#include <algorithm>
#include <system_error>

namespace voxdag {

ThreadPool& ThreadPool::instance() {
  static ThreadPool pool;
  return pool;
}

ThreadPool::ThreadPool()
    : thread_count_(std::max<std::size_t>(1, std::thread::hardware_concurrency())) {}

ThreadPool::~ThreadPool() {
  {
    const std::lock_guard lock(mutex_);
    ends_ = true;
  }
  loop_begins_.notify_all();
  for (std::thread& worker : workers_) worker.join();
}

void ThreadPool::limit_threads(std::size_t count) {
  thread_count_.store(std::max<std::size_t>(1, count), std::memory_order_relaxed);
}

/// Called with mutex_ held. Where the system gives no more threads, those that there are do the
/// work.
void ThreadPool::start_workers() {
  try {
    while (can_start_ && workers_.size() + 1 < thread_count())
      workers_.emplace_back([this] { work(); });
  } catch (const std::system_error&) {
    can_start_ = false;
  }
}

void ThreadPool::run(std::size_t count, std::size_t grain, const Chunk& chunk) {
  if (count == 0) return;
  grain = std::max<std::size_t>(1, grain);
  if (count <= grain || thread_count() == 1) return chunk(0, count);
  Loop loop{.count = count, .grain = grain, .chunk = chunk, .error = nullptr};
  {
    const std::lock_guard lock(mutex_);
    start_workers();
    loops_.push_back(&loop);
  }
  loop_begins_.notify_all();
  take_chunks(loop);
  std::unique_lock lock(mutex_);
  std::erase(loops_, &loop);
  helper_leaves_.wait(lock, [&] { return loop.helpers == 0; });
  if (loop.error) std::rethrow_exception(loop.error);
}

/// Takes parts until none are left. They shrink, so that the threads end at about the same time.
void ThreadPool::take_chunks(Loop& loop) {
  const std::size_t share = 4 * thread_count();
  std::size_t begin = loop.next.load(std::memory_order_relaxed);
  while (begin < loop.count) {
    const std::size_t size = std::max(loop.grain, (loop.count - begin) / share);
    const std::size_t end = size < loop.count - begin ? begin + size : loop.count;
    if (!loop.next.compare_exchange_weak(begin, end, std::memory_order_relaxed)) continue;
    try {
      loop.chunk(begin, end);
    } catch (...) {
      loop.next.store(loop.count, std::memory_order_relaxed);
      const std::lock_guard lock(mutex_);
      if (!loop.error) loop.error = std::current_exception();
    }
    begin = loop.next.load(std::memory_order_relaxed);
  }
}

/// A worker helps the loop that began last: inner loops end first.
void ThreadPool::work() {
  std::unique_lock lock(mutex_);
  for (;;) {
    Loop* loop = nullptr;
    loop_begins_.wait(lock, [&] {
      if (ends_) return true;
      if (helping_ + 1 >= thread_count()) return false;
      while (!loops_.empty() &&
             loops_.back()->next.load(std::memory_order_relaxed) >= loops_.back()->count)
        loops_.pop_back();
      if (!loops_.empty()) loop = loops_.back();
      return loop != nullptr;
    });
    if (ends_) return;
    ++loop->helpers;
    ++helping_;
    lock.unlock();
    take_chunks(*loop);
    lock.lock();
    --helping_;
    if (--loop->helpers == 0) helper_leaves_.notify_all();
  }
}

std::size_t thread_number() {
  static std::atomic<std::size_t> next{0};
  thread_local const std::size_t number = next.fetch_add(1, std::memory_order_relaxed);
  return number;
}

}  // namespace voxdag

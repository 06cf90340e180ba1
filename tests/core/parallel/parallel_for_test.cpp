#include "voxdag/core/parallel/parallel_for.hpp"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <chrono>
#include <span>
#include <thread>
#include <vector>

#include "support/with_threads.hpp"

// The test of the order that ThreadSanitizer sees holds for TBB: the pool is built with it.
#ifndef VOXDAG_OWN_THREADS
#include <tbb/task_arena.h>
#endif

namespace voxdag {
namespace {

TEST(ParallelFor, CallsTheBodyOnceForEachItem) {
  for (const std::size_t count : {0, 1, 2, 1000}) {
    std::vector<std::atomic<int>> calls(count);
    parallel_for(count, [&](std::size_t i) { ++calls[i]; });
    for (std::size_t i = 0; i < count; ++i) EXPECT_EQ(calls[i], 1) << i;
  }
}

#ifndef VOXDAG_OWN_THREADS

void sleep_briefly() { std::this_thread::sleep_for(std::chrono::milliseconds(10)); }

/// Runs a loop of two items on two threads, if the machine has them. The caller's item ends first.
[[gnu::noinline]] void loop_on_two_threads() {
  const std::thread::id caller = std::this_thread::get_id();
  std::atomic<int> arrived{0};
  parallel_for(2, [&](std::size_t) {
    ++arrived;
    for (int wait = 0; wait < 100 && arrived < 2; ++wait) sleep_briefly();
    if (std::this_thread::get_id() != caller) sleep_briefly();
  });
}

std::atomic<bool> has_accessed_memory{false};

/// Makes many accesses on the other thread of the arena. The caller's thread then knows that they
/// are done, and no more: the order is relaxed.
void access_memory_on_other_thread() {
  tbb::this_task_arena::enqueue([] {
    std::vector<int> numbers(1 << 24);
    for (int& number : numbers) ++number;
    has_accessed_memory.store(true, std::memory_order_relaxed);
  });
  while (!has_accessed_memory.load(std::memory_order_relaxed)) sleep_briefly();
}

[[gnu::noinline]] void write(std::span<char> bytes) {
  for (char& byte : bytes) byte = 1;
}

[[gnu::noinline]] void write_stack() {
  std::array<char, 4096> bytes;
  write(bytes);
}

// TBB's tasks last read the stack of the loop's caller when the loop ends. ThreadSanitizer fails
// this test if it does not see that the caller may use the stack again. It no longer knows that the
// read was TBB's after many accesses, so that no suppression applies.
TEST(ParallelFor, ItsCallerOwnsItsStackAfterTheLoop) {
  with_threads(2, [] {
    loop_on_two_threads();
    access_memory_on_other_thread();
    write_stack();
  });
}

#endif

}  // namespace
}  // namespace voxdag

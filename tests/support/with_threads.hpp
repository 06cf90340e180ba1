#pragma once
/// Runs a part of a test on a given number of threads.
#include <cstddef>
#ifndef VOXDAG_OWN_THREADS
#include <tbb/task_arena.h>
#else
#include "voxdag/core/parallel/thread_count.hpp"
#endif

namespace voxdag {

/// Returns what body() returns, whose loops run on up to `threads` threads: also on more than the
/// machine has processors.
template <class Body>
decltype(auto) with_threads(std::size_t threads, const Body& body) {
#ifndef VOXDAG_OWN_THREADS
  return tbb::task_arena(static_cast<int>(threads)).execute(body);
#else
  const ThreadLimit limit(threads);
  return body();
#endif
}

}  // namespace voxdag

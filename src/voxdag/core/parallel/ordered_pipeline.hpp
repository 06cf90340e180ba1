#pragma once
/// Makes results in parallel and uses them in order.
#include <cstddef>
#include <optional>
#include <type_traits>
#include <vector>

#include "voxdag/core/parallel/work.hpp"

#ifndef VOXDAG_OWN_THREADS
#include <tbb/parallel_pipeline.h>

#include "voxdag/core/parallel/loop_order.hpp"
#else
#include <algorithm>
#include <condition_variable>
#include <mutex>

#include "voxdag/core/parallel/parallel_for.hpp"
#endif

namespace voxdag {

/// Calls use(make(i)) for every i in [0, count): `make` on many threads at the same time, `use` in
/// the order of i and never twice at the same time. At most `most_waiting` results exist at a time.
/// If `make` or `use` throws, the results that wait are destroyed and the exception leaves. Throws
/// Cancelled.
#ifndef VOXDAG_OWN_THREADS

// This function owns the results itself: tbb::parallel_pipeline leaks its tokens if a filter
// throws.
template <class Make, class Use>
void ordered_pipeline(std::size_t count, std::size_t most_waiting, Work work, const Make& make,
                      const Use& use) {
  using Result = std::invoke_result_t<const Make&, std::size_t>;
  std::vector<std::optional<Result>> results(most_waiting);
  LoopOrder order;
  OrderPoint taken, made;
  std::size_t next = 0;
  const auto take = [&](tbb::flow_control& flow) {
    const LoopOrder::Items items(order);
    const OrderPoint::Step step(taken);
    if (next == count || work.cancelled()) flow.stop();
    return next++;
  };
  // The results that wait are those of a range of at most most_waiting indices, because `use_one`
  // runs in order. So each has a slot of its own.
  const auto make_one = [&](std::size_t i) {
    const LoopOrder::Items items(order);
    results[i % most_waiting] = make(i);
    made.release();
    return i;
  };
  const auto use_one = [&](std::size_t i) {
    const LoopOrder::Items items(order);
    const OrderPoint::Step step(made);
    use(*results[i % most_waiting]);
    results[i % most_waiting].reset();
  };
  tbb::parallel_pipeline(
      most_waiting,
      tbb::make_filter<void, std::size_t>(tbb::filter_mode::serial_in_order, take) &
          tbb::make_filter<std::size_t, std::size_t>(tbb::filter_mode::parallel, make_one) &
          tbb::make_filter<std::size_t, void>(tbb::filter_mode::serial_in_order, use_one));
  work.poll();
}

#else

template <class Make, class Use>
void ordered_pipeline(std::size_t count, std::size_t most_waiting, Work work, const Make& make,
                      const Use& use) {
  using Result = std::invoke_result_t<const Make&, std::size_t>;
  std::vector<std::optional<Result>> results(most_waiting);
  std::mutex mutex;
  std::condition_variable changed;
  std::size_t next = 0, used = 0;
  bool is_using = false, stops = false;
  // The results that wait are those of [used, next), so each has a slot of its own.
  const auto run = [&] {
    std::unique_lock lock(mutex);
    for (;;) {
      changed.wait(lock, [&] { return stops || next == count || next < used + most_waiting; });
      if (stops || next == count || work.cancelled()) return;
      const std::size_t i = next++;
      lock.unlock();
      Result result = make(i);
      lock.lock();
      results[i % most_waiting] = std::move(result);
      // One thread uses the results; others add theirs meanwhile.
      while (!is_using && !stops && used < next && results[used % most_waiting]) {
        is_using = true;
        lock.unlock();
        use(*results[used % most_waiting]);
        lock.lock();
        results[used % most_waiting].reset();
        is_using = false;
        ++used;
        changed.notify_all();
      }
    }
  };
  parallel_for(std::min(most_waiting, count), [&](std::size_t) {
    try {
      run();
    } catch (...) {
      const std::lock_guard lock(mutex);
      stops = true;
      changed.notify_all();
      throw;
    }
  });
  work.poll();
}

#endif

}  // namespace voxdag

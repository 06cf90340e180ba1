#pragma once
/// Makes results in parallel and uses them in order.
#include <tbb/parallel_pipeline.h>

#include <cstddef>
#include <optional>
#include <type_traits>
#include <vector>

#include "voxdag/core/parallel/loop_order.hpp"
#include "voxdag/core/parallel/work.hpp"

namespace voxdag {

/// Calls use(make(i)) for every i in [0, count): `make` on many threads at the same time, `use` in
/// the order of i and never twice at the same time. At most `most_waiting` results exist at a time.
/// If `make` or `use` throws, the results that wait are destroyed and the exception leaves. Throws
/// Cancelled.
///
/// This function owns the results itself: tbb::parallel_pipeline leaks its tokens if a filter
/// throws.
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

}  // namespace voxdag

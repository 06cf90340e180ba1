#pragma once
/// A parallel std::nth_element, in a header of its own because <execution> compiles slowly.
#include <algorithm>
#include <execution>

namespace voxdag {

/// Does what std::nth_element() does, on the threads of the current TBB arena.
template <class Iterator>
void parallel_nth_element(Iterator begin, Iterator nth, Iterator end) {
  std::nth_element(std::execution::par, begin, nth, end);
}

}  // namespace voxdag

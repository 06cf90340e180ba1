#pragma once
/// Functions that cast a set of rays, for voxdag or a rival, and whose time is measured.
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>

namespace voxdag::lab {

struct TraceRunner {
  std::string name;
  /// Casts rays [first, last) of the set; hits[i] becomes 1 if ray i hits something. Many threads
  /// call it concurrently.
  std::function<void(std::size_t first, std::size_t last, std::uint8_t* hits)> cast;
  /// Work for the whole set before the rays; its time counts too. May be empty.
  std::function<void()> before;
  /// If not empty, replaces both: casts the whole set and returns the seconds that count.
  std::function<double(std::uint8_t* hits)> cast_set{};
  /// If not empty: returns t of the closest hit of ray i, or infinity. Its time does not count.
  std::function<float(std::size_t i)> closest_t{};
};

}  // namespace voxdag::lab

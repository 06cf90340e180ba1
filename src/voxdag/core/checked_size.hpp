#pragma once
/// Counts of 64 bits as sizes in memory, which have 32 bits in a browser.
#include <cstddef>
#include <cstdint>
#include <limits>

#include "voxdag/core/memory_budget.hpp"

namespace voxdag {

/// Returns `count` as a size. Throws OverMemory, as `subject` (a file's name, or empty), if no
/// array in memory can have so many items.
inline std::size_t checked_size(std::uint64_t count, const char* subject = "") {
  if constexpr (sizeof(std::size_t) < sizeof(std::uint64_t))
    if (count > std::numeric_limits<std::size_t>::max())
      throw OverMemory(subject, "", "is larger than the memory of a program of 32 bits");
  return static_cast<std::size_t>(count);
}

}  // namespace voxdag

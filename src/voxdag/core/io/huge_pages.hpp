#pragma once
/// Huge pages for allocated memory.
#include <cstddef>

namespace voxdag {

/// Asks the system to back `memory`, which was just allocated, with huge pages. Without them most
/// reads from a large hash table miss the TLB, too.
void prefer_huge_pages(void* memory, std::size_t bytes) noexcept;

}  // namespace voxdag

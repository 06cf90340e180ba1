#pragma once
/// Huge pages for allocated memory.
#include <cstddef>

namespace voxdag {

/// Asks for huge pages where `memory`, which was just allocated, has room for some of them. Tables
/// that are read in no order need them: most reads would miss the cache of addresses, too.
void prefer_huge_pages(void* memory, std::size_t bytes) noexcept;

}  // namespace voxdag

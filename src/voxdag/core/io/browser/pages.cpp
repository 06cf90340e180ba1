#include "voxdag/core/io/pages.hpp"

#include <algorithm>
#include <cstdlib>
#include <cstring>

#include "voxdag/core/io/huge_pages.hpp"

namespace voxdag {

void* map_pages(std::size_t bytes, bool) noexcept {
  void* const memory = std::aligned_alloc(kPage, bytes);
  if (memory != nullptr) std::memset(memory, 0, bytes);
  return memory;
}

void prefer_huge_pages(void*, std::size_t) noexcept {}

std::uint64_t bytes_to_map(std::uint64_t bytes, std::uint64_t most) noexcept {
  constexpr std::uint64_t kRoom = std::uint64_t{32} << 20;
  return std::min(most, bytes + std::max(bytes, kRoom));
}

void* resize_pages(void* pages, std::size_t old_bytes, std::size_t new_bytes) noexcept {
  void* const memory = map_pages(new_bytes);
  if (memory == nullptr) return nullptr;
  std::memcpy(memory, pages, std::min(old_bytes, new_bytes));
  std::free(pages);
  return memory;
}

bool shrink_pages(void*, std::size_t, std::size_t) noexcept { return false; }

void unmap_pages(void* pages, std::size_t) noexcept { std::free(pages); }

void discard_pages(void* pages, std::size_t bytes) noexcept { std::memset(pages, 0, bytes); }

}  // namespace voxdag

#include "voxdag/core/io/pages.hpp"

#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <cstring>

#include "voxdag/core/io/huge_pages.hpp"
#include "voxdag/core/thread_sanitizer.hpp"

namespace voxdag {

void* map_pages(std::size_t bytes, bool may_be_huge) noexcept {
  // Huge pages must be aligned, but mmap does not guarantee that. So this maps more and unmaps the
  // ends.
  const bool is_huge = may_be_huge && bytes >= kHugePage;
  const std::size_t slack = is_huge ? kHugePage : 0;
  void* const memory = ::mmap(nullptr, bytes + slack, PROT_READ | PROT_WRITE,
                              MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (memory == MAP_FAILED) return nullptr;
  if (!is_huge) return memory;
  auto* begin = static_cast<char*>(memory);
  const std::size_t head = -reinterpret_cast<std::uintptr_t>(begin) & (kHugePage - 1);
  if (head != 0) ::munmap(begin, head);
  begin += head;
  // Pages of 64-bit ARM may have 64 KiB: then the last one may hold more than `bytes`.
  const auto page = static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
  const std::size_t used = (bytes + page - 1) / page * page;
  if (used < bytes + slack - head) ::munmap(begin + used, bytes + slack - head - used);
  prefer_huge_pages(begin, bytes);
  return begin;
}

void prefer_huge_pages([[maybe_unused]] void* memory, [[maybe_unused]] std::size_t bytes) noexcept {
#ifdef MADV_HUGEPAGE
  // Whole huge pages alone: their neighbours may belong to others.
  const auto begin = reinterpret_cast<std::uintptr_t>(memory);
  const std::uintptr_t first = (begin + kHugePage - 1) & ~(kHugePage - 1);
  const std::uintptr_t last = (begin + bytes) & ~(kHugePage - 1);
  if (last > first) ::madvise(reinterpret_cast<void*>(first), last - first, MADV_HUGEPAGE);
#endif
}

std::uint64_t bytes_to_map(std::uint64_t, std::uint64_t most) noexcept { return most; }

void* resize_pages(void* pages, std::size_t old_bytes, std::size_t new_bytes) noexcept {
#ifdef VOXDAG_TSAN
  // ThreadSanitizer does not follow mremap: it would take the last user of these addresses for one
  // of this array.
  void* const memory = map_pages(new_bytes);
  if (memory == nullptr) return nullptr;
  std::memcpy(memory, pages, std::min(old_bytes, new_bytes));
  ::munmap(pages, old_bytes);
  return memory;
#else
  void* const memory = ::mremap(pages, old_bytes, new_bytes, MREMAP_MAYMOVE);
  return memory == MAP_FAILED ? nullptr : memory;
#endif
}

bool shrink_pages(void* pages, std::size_t old_bytes, std::size_t new_bytes) noexcept {
  return ::mremap(pages, old_bytes, new_bytes, 0) != MAP_FAILED;
}

void unmap_pages(void* pages, std::size_t bytes) noexcept { ::munmap(pages, bytes); }

void discard_pages(void* pages, std::size_t bytes) noexcept {
  ::madvise(pages, bytes, MADV_DONTNEED);
}

}  // namespace voxdag

#include "voxdag/core/large_array.hpp"

#include <sys/mman.h>

#include <cstdlib>
#include <new>

namespace voxdag {

std::shared_ptr<void> allocate_large(std::size_t bytes) {
  constexpr std::size_t kLargePage = 2 << 20, kCacheLine = 64;
  const std::size_t alignment = bytes >= kLargePage ? kLargePage : kCacheLine;
  const std::size_t rounded = (bytes + alignment - 1) / alignment * alignment;
  if (rounded < bytes) throw std::bad_alloc();
  void* const memory = std::aligned_alloc(alignment, rounded > 0 ? rounded : alignment);
  if (memory == nullptr) throw std::bad_alloc();
#ifdef MADV_HUGEPAGE
  if (bytes >= kLargePage) madvise(memory, rounded, MADV_HUGEPAGE);  // only a hint
#endif
  return {memory, &std::free};
}

}  // namespace voxdag

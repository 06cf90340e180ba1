#pragma once
/// Memory for large arrays (hundreds of megabytes) that are read in random order.
#include <cstddef>
#include <memory>
#include <new>
#include <type_traits>

namespace voxdag {

/// Allocates `bytes` bytes, aligned to 64, on large pages if the system grants them. With small
/// pages, random reads spend most of their time on address translation. Throws std::bad_alloc.
std::shared_ptr<void> allocate_large(std::size_t bytes);

/// Returns an array of `count` uninitialised elements. Throws std::bad_alloc.
template <class T>
std::shared_ptr<T[]> make_large_array(std::size_t count) {
  static_assert(std::is_trivially_copyable_v<T>);
  if (count > static_cast<std::size_t>(-1) / sizeof(T)) throw std::bad_alloc();
  const std::shared_ptr<void> memory = allocate_large(count * sizeof(T));
  return {memory, static_cast<T*>(memory.get())};
}

}  // namespace voxdag

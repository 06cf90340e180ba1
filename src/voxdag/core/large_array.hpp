#pragma once
/// Memory for what is read here and there, hundreds of megabytes of it.
#include <cstddef>
#include <memory>
#include <new>
#include <type_traits>

namespace voxdag {

/// `bytes` of memory, on large pages where the system grants them: looking up small ones takes
/// longer than reading what is on them. Throws std::bad_alloc.
std::shared_ptr<void> allocate_large(std::size_t bytes);

/// An array of `count` elements that are not initialised. Throws std::bad_alloc.
template <class T>
std::shared_ptr<T[]> make_large_array(std::size_t count) {
  static_assert(std::is_trivially_copyable_v<T>);
  if (count > static_cast<std::size_t>(-1) / sizeof(T)) throw std::bad_alloc();
  const std::shared_ptr<void> memory = allocate_large(count * sizeof(T));
  return {memory, static_cast<T*>(memory.get())};
}

}  // namespace voxdag

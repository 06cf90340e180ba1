#pragma once
/// Vectors whose elements lie on the heap or in memory from a store, for example in mapped files.
#include <cstddef>
#include <limits>
#include <memory>
#include <new>
#include <type_traits>
#include <vector>

namespace voxdag {

/// Gives memory to large arrays. Outlives all arrays in it. Thread-safe.
class ArrayStore {
 public:
  ArrayStore() = default;
  ArrayStore(const ArrayStore&) = delete;
  ArrayStore& operator=(const ArrayStore&) = delete;
  virtual ~ArrayStore() = default;

  /// Returns `bytes` bytes of zeros, aligned to 64. Throws Error.
  virtual void* allocate(std::size_t bytes) = 0;
  /// Takes back what allocate(bytes) returned.
  virtual void deallocate(void* memory, std::size_t bytes) noexcept = 0;
};

/// An allocator that takes memory from a store; from the heap if the store is null. Moved and
/// swapped containers keep their store; copies are on the heap.
///
/// In a store, resize() does not touch new elements, so that large arrays need no memory before
/// they are written. A new element is zero unless the array had an element there before.
template <class T>
class StoredAllocator {
 public:
  using value_type = T;
  using propagate_on_container_copy_assignment = std::false_type;
  using propagate_on_container_move_assignment = std::true_type;
  using propagate_on_container_swap = std::true_type;

  StoredAllocator(ArrayStore* store = nullptr) noexcept : store_(store) {}
  template <class U>
  StoredAllocator(const StoredAllocator<U>& other) noexcept : store_(other.store()) {}

  /// Allocates `count` objects. Throws std::bad_alloc, or the store's Error.
  T* allocate(std::size_t count) {
    static_assert(std::is_trivially_copyable_v<T> && std::is_trivially_destructible_v<T>);
    if (store_ == nullptr) return std::allocator<T>().allocate(count);
    if (count > std::numeric_limits<std::size_t>::max() / sizeof(T))
      throw std::bad_array_new_length();
    return static_cast<T*>(store_->allocate(count * sizeof(T)));
  }
  // Not inlined: if it is, GCC 12 warns wrongly that the vector uses freed pointers.
  [[gnu::noinline]] void deallocate(T* memory, std::size_t count) noexcept {
    if (store_ == nullptr)
      std::allocator<T>().deallocate(memory, count);
    else
      store_->deallocate(memory, count * sizeof(T));
  }

  /// Makes a new element of resize(). Other elements are constructed as usual.
  template <class U>
  void construct(U* element) {
    if (store_ == nullptr) ::new (static_cast<void*>(element)) U();
  }

  StoredAllocator select_on_container_copy_construction() const { return {}; }
  ArrayStore* store() const { return store_; }
  friend bool operator==(const StoredAllocator& a, const StoredAllocator& b) {
    return a.store_ == b.store_;
  }

 private:
  ArrayStore* store_;
};

/// A vector of trivial elements in a store. Functions that grow it throw the store's Error.
template <class T>
using StoredVector = std::vector<T, StoredAllocator<T>>;

}  // namespace voxdag

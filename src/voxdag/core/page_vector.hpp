#pragma once
/// Arrays on pages of their own, for large data. Freed pages go back to the system immediately.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <new>
#include <type_traits>
#include <utility>

#include "voxdag/core/io/pages.hpp"
#include "voxdag/core/memory_budget.hpp"

namespace voxdag {

/// Like std::vector, for trivial types. When it grows, the old and the new array need not exist at
/// the same time. A budget counts the pages. Functions that grow it throw OverMemory or
/// std::bad_alloc, and leave it unchanged if they throw. Move-only.
template <class T>
class PageVector {
  static_assert(std::is_trivially_copyable_v<T> && std::is_trivially_destructible_v<T>);

 public:
  /// Makes an empty array. A null budget counts nothing.
  explicit PageVector(MemoryBudget* budget = nullptr) : budget_(budget) {}
  /// Returns an array of `count` zeros that does not grow and that no budget counts. Pages are
  /// resident only where they were touched. A large array uses huge pages, if the system grants
  /// them: on small pages, random reads spend their time on address translation. Throws
  /// std::bad_alloc.
  static PageVector zeros(std::size_t count) {
    PageVector array;
    const std::size_t bytes = page_bytes(count);
    if (bytes == 0) return array;
    void* const memory = map_pages(bytes, /*may_be_huge=*/true);
    if (memory == nullptr) throw std::bad_alloc();
    array.data_ = static_cast<T*>(memory);
    array.size_ = count;
    array.bytes_ = bytes;
    return array;
  }
  PageVector(PageVector&& other) noexcept { swap(other); }
  PageVector& operator=(PageVector&& other) noexcept {
    swap(other);
    return *this;
  }
  ~PageVector() { release(); }

  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  /// Returns the number of bytes that it holds from the system.
  std::size_t bytes() const { return bytes_; }
  T* data() { return data_; }
  const T* data() const { return data_; }
  T* begin() { return data_; }
  T* end() { return data_ + size_; }
  const T* begin() const { return data_; }
  const T* end() const { return data_ + size_; }
  T& operator[](std::size_t i) { return data_[i]; }
  const T& operator[](std::size_t i) const { return data_[i]; }
  T& back() { return data_[size_ - 1]; }

  /// Appends `value`, which must not be an element of this array.
  void push_back(const T& value) {
    if (size_ == capacity()) grow(size_ + 1);
    data_[size_++] = value;
  }
  /// Sets the number of elements. New elements are zero in memory that was never used; elsewhere
  /// their values are unspecified.
  void resize(std::size_t size) {
    if (size > capacity()) grow(size);
    size_ = size;
  }
  /// Makes room for a total of `size` elements.
  void reserve(std::size_t size) {
    if (size > capacity()) grow(size);
  }
  /// Removes all elements and keeps the memory.
  void clear() { size_ = 0; }

  /// Gives the pages after the last element back to the system.
  void shrink_to_fit() {
    const std::size_t bytes = page_bytes(size_);
    if (bytes == 0) return release();
    if (bytes == bytes_) return;
    if (!shrink_pages(data_, bytes_, bytes)) return;
    if (budget_ != nullptr) budget_->release(bytes_ - bytes);
    bytes_ = bytes;
  }
  /// Gives the memory back to the system; the elements become zero. Other threads may read them at
  /// the same time, and see old values or zeros.
  void discard() {
    if (data_ != nullptr) discard_pages(data_, bytes_);
  }
  /// Gives all memory back to the system, and removes all elements.
  void release() noexcept {
    if (data_ == nullptr) return;
    unmap_pages(data_, bytes_);
    if (budget_ != nullptr) budget_->release(bytes_);
    data_ = nullptr;
    size_ = bytes_ = 0;
  }

  void swap(PageVector& other) noexcept {
    std::swap(budget_, other.budget_);
    std::swap(data_, other.data_);
    std::swap(size_, other.size_);
    std::swap(bytes_, other.bytes_);
  }

 private:
  static std::size_t page_bytes(std::size_t count) {
    if (count > static_cast<std::size_t>(-1) / sizeof(T) - kPage) throw std::bad_alloc();
    return (count * sizeof(T) + kPage - 1) & ~(kPage - 1);
  }

  std::size_t capacity() const { return bytes_ / sizeof(T); }

  /// Makes room for at least `count` elements: doubles a small array, and grows a large one by an
  /// eighth.
  void grow(std::size_t count) {
    constexpr std::size_t kSmall = std::size_t{1} << 20;
    const std::size_t more = bytes_ < kSmall ? bytes_ : bytes_ / 8;
    const std::size_t bytes = std::max(page_bytes(count), page_bytes((bytes_ + more) / sizeof(T)));
    if (budget_ != nullptr) budget_->reserve(bytes - bytes_);
    void* const memory = data_ == nullptr ? map_pages(bytes) : resize_pages(data_, bytes_, bytes);
    if (memory == nullptr) {
      if (budget_ != nullptr) budget_->release(bytes - bytes_);
      throw std::bad_alloc();
    }
    data_ = static_cast<T*>(memory);
    bytes_ = bytes;
  }

  MemoryBudget* budget_ = nullptr;
  T* data_ = nullptr;
  std::size_t size_ = 0, bytes_ = 0;
};

/// Returns an array of `count` elements, as PageVector::zeros() makes it. Throws std::bad_alloc.
template <class T>
std::shared_ptr<T[]> make_large_array(std::size_t count) {
  const auto pages =
      std::make_shared<PageVector<T>>(PageVector<T>::zeros(std::max(count, std::size_t{1})));
  return {pages, pages->data()};
}

}  // namespace voxdag

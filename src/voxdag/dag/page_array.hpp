#pragma once
/// An array straight from the operating system's pages: zeroed, not counted as used memory until
/// touched, given back at once when freed, and on huge pages where it is large, since hash tables
/// otherwise spend their time in TLB misses.
#include <sys/mman.h>

#include <cstddef>
#include <new>
#include <type_traits>
#include <utility>

namespace voxdag {

template <class T>
class PageArray {
  static_assert(std::is_trivial_v<T>);

 public:
  PageArray() = default;
  explicit PageArray(std::size_t count) : count_(count) {
    if (count == 0) return;
    void* memory = ::mmap(nullptr, bytes(), PROT_READ | PROT_WRITE,
                          MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (memory == MAP_FAILED) throw std::bad_alloc();
#ifdef MADV_HUGEPAGE
    if (bytes() >= kHugePageWorth) ::madvise(memory, bytes(), MADV_HUGEPAGE);
#endif
    data_ = static_cast<T*>(memory);
  }
  PageArray(PageArray&& other) noexcept { swap(other); }
  PageArray& operator=(PageArray&& other) noexcept {
    swap(other);
    return *this;
  }
  ~PageArray() {
    if (data_ != nullptr) ::munmap(data_, bytes());
  }

  void swap(PageArray& other) noexcept {
    std::swap(data_, other.data_);
    std::swap(count_, other.count_);
  }
  T* data() { return data_; }
  const T* data() const { return data_; }
  std::size_t size() const { return count_; }
  std::size_t bytes() const { return count_ * sizeof(T); }
  T& operator[](std::size_t i) { return data_[i]; }
  const T& operator[](std::size_t i) const { return data_[i]; }

 private:
  static constexpr std::size_t kHugePageWorth = std::size_t{4} << 20;

  T* data_ = nullptr;
  std::size_t count_ = 0;
};

}  // namespace voxdag

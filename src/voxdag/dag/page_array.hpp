#pragma once
/// An array straight from the operating system's pages: zeroed, not counted as used memory until
/// touched, given back at once when freed, and on huge pages where it is large, since hash tables
/// otherwise spend their time in TLB misses.
#include <sys/mman.h>

#include <cstddef>
#include <cstdint>
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
    // Huge pages need their alignment, which mmap does not promise: take more, give back the ends.
    const std::size_t slack = bytes() >= kHugePage ? kHugePage : 0;
    void* memory = ::mmap(nullptr, mapped_bytes() + slack, PROT_READ | PROT_WRITE,
                          MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (memory == MAP_FAILED) {
      count_ = 0;
      throw std::bad_alloc();
    }
    char* begin = static_cast<char*>(memory);
    if (slack != 0) {
      const std::size_t head = -reinterpret_cast<std::uintptr_t>(begin) & (kHugePage - 1);
      if (head != 0) ::munmap(begin, head);
      ::munmap(begin + head + mapped_bytes(), slack - head);
      begin += head;
#ifdef MADV_HUGEPAGE
      ::madvise(begin, mapped_bytes(), MADV_HUGEPAGE);
#endif
    }
    data_ = reinterpret_cast<T*>(begin);
  }
  PageArray(PageArray&& other) noexcept { swap(other); }
  PageArray& operator=(PageArray&& other) noexcept {
    swap(other);
    return *this;
  }
  ~PageArray() {
    if (data_ != nullptr) ::munmap(data_, mapped_bytes());
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
  static constexpr std::size_t kHugePage = std::size_t{2} << 20;

  std::size_t mapped_bytes() const {
    constexpr std::size_t kPage = 4096;
    return (bytes() + kPage - 1) & ~(kPage - 1);
  }

  T* data_ = nullptr;
  std::size_t count_ = 0;
};

}  // namespace voxdag

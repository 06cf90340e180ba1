#pragma once
/// An array of fixed size on pages of its own. It is initially zero and resident only where it was
/// touched; freed pages go back to the system immediately. A large array uses huge pages, because
/// hash tables on small pages spend their time in TLB misses.
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
  static constexpr std::size_t kHugePage = std::size_t{2} << 20;

  PageArray() = default;
  explicit PageArray(std::size_t count) : count_(count) {
    if (count == 0) return;
    // Huge pages must be aligned, but mmap does not guarantee that. So this maps more and unmaps
    // the ends.
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

  /// Gives the memory back to the system. The array stays valid and becomes zero. Another thread
  /// may read it at the same time; it sees old values or zeros.
  void discard() {
    if (data_ != nullptr) ::madvise(data_, mapped_bytes(), MADV_DONTNEED);
  }

  void swap(PageArray& other) noexcept {
    std::swap(data_, other.data_);
    std::swap(count_, other.count_);
  }
  T* data() { return data_; }
  const T* data() const { return data_; }
  std::size_t size() const { return count_; }
  std::size_t bytes() const { return count_ * sizeof(T); }
  /// Returns bytes(), rounded up to whole pages.
  std::size_t mapped_bytes() const {
    constexpr std::size_t kPage = 4096;
    return (bytes() + kPage - 1) & ~(kPage - 1);
  }
  T& operator[](std::size_t i) { return data_[i]; }
  const T& operator[](std::size_t i) const { return data_[i]; }

 private:
  T* data_ = nullptr;
  std::size_t count_ = 0;
};

}  // namespace voxdag

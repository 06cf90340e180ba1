#pragma once
/// Memory of a CUDA device, and pinned memory of the host for asynchronous copies.
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <type_traits>
#include <utility>

namespace voxdag {

/// Throws Error, with the bytes needed and free, unless the current device has `bytes` bytes of
/// free memory. `what` names the content for the error: "the DAG".
void require_device_memory(std::uint64_t bytes, const char* what);

/// Allocates, frees and copies for DeviceBuffer and PinnedBuffer. Allocation and copies throw
/// Error.
void* allocate_device(std::uint64_t bytes, const char* what);
void free_device(void* memory) noexcept;
void* allocate_pinned(std::uint64_t bytes, const char* what);
void free_pinned(void* memory) noexcept;
void copy_to_device(void* device, const void* host, std::uint64_t bytes);
void copy_to_host(void* host, const void* device, std::uint64_t bytes);

/// Returns the bytes of an array, or the largest std::uint64_t if the product overflows.
template <class T>
constexpr std::uint64_t array_bytes(std::uint64_t count) {
  constexpr std::uint64_t kMax = std::numeric_limits<std::uint64_t>::max();
  return count > kMax / sizeof(T) ? kMax : count * sizeof(T);
}

/// Owns an array of uninitialised values, which `Free` frees.
template <class T, void (*Free)(void*) noexcept>
class OwnedArray {
 public:
  static_assert(std::is_trivially_copyable_v<T>);

  OwnedArray() = default;
  OwnedArray(void* memory, std::size_t count) : data_(static_cast<T*>(memory)), size_(count) {}
  OwnedArray(OwnedArray&& other) noexcept { *this = std::move(other); }
  OwnedArray& operator=(OwnedArray&& other) noexcept {
    std::swap(data_, other.data_);
    std::swap(size_, other.size_);
    return *this;
  }
  ~OwnedArray() {
    if (data_ != nullptr) Free(data_);
  }

  T* data() const { return data_; }
  std::size_t size() const { return size_; }

 private:
  T* data_ = nullptr;
  std::size_t size_ = 0;
};

template <class T>
using DeviceBuffer = OwnedArray<T, free_device>;
template <class T>
using PinnedBuffer = OwnedArray<T, free_pinned>;

/// Allocates on the current device. Throws Error if there is not enough memory; `what` names the
/// array.
template <class T>
DeviceBuffer<T> make_device_buffer(std::size_t count, const char* what) {
  return {allocate_device(array_bytes<T>(count), what), count};
}

template <class T>
DeviceBuffer<T> upload(std::span<const T> values, const char* what) {
  DeviceBuffer<T> buffer = make_device_buffer<T>(values.size(), what);
  copy_to_device(buffer.data(), values.data(), values.size_bytes());
  return buffer;
}

template <class T>
PinnedBuffer<T> make_pinned_buffer(std::size_t count, const char* what) {
  return {allocate_pinned(array_bytes<T>(count), what), count};
}

}  // namespace voxdag

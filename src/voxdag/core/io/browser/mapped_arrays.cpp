#include "voxdag/core/io/mapped_arrays.hpp"

#include <new>
#include <utility>

#include "voxdag/core/io/pages.hpp"

namespace voxdag {

// A browser has no files beside memory, so the arrays lie in memory.
MappedArrays::MappedArrays(std::filesystem::path folder) : folder_(std::move(folder)) {}

void* MappedArrays::allocate(std::size_t bytes) {
  void* const memory = map_pages((bytes + kPage - 1) / kPage * kPage);
  if (memory == nullptr) throw std::bad_alloc();
  const std::lock_guard lock(mutex_);
  arrays_.emplace(memory, bytes);
  return memory;
}

void MappedArrays::deallocate(void* memory, std::size_t bytes) noexcept {
  const std::lock_guard lock(mutex_);
  arrays_.erase(memory);
  unmap_pages(memory, bytes);
}

void MappedArrays::release() const noexcept {}

void MappedArrays::count_work(std::uint64_t) noexcept {}

std::uint64_t MappedArrays::bytes() const {
  const std::lock_guard lock(mutex_);
  std::uint64_t sum = 0;
  for (const auto& [memory, bytes] : arrays_) sum += bytes;
  return sum;
}

}  // namespace voxdag

#pragma once
/// Large arrays in files instead of memory.
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <mutex>

#include "voxdag/core/array_store.hpp"

namespace voxdag {

/// Keeps each array in a nameless file of one folder, mapped into memory. The system writes pages
/// to the file when it needs their memory, and reads them when they are touched again. So arrays
/// can be larger than memory. The folder shows no files, and the system frees them when the
/// process ends, however it ends. A folder in memory (tmpfs) saves no memory. Thread-safe.
class MappedArrays final : public ArrayStore {
 public:
  /// Puts the files into `folder` (empty: the current folder), which must exist when arrays are
  /// allocated.
  explicit MappedArrays(std::filesystem::path folder);

  /// Allocates an array and its space on the disk. Throws Error with the folder's name if the
  /// disk is full or the folder does not allow files.
  void* allocate(std::size_t bytes) override;
  void deallocate(void* memory, std::size_t bytes) noexcept override;

  /// Drops the pages of all arrays from this process's memory. The system keeps them cached while
  /// it has memory to spare. Other threads may use the arrays meanwhile.
  void release() const noexcept;

  /// Counts `bytes` of work on the arrays; calls release() once per 64 MiB. So sequential work
  /// keeps about that much resident.
  void count_work(std::uint64_t bytes) noexcept;

  /// Returns the bytes that all arrays have now in the folder.
  std::uint64_t bytes() const;

 private:
  std::filesystem::path folder_;
  mutable std::mutex mutex_;
  std::map<void*, std::size_t> arrays_;  ///< The bytes of each array, by its address.
  std::atomic<std::uint64_t> work_{0};   ///< Bytes.
};

}  // namespace voxdag

#include "voxdag/core/io/mapped_arrays.hpp"

#include <fcntl.h>
#include <sys/mman.h>

#include <cerrno>
#include <string>
#include <system_error>
#include <utility>

#include "voxdag/core/error.hpp"
#include "voxdag/core/io/nameless_file.hpp"

namespace voxdag {
namespace {

/// Returns the error of making a file of `bytes` bytes; `code` is the system's error.
Error file_error(const std::filesystem::path& folder, std::size_t bytes, int code) {
  return {folder.empty() ? "." : folder.string(), "",
          "cannot make a file of " + std::to_string((bytes + (1 << 20) - 1) >> 20) +
              " MiB for an array: " + std::system_category().message(code)};
}

}  // namespace

MappedArrays::MappedArrays(std::filesystem::path folder) : folder_(std::move(folder)) {}

void* MappedArrays::allocate(std::size_t bytes) {
  const Descriptor file = open_scratch_file(folder_);
  if (!file.is_open()) throw file_error(folder_, bytes, errno);
  // With all blocks allocated, a full disk is an error here instead of SIGBUS at a later write.
  int code = EINTR;
  while (code == EINTR) code = ::posix_fallocate(file.get(), 0, static_cast<off_t>(bytes));
  if (code != 0) throw file_error(folder_, bytes, code);
  void* const memory = ::mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED, file.get(), 0);
  if (memory == MAP_FAILED) throw file_error(folder_, bytes, errno);
  ::madvise(memory, bytes, MADV_DONTFORK);  // A ConfinedChild must not write to it.
  try {
    const std::lock_guard lock(mutex_);
    arrays_.emplace(memory, bytes);
  } catch (...) {
    ::munmap(memory, bytes);
    throw;
  }
  return memory;
}

void MappedArrays::deallocate(void* memory, std::size_t bytes) noexcept {
  const std::lock_guard lock(mutex_);
  arrays_.erase(memory);
  ::munmap(memory, bytes);
}

void MappedArrays::release() const noexcept {
  const std::lock_guard lock(mutex_);
  for (const auto& [memory, bytes] : arrays_) ::madvise(memory, bytes, MADV_DONTNEED);
}

void MappedArrays::count_work(std::uint64_t bytes) noexcept {
  constexpr std::uint64_t kWorkPerRelease = std::uint64_t{64} << 20;
  const std::uint64_t before = work_.fetch_add(bytes, std::memory_order_relaxed);
  if (before / kWorkPerRelease != (before + bytes) / kWorkPerRelease) release();
}

std::uint64_t MappedArrays::bytes() const {
  const std::lock_guard lock(mutex_);
  std::uint64_t sum = 0;
  for (const auto& [memory, bytes] : arrays_) sum += bytes;
  return sum;
}

}  // namespace voxdag

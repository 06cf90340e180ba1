#include "voxdag/core/io/mapped_file.hpp"

#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <string>
#include <system_error>
#include <utility>

#include "voxdag/core/error.hpp"

namespace voxdag {
namespace {

int advice(MappedFile::Access access) {
  switch (access) {
    case MappedFile::Access::kSequential:
      return MADV_SEQUENTIAL;
    case MappedFile::Access::kSoon:
      return MADV_WILLNEED;
    default:
      return MADV_RANDOM;
  }
}

}  // namespace

MappedFile::MappedFile(const std::filesystem::path& path, Access access, SizeLimit limit)
    : MappedFile(open_input(path, InputKind::kRegularFile, limit), path, access) {}

MappedFile::MappedFile(const OpenInput& input, const std::filesystem::path& path, Access access) {
  const auto size = static_cast<std::size_t>(*input.size);
  if (size == 0) return;
  void* const address = mmap(nullptr, size, PROT_READ, MAP_PRIVATE, input.descriptor.get(), 0);
  if (address == MAP_FAILED)
    throw Error(path.string(), "", "cannot map: " + std::system_category().message(errno));
  madvise(address, size, advice(access));
  bytes_ = {static_cast<const std::byte*>(address), size};
}

MappedFile::MappedFile(MappedFile&& other) noexcept : bytes_(std::exchange(other.bytes_, {})) {}

MappedFile& MappedFile::operator=(MappedFile&& other) noexcept {
  std::swap(bytes_, other.bytes_);
  return *this;
}

MappedFile::~MappedFile() {
  if (!bytes_.empty()) munmap(const_cast<std::byte*>(bytes_.data()), bytes_.size());
}

void MappedFile::release(std::string_view part) const {
  const auto page = static_cast<std::uintptr_t>(sysconf(_SC_PAGESIZE));
  const auto first = (reinterpret_cast<std::uintptr_t>(part.data()) + page - 1) / page * page;
  const auto last = reinterpret_cast<std::uintptr_t>(part.data() + part.size()) / page * page;
  if (first < last) madvise(reinterpret_cast<void*>(first), last - first, MADV_DONTNEED);
}

}  // namespace voxdag

#include "voxdag/core/io/mapped_file.hpp"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <limits>
#include <string>
#include <system_error>
#include <utility>

#include "voxdag/core/error.hpp"
#include "voxdag/core/io/pages.hpp"

namespace voxdag {
namespace {

std::size_t whole_pages(std::size_t bytes) { return (bytes + kPage - 1) / kPage * kPage; }

}  // namespace

MappedFile::MappedFile(const std::filesystem::path& path, Access access, SizeLimit limit)
    : MappedFile(open_input(path, InputKind::kRegularFile, limit), path, access) {}

MappedFile::MappedFile(const OpenInput& input, const std::filesystem::path& path, Access) {
  if (*input.size == 0) return;
  constexpr std::uint64_t kMost = std::numeric_limits<std::size_t>::max() / 2;
  const auto size = static_cast<std::size_t>(std::min(*input.size, kMost));
  auto* const bytes = *input.size > kMost
                          ? nullptr
                          : static_cast<std::byte*>(std::aligned_alloc(kPage, whole_pages(size)));
  if (bytes == nullptr)
    throw OverMemory(path.string(), "",
                     "has " + std::to_string(*input.size >> 20) +
                         " MiB, more than the memory of a page of the browser has left");
  bytes_ = {bytes, size};
  for (std::size_t done = 0; done < size;) {
    const ssize_t got =
        ::pread(input.descriptor.get(), bytes + done, size - done, static_cast<off_t>(done));
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) {
      const std::string reason = got < 0 ? std::system_category().message(errno)
                                         : "the file was truncated while it was read";
      std::free(bytes);
      throw Error(path.string(), ErrorPlace::byte(done), "cannot read: " + reason);
    }
    done += static_cast<std::size_t>(got);
  }
}

MappedFile::MappedFile(MappedFile&& other) noexcept : bytes_(std::exchange(other.bytes_, {})) {}

MappedFile& MappedFile::operator=(MappedFile&& other) noexcept {
  std::swap(bytes_, other.bytes_);
  return *this;
}

MappedFile::~MappedFile() { std::free(const_cast<std::byte*>(bytes_.data())); }

void MappedFile::release(std::string_view) const {}

}  // namespace voxdag

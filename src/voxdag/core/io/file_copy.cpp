#include "voxdag/core/io/file_copy.hpp"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <system_error>

#include "voxdag/core/error.hpp"
#include "voxdag/core/page_vector.hpp"

namespace voxdag {

FileCopy::FileCopy(const std::filesystem::path& path, SizeLimit limit)
    : FileCopy(open_input(path, InputKind::kRegularFile, limit), path) {}

FileCopy::FileCopy(const OpenInput& input, const std::filesystem::path& path)
    : size_(static_cast<std::size_t>(*input.size)) {
  bytes_ = make_large_array<std::byte>(size_);
  for (std::size_t done = 0; done < size_;) {
    constexpr std::size_t kMaxAtOnce = std::size_t{1} << 30;
    const ssize_t got = ::pread(input.descriptor.get(), bytes_.get() + done,
                                std::min(size_ - done, kMaxAtOnce), static_cast<off_t>(done));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0)
      throw Error(path.string(), ErrorPlace::byte(done),
                  "cannot read: " + std::system_category().message(errno));
    if (got == 0)
      throw Error(path.string(), ErrorPlace::byte(done),
                  "the file was truncated while it was read");
    done += static_cast<std::size_t>(got);
  }
}

}  // namespace voxdag

#include "voxdag/core/io/open_input.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <system_error>

#include "voxdag/core/error.hpp"

namespace voxdag {
namespace {

constexpr std::size_t kReadBytes = std::size_t{1} << 16;

Error system_error(const std::filesystem::path& path, const char* action) {
  return {path.string(), "", std::string(action) + ": " + std::system_category().message(errno)};
}

/// Returns "64 MiB", or bytes if the size is not a whole number of MiB.
std::string size_text(std::uint64_t bytes) {
  constexpr std::uint64_t kMebibyte = std::uint64_t{1} << 20;
  return bytes % kMebibyte == 0 ? std::to_string(bytes / kMebibyte) + " MiB"
                                : std::to_string(bytes) + " bytes";
}

Error over_limit(const std::filesystem::path& path, const std::string& size, SizeLimit limit) {
  return {path.string(), "",
          size + " more than the limit of " + size_text(limit.bytes) + " for " + limit.kind};
}

}  // namespace

OpenInput open_input(const std::filesystem::path& path, InputKind kind, SizeLimit limit) {
  // With O_NONBLOCK, opening a named pipe does not wait for its writer.
  const int wait = kind == InputKind::kRegularFile ? O_NONBLOCK : 0;
  OpenInput input{Descriptor(::open(path.c_str(), O_RDONLY | O_CLOEXEC | wait)), {}};
  if (!input.descriptor.is_open()) throw system_error(path, "cannot open");
  struct stat info {};
  if (::fstat(input.descriptor.get(), &info) != 0) throw system_error(path, "cannot open");
  if (S_ISDIR(info.st_mode)) throw Error(path.string(), "", "is a directory");
  if (S_ISREG(info.st_mode)) {
    input.size = static_cast<std::uint64_t>(info.st_size);
    if (*input.size > limit.bytes)
      throw over_limit(path, std::to_string(*input.size) + " bytes are", limit);
    return input;
  }
  if (kind == InputKind::kRegularFile) throw Error(path.string(), "", "is not a regular file");
  if (!S_ISFIFO(info.st_mode) && !S_ISSOCK(info.st_mode))
    throw Error(path.string(), "", "is neither a regular file nor a pipe");
  return input;
}

std::string read_input(const std::filesystem::path& path, SizeLimit limit, InputKind kind) {
  const OpenInput input = open_input(path, kind, limit);
  // One byte beyond the size, so that the last read sees the end of the file.
  std::string bytes(input.size.value_or(0) + 1, '\0');
  for (std::size_t size = 0;;) {
    if (size == bytes.size())
      bytes.resize(size + std::min<std::uint64_t>(kReadBytes, limit.bytes - size + 1));
    const ssize_t got = ::read(input.descriptor.get(), bytes.data() + size, bytes.size() - size);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) throw system_error(path, "cannot read");
    size += static_cast<std::size_t>(got);
    if (size > limit.bytes) throw over_limit(path, "its content is", limit);
    if (got > 0) continue;
    bytes.resize(size);
    return bytes;
  }
}

}  // namespace voxdag

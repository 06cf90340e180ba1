#include "voxdag/core/io/resolved_output.hpp"

#include <cerrno>
#include <charconv>
#include <string>
#include <system_error>

namespace voxdag {
namespace {

namespace fs = std::filesystem;

constexpr int kMaxLinks = 40;  // Linux's own limit

/// Returns the descriptor of this process that the path itself names, or -1.
int descriptor_at(const fs::path& path) {
  std::error_code none;
  const fs::path folder = path.has_parent_path() ? path.parent_path() : ".";
  const fs::path place = fs::canonical(folder, none);
  // /proc may belong to another PID namespace: getpid() would not name this process in it.
  if (place.empty() || (place != fs::canonical("/proc/self/fd", none) &&
                        place != fs::canonical("/proc/thread-self/fd", none)))
    return -1;
  const std::string name = path.filename();
  int descriptor = -1;
  const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), descriptor);
  return error == std::errc() && end == name.data() + name.size() ? descriptor : -1;
}

}  // namespace

ResolvedOutput resolve_output(const fs::path& path) {
  ResolvedOutput output;
  output.file = path;
  for (int links = 0;; ++links) {
    output.descriptor = descriptor_at(output.file);
    std::error_code error;
    if (output.descriptor >= 0 || !fs::is_symlink(output.file, error)) return output;
    const fs::path next = fs::read_symlink(output.file, error);
    output.error = error ? error.value() : links == kMaxLinks ? ELOOP : 0;
    if (output.error != 0) return output;
    output.file = output.file.parent_path() / next;
  }
}

std::filesystem::path output_path_of(int descriptor) {
  return "/proc/self/fd/" + std::to_string(descriptor);
}

}  // namespace voxdag

#include "voxdag/io/resolved_output.hpp"

#include <cerrno>
#include <charconv>
#include <string>
#include <system_error>

namespace voxdag {
namespace {

namespace fs = std::filesystem;

constexpr int kMostLinks = 40;  // as many as Linux follows

/// The number of the descriptor of this process that the path, if no link, names, or -1.
int descriptor_at(const fs::path& path) {
  std::error_code none;
  const fs::path folder = path.has_parent_path() ? path.parent_path() : ".";
  const fs::path place = fs::canonical(folder, none);
  // Not by getpid(): /proc may be of another name space.
  if (place.empty() || (place != fs::canonical("/proc/self/fd", none) &&
                        place != fs::canonical("/proc/thread-self/fd", none)))
    return -1;
  const std::string name = path.filename();
  int descriptor = -1;
  const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), descriptor);
  return error == std::errc() && end == name.data() + name.size() ? descriptor : -1;
}

}  // namespace

OutputPlace output_place(const fs::path& path) {
  OutputPlace place;
  place.file = path;
  for (int links = 0;; ++links) {
    place.descriptor = descriptor_at(place.file);
    std::error_code error;
    if (place.descriptor >= 0 || !fs::is_symlink(place.file, error)) return place;
    const fs::path next = fs::read_symlink(place.file, error);
    place.error = error ? error.value() : links == kMostLinks ? ELOOP : 0;
    if (place.error != 0) return place;
    place.file = place.file.parent_path() / next;
  }
}

}  // namespace voxdag

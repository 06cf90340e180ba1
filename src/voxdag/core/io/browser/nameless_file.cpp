#include "voxdag/core/io/nameless_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <string>

namespace voxdag {

int open_nameless_file(const std::filesystem::path&) { return -1; }

Descriptor open_scratch_file(const std::filesystem::path& folder) {
  std::string name = (folder / ".voxdag-XXXXXX").string();
  Descriptor file(mkstemp(name.data()));
  if (file.is_open()) unlink(name.c_str());
  return file;
}

// All files are in memory. This one keeps its name, by which path_of_descriptor() finds it.
Descriptor open_memory_file(bool) {
  std::string name = "/tmp/.voxdag-XXXXXX";
  return Descriptor(mkstemp(name.data()));
}

// Files are not opened by /proc/self/fd, which only names them.
std::filesystem::path path_of_descriptor(int descriptor) {
  return std::filesystem::read_symlink("/proc/self/fd/" + std::to_string(descriptor));
}

Descriptor duplicate(int descriptor) noexcept { return Descriptor(fcntl(descriptor, F_DUPFD, 0)); }

int name_file(int, const std::filesystem::path&) noexcept { return ENOSYS; }

int copy_file(int, int) noexcept { return ENOSYS; }

int exchange_names(const std::filesystem::path& a, const std::filesystem::path& b) noexcept {
  const std::string aside = a.string() + ".exchange";
  const bool is_done = std::rename(b.c_str(), aside.c_str()) == 0 &&
                       std::rename(a.c_str(), b.c_str()) == 0 &&
                       std::rename(aside.c_str(), a.c_str()) == 0;
  return is_done ? 0 : errno;
}

}  // namespace voxdag

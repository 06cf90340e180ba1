#include "voxdag/core/io/nameless_file.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/sendfile.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <string>

namespace voxdag {
namespace {

/// A path to an open file that works without a name, through /proc.
struct OwnPath {
  char text[32];
  explicit OwnPath(int descriptor) {
    std::snprintf(text, sizeof text, "/proc/self/fd/%d", descriptor);
  }
};

}  // namespace

int open_nameless_file(const std::filesystem::path& folder) {
  const int descriptor =
      open(folder.empty() ? "." : folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0666);
  if (descriptor < 0 || access(OwnPath(descriptor).text, F_OK) == 0) return descriptor;
  close(descriptor);
  return -1;
}

Descriptor open_scratch_file(const std::filesystem::path& folder) {
  if (const int nameless = open_nameless_file(folder); nameless >= 0) return Descriptor(nameless);
  std::string name = (folder / ".voxdag-XXXXXX").string();
  Descriptor file(mkostemp(name.data(), O_CLOEXEC));
  if (file.is_open()) unlink(name.c_str());
  return file;
}

Descriptor open_memory_file(bool is_inherited) {
  return Descriptor(memfd_create("voxdag", is_inherited ? 0 : MFD_CLOEXEC));
}

std::filesystem::path path_of_descriptor(int descriptor) { return OwnPath(descriptor).text; }

Descriptor duplicate(int descriptor) noexcept {
  return Descriptor(fcntl(descriptor, F_DUPFD_CLOEXEC, 0));
}

int name_file(int descriptor, const std::filesystem::path& name) noexcept {
  const int result =
      linkat(AT_FDCWD, OwnPath(descriptor).text, AT_FDCWD, name.c_str(), AT_SYMLINK_FOLLOW);
  return result == 0 ? 0 : errno;
}

int copy_file(int from, int to) noexcept {
  struct stat info {};
  if (fstat(from, &info) != 0 || fchmod(to, info.st_mode & 0777) != 0) return errno;
  for (off_t at = 0; at < info.st_size;) {
    const ssize_t copied = sendfile(to, from, &at, static_cast<std::size_t>(info.st_size - at));
    if (copied < 0 && errno != EINTR) return errno;
    if (copied == 0) return EIO;
  }
  return 0;
}

int exchange_names(const std::filesystem::path& a, const std::filesystem::path& b) noexcept {
  return renameat2(AT_FDCWD, a.c_str(), AT_FDCWD, b.c_str(), RENAME_EXCHANGE) == 0 ? 0 : errno;
}

}  // namespace voxdag

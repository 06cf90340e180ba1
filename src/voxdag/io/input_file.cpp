#include "voxdag/io/input_file.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <system_error>

#include "voxdag/core/error.hpp"

namespace voxdag {
namespace {

Error system_error(const std::filesystem::path& path, const char* action) {
  return {path.string(), "", std::string(action) + ": " + std::generic_category().message(errno)};
}

/// Closes the descriptor on every way out; the mapping outlives it.
struct Descriptor {
  int fd;
  ~Descriptor() {
    if (fd >= 0) ::close(fd);
  }
};

}  // namespace

InputFile::InputFile(const std::filesystem::path& path) {
  // O_NONBLOCK: opening a named pipe must not wait for a writer.
  const Descriptor file{::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)};
  if (file.fd < 0) throw system_error(path, "cannot open");
  struct stat info {};
  if (::fstat(file.fd, &info) != 0) throw system_error(path, "cannot read");
  if (S_ISDIR(info.st_mode)) throw Error(path.string(), "", "is a directory, not a mesh file");
  if (!S_ISREG(info.st_mode)) throw Error(path.string(), "", "is not a regular file");
  size_ = static_cast<std::size_t>(info.st_size);
  if (size_ == 0) return;
  void* data = ::mmap(nullptr, size_, PROT_READ, MAP_PRIVATE, file.fd, 0);
  if (data == MAP_FAILED) throw system_error(path, "cannot map");
  data_ = static_cast<const char*>(data);
  ::madvise(data, size_, MADV_SEQUENTIAL);
}

InputFile::~InputFile() {
  if (data_ != nullptr) ::munmap(const_cast<char*>(data_), size_);
}

void InputFile::release(std::string_view part) const {
  if (data_ == nullptr) return;
  const auto page = static_cast<std::uintptr_t>(::sysconf(_SC_PAGESIZE));
  const auto first = (reinterpret_cast<std::uintptr_t>(part.data()) + page - 1) / page * page;
  const auto last = reinterpret_cast<std::uintptr_t>(part.data() + part.size()) / page * page;
  if (first < last) ::madvise(reinterpret_cast<void*>(first), last - first, MADV_DONTNEED);
}

}  // namespace voxdag

#include "voxdag/core/io/atomic_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cassert>
#include <cerrno>
#include <string>
#include <system_error>
#include <utility>

#include "voxdag/core/error.hpp"
#include "voxdag/core/io/descriptor.hpp"
#include "voxdag/core/io/nameless_file.hpp"
#include "voxdag/core/io/resolved_output.hpp"
#include "voxdag/core/io/temporary_file.hpp"
#include "voxdag/core/io/unfinished_files.hpp"

namespace voxdag {
namespace {

namespace fs = std::filesystem;

}  // namespace

void write_whole_file(const std::filesystem::path& path, std::string_view bytes) {
  AtomicFile file(path);
  file.write(bytes);
  file.commit();
}

AtomicFile::AtomicFile(const fs::path& path, std::size_t buffer_bytes)
    : path_(path), target_(path), buffer_bytes_(buffer_bytes) {
  const ResolvedOutput output = resolve_output(path);
  if (output.error != 0) fail_to_open(output.error);
  target_ = output.file;
  if (output.descriptor >= 0) {
    share(output.descriptor);
    return;
  }
  struct stat existing {};
  const bool exists = stat(path.c_str(), &existing) == 0;
  if (!exists && errno == ENAMETOOLONG) fail_to_open(errno);
  if (exists && S_ISDIR(existing.st_mode)) fail_to_open(EISDIR);
  if (exists && !S_ISREG(existing.st_mode)) {
    descriptor_ = open(path.c_str(), O_WRONLY | O_CLOEXEC);
    if (descriptor_ < 0) fail_to_open(errno);
    return;
  }
  if (path.filename().empty()) fail_to_open(ENOENT);
  if (exists && access(target_.c_str(), W_OK) != 0) fail_to_open(errno);

  remove_leftovers(target_);
  descriptor_ = open_nameless_file(target_.parent_path());
  is_nameless_ = descriptor_ >= 0;
  if (is_nameless_) {
    temporary_ = temporary_name(target_);
    noted_ = note_unfinished(temporary_);
    lock_temporary(descriptor_);
  } else {
    create_named();
  }
  // Does not copy the set-user-ID and set-group-ID bits, because they were meant for the old
  // contents.
  if (exists) fchmod(descriptor_, existing.st_mode & 0777);
}

AtomicFile::AtomicFile(AtomicFile&& other) noexcept
    : path_(std::move(other.path_)),
      target_(std::move(other.target_)),
      temporary_(std::exchange(other.temporary_, {})),
      noted_(std::exchange(other.noted_, nullptr)),
      is_nameless_(std::exchange(other.is_nameless_, false)),
      descriptor_(std::exchange(other.descriptor_, -1)),
      start_(other.start_),
      is_appended_(other.is_appended_),
      flushed_(other.flushed_),
      buffer_bytes_(other.buffer_bytes_),
      buffer_(std::move(other.buffer_)) {}

AtomicFile::~AtomicFile() { discard(); }

void AtomicFile::write(const void* data, std::size_t bytes) {
  assert(descriptor_ >= 0);
  const auto* from = static_cast<const std::byte*>(data);
  if (buffer_.size() + bytes > buffer_bytes_) flush();
  if (bytes >= buffer_bytes_) return write_through(from, bytes);
  if (buffer_.capacity() == 0) buffer_.reserve(buffer_bytes_);
  buffer_.insert(buffer_.end(), from, from + bytes);
}

void AtomicFile::write_zeros(std::size_t bytes) {
  static constexpr std::byte kZeros[4096] = {};
  while (bytes > 0) {
    const std::size_t now = std::min(bytes, sizeof kZeros);
    write(kZeros, now);
    bytes -= now;
  }
}

void AtomicFile::overwrite(std::uint64_t offset, const void* data, std::size_t bytes) {
  assert(offset + bytes <= position());
  flush();
  if (is_appended_) fail(offset, ESPIPE);
  const auto* from = static_cast<const std::byte*>(data);
  while (bytes > 0) {
    const ssize_t written = pwrite(descriptor_, from, bytes, start_ + static_cast<off_t>(offset));
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail(offset, errno);
    from += written;
    offset += static_cast<std::uint64_t>(written);
    bytes -= static_cast<std::size_t>(written);
  }
}

void AtomicFile::commit() {
  assert(descriptor_ >= 0);
  flush();
  if (is_nameless_) take_name();
  // Keeps the lock until the file has its final name.
  const Descriptor lock = duplicate(descriptor_);
  // Some file systems (NFS, quotas) report a failed write only here.
  if (close(std::exchange(descriptor_, -1)) != 0) fail(position(), errno);
  if (temporary_.empty()) return;
  if (rename(temporary_.c_str(), target_.c_str()) != 0) fail(position(), errno);
  forget_unfinished(std::exchange(noted_, nullptr));
  temporary_.clear();
}

/// Writes through a descriptor that is open already, from its current position.
void AtomicFile::share(int descriptor) {
  const int flags = fcntl(descriptor, F_GETFL);
  if (flags < 0) fail_to_open(errno);
  // A descriptor that this program opened itself is not an output that the user named.
  const bool is_own = (fcntl(descriptor, F_GETFD) & FD_CLOEXEC) != 0;
  if (is_own || (flags & O_ACCMODE) == O_RDONLY) fail_to_open(EBADF);
  descriptor_ = duplicate(descriptor).release();
  if (descriptor_ < 0) fail_to_open(errno);
  is_appended_ = (flags & O_APPEND) != 0;
  const off_t start = lseek(descriptor_, 0, SEEK_CUR);
  start_ = start < 0 ? 0 : start;
}

void AtomicFile::create_named() {
  do {
    temporary_ = temporary_name(target_);
    descriptor_ = open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  } while (descriptor_ < 0 && errno == EEXIST);
  if (descriptor_ < 0) fail_to_open(errno);
  noted_ = note_unfinished(temporary_);
  lock_temporary(descriptor_);
}

/// Gives a nameless file the name of the target if that is free, else the temporary name.
void AtomicFile::take_name() {
  if (noted_ != nullptr && !is_noted(noted_)) fail(position(), ECANCELED);
  int error = name_file(descriptor_, target_);
  if (error == 0)
    temporary_ = target_;  // removed if closing it fails
  else if (error == EEXIST)
    error = name_file(descriptor_, temporary_);
  is_nameless_ = false;
  if (error != 0) copy_to_named();
}

/// Copies a nameless file to a named one, if the system refuses to give it a name.
void AtomicFile::copy_to_named() {
  struct Nameless {
    int descriptor;
    ~Nameless() { close(descriptor); }
  };
  const Nameless from{std::exchange(descriptor_, -1)};
  forget_unfinished(std::exchange(noted_, nullptr));
  create_named();
  if (const int error = copy_file(from.descriptor, descriptor_); error != 0)
    fail(position(), error);
}

void AtomicFile::flush() {
  write_through(buffer_.data(), buffer_.size());
  buffer_.clear();
}

void AtomicFile::write_through(const std::byte* data, std::size_t bytes) {
  // Linux writes at most 2 GiB at once, and less if a signal or a full disk interrupts it.
  const std::size_t all = bytes;
  while (bytes > 0) {
    const ssize_t written = ::write(descriptor_, data, bytes);
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail(flushed_ + (all - bytes), errno);
    data += written;
    bytes -= static_cast<std::size_t>(written);
  }
  flushed_ += all;
}

void AtomicFile::discard() noexcept {
  if (descriptor_ >= 0) close(std::exchange(descriptor_, -1));
  if (!temporary_.empty() && !is_nameless_) unlink(temporary_.c_str());
  forget_unfinished(std::exchange(noted_, nullptr));
  temporary_.clear();
}

void AtomicFile::fail_to_open(int error) const {
  const fs::path folder = target_.parent_path();
  std::error_code unknown;
  const bool has_folder = folder.empty() || fs::exists(folder, unknown) || unknown;
  throw Error(path_.string(), "",
              "cannot write: " + (error == ENOENT && !has_folder
                                      ? "the folder " + folder.string() + " does not exist"
                                      : std::system_category().message(error)));
}

void AtomicFile::fail(std::uint64_t at, int error) const {
  throw Error(path_.string(), ErrorPlace::byte(at),
              "cannot write: " + std::system_category().message(error));
}

}  // namespace voxdag

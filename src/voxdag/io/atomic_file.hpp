#pragma once
/// An output file that appears under its name only when it is complete.
#include <sys/types.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string_view>
#include <vector>

namespace voxdag {

/// Written to a file without a name in its folder (nameless_file.hpp), to which commit() gives the
/// name: where the process is killed before, nothing is left. Where the file system has no such
/// files it is written beside its name (NAME.tmp-PID-n), and commit() renames it. Destroyed before
/// commit(), also by an exception that passes, it removes what it wrote; an older file of the name
/// stays as it is.
///
/// A name that exists and is neither a regular file nor a directory (a pipe, /dev/null) is written
/// directly, and so is a descriptor of this process (/dev/stdout, /dev/fd/3), whatever it is of,
/// from where it stands. A symbolic link stays; the file that it points to is made or replaced.
/// Data is not forced to the disk (no fsync): after a power cut the file may be damaged, which
/// formats with checksums detect; a crash of the program alone cannot leave a partial file.
///
/// Every failure throws Error(path, "byte N", the system's reason). A process that may run
/// under a file size limit has to ignore SIGXFSZ, and one that writes to pipes SIGPIPE, to see the
/// error instead of the signal. Not thread-safe.
class AtomicFile {
 public:
  /// Creates the file, so that an unwritable place is known before the work begins.
  explicit AtomicFile(const std::filesystem::path& path);
  AtomicFile(AtomicFile&& other) noexcept;
  AtomicFile& operator=(AtomicFile&&) = delete;
  ~AtomicFile();

  void write(const void* data, std::size_t bytes);
  void write(std::string_view text) { write(text.data(), text.size()); }
  template <class T>
  void write(std::span<const T> values) {
    write(values.data(), values.size_bytes());
  }
  void write_zeros(std::size_t bytes);

  /// Overwrites bytes already written, e.g. a count in a header. [offset, offset + bytes) must lie
  /// below position(). Fails where the file cannot seek (a pipe, or what is only appended to).
  void overwrite(std::uint64_t offset, const void* data, std::size_t bytes);

  /// Bytes written so far.
  std::uint64_t position() const { return flushed_ + buffer_.size(); }
  const std::filesystem::path& path() const { return path_; }

  /// Flushes and gives the file its name. Nothing may be written afterwards.
  void commit();

 private:
  void flush();
  void write_through(const std::byte* data, std::size_t bytes);
  void share(int descriptor);
  void create_named();
  void take_name();
  void copy_to_named();
  void discard() noexcept;
  [[noreturn]] void fail(std::uint64_t at, int error) const;

  std::filesystem::path path_;       ///< As given: what errors name.
  std::filesystem::path target_;     ///< With symbolic links resolved.
  std::filesystem::path temporary_;  ///< Empty where the target is written directly.
  char* noted_ = nullptr;            ///< That name, for remove_unfinished_files().
  bool is_nameless_ = false;         ///< The temporary name is not in use yet.
  int descriptor_ = -1;
  off_t start_ = 0;  ///< Of what is written, in the file.
  bool is_appended_ = false;
  std::uint64_t flushed_ = 0;
  std::vector<std::byte> buffer_;
};

/// Writes a file of these bytes through AtomicFile: complete or not at all.
void write_whole_file(const std::filesystem::path& path, std::string_view bytes);

/// Removes the temporary files of every AtomicFile that was not committed, for a signal handler
/// about to end the process: async-signal-safe. A commit() after it fails. With more than 64 files
/// open at a time the others are left.
void remove_unfinished_files() noexcept;

}  // namespace voxdag

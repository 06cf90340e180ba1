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

/// Writes to a file without a name (nameless_file.hpp) in the output's folder. commit() gives it
/// the name. Where the file system has no nameless files, it writes to NAME.voxdag-PID-N, which
/// commit() renames. If it is destroyed before commit(), also by an exception, it removes its file,
/// and an older file of that name stays unchanged. The new file gets the permissions of a file that
/// it replaces, without set-user-ID and set-group-ID bits.
///
/// A killed process (SIGKILL) never leaves a partial output under the output's name. It can leave a
/// file NAME.voxdag-PID-N. This file is complete if the process was killed between naming a
/// nameless file and renaming it over an older output. It is partial on file systems without
/// nameless files. The next AtomicFile for the same output removes such files (remove_leftovers in
/// temporary_file.hpp).
///
/// An output that exists and is neither a regular file nor a directory (a pipe, /dev/null) is
/// written directly. So is a descriptor of this process (/dev/stdout, /dev/fd/3), of any kind, from
/// its current position. A symbolic link stays; the file that it points to is created or replaced.
/// Data is not forced to the disk (no fsync). After a power cut the file may be damaged; formats
/// with checksums detect that.
///
/// Every failure throws Error: a failed write with the place "byte N" and the system's reason, a
/// file that cannot be created without a place. To get the error instead of a signal, a process
/// that may run under a file size limit must ignore SIGXFSZ, and a process that writes to pipes
/// must ignore SIGPIPE. Not thread-safe.
class AtomicFile {
 public:
  static constexpr std::size_t kBufferBytes = std::size_t{1} << 20;

  /// Creates the file, so that an unwritable folder is an error before the work begins. Collects
  /// `buffer_bytes` before it writes; 0: the caller writes large pieces.
  explicit AtomicFile(const std::filesystem::path& path, std::size_t buffer_bytes = kBufferBytes);
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
  /// below position(). Throws if the output is not seekable (a pipe, a file opened for appending).
  void overwrite(std::uint64_t offset, const void* data, std::size_t bytes);

  /// Returns the number of bytes written so far.
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
  [[noreturn]] void fail_to_open(int error) const;
  [[noreturn]] void fail(std::uint64_t at, int error) const;

  std::filesystem::path path_;       ///< The caller's path; errors name it.
  std::filesystem::path target_;     ///< With symbolic links resolved.
  std::filesystem::path temporary_;  ///< Empty if the target is written directly.
  char* noted_ = nullptr;            ///< Its handle in unfinished_files.hpp.
  bool is_nameless_ = false;         ///< The temporary name is not in use yet.
  int descriptor_ = -1;
  off_t start_ = 0;  ///< Offset in the file at which the output starts.
  bool is_appended_ = false;
  std::uint64_t flushed_ = 0;
  std::size_t buffer_bytes_;
  std::vector<std::byte> buffer_;
};

/// Writes a file of these bytes through AtomicFile: complete or not at all.
void write_whole_file(const std::filesystem::path& path, std::string_view bytes);

}  // namespace voxdag

#pragma once
/// The files of a work folder: complete, checked, and bound to their job and name.
///
///   0    "VDAGWORK"
///   8    u64 key          of the job and the file's name
///   16   u64 bytes        of the contents
///   24   u64 checksum     XXH3-64 of the contents
///   32   zeros
///   64   contents
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "voxdag/core/io/atomic_file.hpp"
#include "voxdag/core/io/checksum.hpp"
#include "voxdag/core/io/mapped_file.hpp"
#include "voxdag/core/parallel/work.hpp"

namespace voxdag {

/// Writes a file that appears under its name when commit() is called.
class WorkFileWriter {
 public:
  static constexpr std::size_t kBufferBytes = std::size_t{64} << 10;

  /// Holds `buffer_bytes` of memory. Throws Error if the file cannot be created.
  WorkFileWriter(const std::filesystem::path& path, std::uint64_t key,
                 std::size_t buffer_bytes = kBufferBytes);

  /// Throws Error.
  void write(std::span<const std::byte> bytes);
  template <class T>
  void write_value(const T& value) {
    write(std::as_bytes(std::span<const T>(&value, 1)));
  }
  template <class T>
  void write_values(std::span<const T> values) {
    write(std::as_bytes(values));
  }
  /// Returns the bytes of the contents so far.
  std::uint64_t size() const { return written_ + buffer_.size(); }
  /// Throws Error.
  void commit();

 private:
  void pass_on(std::span<const std::byte> bytes);
  void flush();

  AtomicFile file_;
  Xxh3Stream checksum_;
  std::uint64_t key_, written_ = 0;
  std::size_t buffer_bytes_;
  std::vector<std::byte> buffer_;
};

/// A complete file, mapped into memory.
class WorkFile {
 public:
  enum class Check {
    kAll,    ///< Compares the checksum of the contents.
    kHeader  ///< Trusts the contents: another rank or step has checked them.
  };

  /// Opens a file and checks it. Returns nothing if there is no file of this name, or if it is not
  /// complete, damaged or from another job. Throws Cancelled.
  static std::optional<WorkFile> open(const std::filesystem::path& path, std::uint64_t key,
                                      Work work, Check check = Check::kAll);

  /// Returns the contents, aligned to 64 bytes.
  std::span<const std::byte> bytes() const;
  /// Returns the contents as values; their size must be a multiple of the size of T.
  template <class T>
  std::span<const T> values() const {
    return {reinterpret_cast<const T*>(bytes().data()), bytes().size() / sizeof(T)};
  }
  /// Drops the resident pages of the contents before byte `end`. Thread-safe.
  void release(std::size_t end) const;

 private:
  explicit WorkFile(MappedFile file) : file_(std::move(file)) {}

  MappedFile file_;
};

}  // namespace voxdag

#pragma once
/// An output file that all ranks write, and that appears under its name only when it is complete.
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>

#include "voxdag/cluster/ranks.hpp"

namespace voxdag {

class NamedOutput;

/// Rank 0 creates a file of zeros under a temporary name, NAME.voxdag-PID-N, in the folder of the
/// output, which all ranks must see. commit() gives it its name, and replaces an older file of that
/// name. If rank 0's object is destroyed before, the temporary file is removed. Only regular files
/// can be written this way, no pipes or devices.
class SharedFile {
 public:
  /// Creates the file of `bytes` bytes. Collective. If any rank cannot open it, all ranks throw
  /// Error(path, "", reason).
  SharedFile(Ranks& ranks, const std::filesystem::path& path, std::uint64_t bytes);
  ~SharedFile();

  /// Writes bytes at an offset in bytes; they must end within the file. Not collective, and
  /// thread-safe. Ranks and threads must write disjoint ranges. Bytes that no rank writes are 0.
  /// Throws Error(path, "byte OFFSET", reason).
  void write_at(std::uint64_t offset, std::span<const std::byte> bytes);

  /// Ends the file and gives it its name. Collective. Nothing may be written afterwards. If it
  /// fails on any rank, all ranks throw Error(path, ...).
  void commit();

 private:
  Ranks& ranks_;
  std::filesystem::path path_;
  std::uint64_t bytes_;
  std::unique_ptr<NamedOutput> output_;  ///< On rank 0 only.
  std::unique_ptr<RankFile> file_;       ///< Null after commit().
};

}  // namespace voxdag

#pragma once
/// Opens a .vdag or .esvo file of any kind, once.
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <vector>

#include "voxdag/core/memory_budget.hpp"
#include "voxdag/file/vdag_parse.hpp"

namespace voxdag {

enum class VdagKind {
  kPlain,    ///< VdagFile reads it.
  kLong,     ///< A DAG with long pointers: LongVdagFile reads it.
  kCompact,  ///< CompactFile reads it.
  kEsvo      ///< EsvoFile reads it.
};

/// Returns the kind of the file that has these chunks.
VdagKind kind_of(const std::vector<VdagChunk>& chunks);

/// Returns the kind of a file. Reads only its chunk table, so that the file may change before
/// another function opens it. Throws Error(path, place, reason) for a file that is no container.
VdagKind vdag_kind(const std::filesystem::path& path);

/// The bytes of one file, for everything that one command asks about it. A DAG with long pointers,
/// which can be larger than memory, is mapped: no other process may change it while it is used. All
/// other files are copied (see FileCopy). Copies of this object share the bytes.
class VdagContainer {
 public:
  /// Opens the file, and reads it unless its first bytes show that it is no container. Checks
  /// nothing else. `memory` counts the copied bytes as long as an object shares them. Throws
  /// Error(path, place, reason) for a file that cannot be read, and OverMemory.
  explicit VdagContainer(const std::filesystem::path& path, MemoryBudget* memory = nullptr);

  const std::filesystem::path& path() const { return path_; }
  std::span<const std::byte> bytes() const { return bytes_; }
  /// Parses the chunk table. Throws Error(path, place, reason) for a file that is no container.
  std::vector<VdagChunk> chunks() const;
  /// Returns the kind. Throws what chunks() throws.
  VdagKind kind() const { return kind_of(chunks()); }
  /// Returns whether the file has this kind; false for a file that is no container.
  bool is(VdagKind kind) const;

 private:
  std::filesystem::path path_;
  std::shared_ptr<const void> owner_;  ///< Of the bytes.
  std::span<const std::byte> bytes_;
};

}  // namespace voxdag

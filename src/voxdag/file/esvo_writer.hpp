#pragma once
/// Writes an ESVO file block by block: no more of it need be in memory at a time.
#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "voxdag/file/esvo_metadata.hpp"
#include "voxdag/io/atomic_file.hpp"
#include "voxdag/io/checksum.hpp"
#include "voxdag/layout/esvo_directory.hpp"

namespace voxdag {

/// Chunks ESVO, EBLK, META in this order, of docs/format.md. The file appears when it is complete;
/// destroyed before finish(), it leaves nothing. Errors are Error(path, place, reason). The file
/// must be one that can seek.
class EsvoFileWriter {
 public:
  explicit EsvoFileWriter(const std::filesystem::path& path);

  /// Whole blocks.
  void append(std::span<const std::uint64_t> slots);

  /// Completes the file and returns its size in bytes. `directory` names all blocks, in order; its
  /// checksums are filled in here.
  std::uint64_t finish(std::vector<EsvoBlockEntry> directory, const EsvoMetadata& metadata);

 private:
  AtomicFile file_;
  Xxh3Stream checksum_;
  std::uint64_t slots_ = 0;
  std::vector<std::uint64_t> block_checksums_;
};

}  // namespace voxdag

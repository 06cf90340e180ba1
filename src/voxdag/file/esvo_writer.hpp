#pragma once
/// Writes an ESVO file block by block, so that no more than a block need be in memory.
#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "voxdag/file/esvo_metadata.hpp"
#include "voxdag/io/atomic_file.hpp"
#include "voxdag/io/checksum.hpp"
#include "voxdag/layout/esvo_directory.hpp"

namespace voxdag {

/// Writes the chunks ESVO, EBLK and META of docs/format.md, in this order. The file appears when it
/// is complete; if the writer is destroyed before finish(), nothing remains. Throws Error(path,
/// place, reason). The file must be able to seek.
class EsvoFileWriter {
 public:
  explicit EsvoFileWriter(const std::filesystem::path& path);

  /// Appends whole blocks.
  void append(std::span<const std::uint64_t> slots);

  /// Completes the file. `directory` lists all blocks, in order; finish() sets their checksums.
  /// Returns the size of the file in bytes.
  std::uint64_t finish(std::vector<EsvoBlockEntry> directory, const EsvoMetadata& metadata);

 private:
  AtomicFile file_;
  Xxh3Stream checksum_;
  std::uint64_t slots_ = 0;
  std::vector<std::uint64_t> block_checksums_;
};

}  // namespace voxdag

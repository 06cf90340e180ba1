#pragma once
/// Writes an ESVO file block by block; only one block must be in memory.
#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "voxdag/core/io/atomic_file.hpp"
#include "voxdag/core/io/checksum.hpp"
#include "voxdag/file/esvo_metadata.hpp"
#include "voxdag/stored/esvo/esvo_directory.hpp"

namespace voxdag {

/// Writes the chunks ESVO, EBLK and META of docs/format.md, in this order. The file appears when it
/// is complete; if the writer is destroyed before finish(), nothing remains. Throws Error(path,
/// place, reason). The file must be seekable.
class EsvoFileWriter {
 public:
  /// Creates the file, so that an unwritable folder is an error before the work begins.
  explicit EsvoFileWriter(const std::filesystem::path& path);

  /// Appends whole blocks.
  void append(std::span<const std::uint64_t> slots);

  /// Completes the file and returns its size in bytes. `directory` has an entry for each block, in
  /// order; finish() fills in the checksums.
  std::uint64_t finish(std::vector<EsvoBlockEntry> directory, const EsvoMetadata& metadata);

 private:
  AtomicFile file_;
  Xxh3Stream checksum_;
  std::uint64_t slots_ = 0;
  std::vector<std::uint64_t> block_checksums_;
};

}  // namespace voxdag

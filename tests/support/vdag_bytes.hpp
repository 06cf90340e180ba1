#pragma once
/// Makes .vdag files in memory, changes them, and corrects their checksums.
#include <cstddef>
#include <cstring>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "support/brute_svdag.hpp"
#include "support/temp_dir.hpp"
#include "voxdag/core/io/checksum.hpp"
#include "voxdag/file/vdag_format.hpp"
#include "voxdag/file/vdag_metadata.hpp"
#include "voxdag/file/vdag_writer.hpp"
#include "voxdag/stored/svdag/svdag_counts.hpp"

namespace voxdag {

inline VdagMetadata example_metadata(const SvdagView& view) {
  VdagMetadata metadata;
  metadata.grid.levels = view.levels;
  metadata.grid.origin = {-1.5, 0.1, 1e6};
  metadata.grid.voxel_size = 0.01;
  metadata.grid.quantization_scale = 25599.7;
  metadata.counts = count_svdag(view);
  metadata.source = {"bunny.ply", 34834, 69451};
  metadata.program = "voxdag test";
  metadata.build = {{"cover", "exact"}};
  return metadata;
}

/// Returns the bytes of the file that write_vdag() writes.
inline std::string vdag_file_bytes(const Svdag& dag, const DagAttributesView& attributes = {}) {
  const TempDir dir;
  write_vdag(dir / "file.vdag", dag.view(), example_metadata(dag.view()), attributes);
  return read_text(dir / "file.vdag");
}

/// A copy of bytes with the alignment that parse_vdag() needs.
class AlignedBytes {
 public:
  explicit AlignedBytes(const std::string& bytes) : size_(bytes.size()), words_(size_ / 8 + 1) {
    std::memcpy(words_.data(), bytes.data(), size_);
  }
  std::span<const std::byte> span() const {
    return {reinterpret_cast<const std::byte*>(words_.data()), size_};
  }

 private:
  std::size_t size_;
  std::vector<std::uint64_t> words_;
};

template <class T>
T peek(const std::string& bytes, std::size_t offset) {
  T value;
  std::memcpy(&value, bytes.data() + offset, sizeof value);
  return value;
}
template <class T>
void poke(std::string& bytes, std::size_t offset, T value) {
  std::memcpy(bytes.data() + offset, &value, sizeof value);
}

inline std::size_t entry_offset(std::size_t index) {
  return sizeof(VdagHeader) + index * sizeof(VdagChunkEntry);
}

/// Returns the directory's entry of a chunk, which the file must have.
inline VdagChunkEntry find_entry(const std::string& bytes, std::uint32_t id) {
  for (std::size_t i = 0;; ++i) {
    const auto entry = peek<VdagChunkEntry>(bytes, entry_offset(i));
    if (entry.id == id) return entry;
  }
}

/// Corrects every checksum that can be corrected, so that tests reach the checks after them.
inline void repair_checksums(std::string& bytes) {
  if (bytes.size() < sizeof(VdagHeader)) return;
  const auto header = peek<VdagHeader>(bytes, 0);
  if (header.chunk_count > bytes.size() / sizeof(VdagChunkEntry)) return;
  const std::size_t table_end = entry_offset(header.chunk_count);
  if (table_end > bytes.size()) return;
  const auto checksum = [&](std::size_t offset, std::size_t length) {
    return xxh3_64(std::as_bytes(std::span(bytes.data() + offset, length)));
  };
  for (std::size_t i = 0; i < header.chunk_count; ++i) {
    const auto entry = peek<VdagChunkEntry>(bytes, entry_offset(i));
    if (entry.offset > bytes.size() || entry.length > bytes.size() - entry.offset) continue;
    poke(bytes, entry_offset(i) + offsetof(VdagChunkEntry, checksum),
         checksum(entry.offset, entry.length));
  }
  poke(bytes, offsetof(VdagHeader, checksum), std::uint64_t{0});
  poke(bytes, offsetof(VdagHeader, checksum), checksum(0, table_end));
}

}  // namespace voxdag

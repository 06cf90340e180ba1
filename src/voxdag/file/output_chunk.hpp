#pragma once
/// A chunk that a writer puts into a .vdag file.
#include <cstdint>
#include <span>
#include <vector>

#include "voxdag/core/io/checksum.hpp"
#include "voxdag/file/vdag_format.hpp"

namespace voxdag {

/// The bytes of a chunk, in parts that follow each other. Refers to them.
struct OutputChunk {
  std::uint32_t id = 0;
  std::uint32_t flags = 0;  ///< See VdagChunkEntry.
  std::vector<std::span<const std::byte>> parts;

  std::uint64_t length() const {
    std::uint64_t sum = 0;
    for (const auto& part : parts) sum += part.size();
    return sum;
  }
  std::uint64_t checksum() const {
    Xxh3Stream stream;
    for (const auto& part : parts) stream.add(part);
    return stream.digest();
  }
};

/// Returns a chunk that a reader must know, with these bytes.
inline OutputChunk required_chunk(std::uint32_t id, std::span<const std::byte> bytes) {
  return {id, kVdagChunkRequired, {bytes}};
}

}  // namespace voxdag

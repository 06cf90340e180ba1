#pragma once
/// The chunks WCOL, WNRM and WMTI: the chunks COLR, NRML and MTID in the wire form (stored/wire/).
///
///   0    WireHeader       64 bytes
///   64   wire::WireSegment[]    of the number of pages
///        the coded bytes, zeros up to a multiple of 8
#include <vector>

#include "voxdag/file/output_chunk.hpp"
#include "voxdag/file/vdag_container.hpp"
#include "voxdag/stored/wire/wire_values.hpp"

namespace voxdag {

struct WireHeader {
  std::uint32_t parameter;  ///< ValuePagesHeader::precision or MaterialIdsHeader::materials.
  std::uint32_t reserved;   ///< Zero.
  std::uint64_t values;
  std::uint64_t words;
  std::uint64_t coded_bytes;
  std::uint64_t padding[4];  ///< Zero.
};
static_assert(sizeof(WireHeader) == 64 && sizeof(wire::WireSegment) == 16);

/// The pages of a wire chunk have at most so many times its bytes, so that the memory of a reader
/// follows from the size of the file. A writer keeps the chunk of smaller pages as it is.
inline constexpr std::uint64_t kMaxWireExpansion = 64;

/// A chunk in the wire form, for a writer. Owns its bytes.
class WireChunk {
 public:
  /// Encode the pages.
  WireChunk(const ValuePagesView& pages, wire::ValueKind kind);
  explicit WireChunk(const MaterialIdsView& pages);

  /// Returns the chunk, which refers to this object.
  OutputChunk chunk() const;
  /// Returns whether a reader accepts it: see kMaxWireExpansion.
  bool is_allowed() const;

 private:
  WireChunk(std::uint32_t id, std::uint32_t parameter, const CellPagesView& pages,
            wire::WireValues values);

  std::uint32_t id_;
  WireHeader header_{};
  wire::WireValues values_;
};

bool has_wire_chunk(const std::vector<VdagChunk>& chunks);

/// Replaces each chunk in the wire form by the chunk that it stands for, whose bytes are in
/// `memory`. Checks everything but the contents of pages. Throws Error, whose place begins with the
/// chunk.
void expand_wire_chunks(std::vector<VdagChunk>& chunks, ExpandedChunks& memory);

/// The bytes of a file's chunks in the wire form; 0 where it has none.
struct WireBytes {
  std::uint64_t colors = 0, normals = 0, materials = 0;
  std::uint64_t expanded = 0;  ///< What expand_wire_chunks() takes for them.
};

/// Reads their headers only. Throws Error(path, place, reason).
WireBytes wire_bytes_of(const VdagContainer& file);

}  // namespace voxdag

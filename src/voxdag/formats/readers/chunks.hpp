#pragma once
/// Splits a file into chunks that threads parse independently. The reported error is the first one
/// in the file, not the first one that a thread finds.
#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "voxdag/core/parallel/parallel_for.hpp"
#include "voxdag/formats/readers/mesh_source.hpp"
#include "voxdag/formats/readers/text_scan.hpp"

namespace voxdag {

inline constexpr std::size_t kChunkBytes = std::size_t{1} << 20;

/// The message if the file's contents differ between two passes of a reader.
inline constexpr const char* kFileChanged = "the file changed while it was read";

/// A text in chunks of whole lines, of about `chunk_bytes` each. A line that ends with a backslash
/// goes on in the next line, so no chunk ends there. The chunks depend on the text alone.
struct LineChunks {
  std::string_view text;
  char line_end = '\n';
  std::size_t chunk_bytes = kChunkBytes;

  std::size_t count() const { return text.size() / chunk_bytes + 1; }
  /// Returns the lines of chunk `i`: those that begin after byte i * chunk_bytes, and not after
  /// byte (i + 1) * chunk_bytes. Chunk 0 also has the first line.
  std::string_view operator[](std::size_t i) const;
  std::vector<std::string_view> all() const;
};

/// A value for `line_end`: the file is binary, and errors name the byte.
inline constexpr char kNoLines = '\0';

/// A fault at `position`, which points into the file's bytes.
struct Fault {
  const char* position;
  std::string reason;
};

/// Throws the fault as an Error that names its line or byte in `source.bytes`.
[[noreturn]] void throw_fault(const MeshSource& source, const Fault& fault, char line_end);

/// Runs body(i) for every chunk in parallel and releases the chunk's pages. A body reports bad
/// input by throwing Fault. Returns the fault of the earliest chunk. Throws Cancelled.
template <class Body>
std::optional<Fault> find_fault(const MeshSource& source,
                                const std::vector<std::string_view>& chunks, std::string_view stage,
                                const Body& body) {
  std::vector<std::optional<Fault>> faults(chunks.size());
  parallel_for(chunks.size(), [&](std::size_t i) {
    try {
      body(i);
    } catch (Fault& fault) {
      faults[i] = std::move(fault);
    }
    source.done_with(chunks[i], stage);
  });
  for (const auto& fault : faults)
    if (fault) return fault;
  return std::nullopt;
}

/// Runs find_fault() and throws its fault as an Error.
template <class Body>
void for_each_chunk(const MeshSource& source, const std::vector<std::string_view>& chunks,
                    char line_end, std::string_view stage, const Body& body) {
  if (const auto fault = find_fault(source, chunks, stage, body))
    throw_fault(source, *fault, line_end);
}

}  // namespace voxdag

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

/// Splits `text` into chunks of whole lines, of about `chunk_bytes` each. Does not split after a
/// line that ends with a backslash. The chunks depend on the text alone.
std::vector<std::string_view> split_lines(std::string_view text, char line_end,
                                          std::size_t chunk_bytes = kChunkBytes);

/// Returns where the line that holds byte `at` of the text ends, after its line end. A line that
/// ends with a backslash goes on. Returns the text's size if `at` is beyond it.
std::size_t end_of_line(std::string_view text, std::size_t at, char line_end);

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
/// input by throwing Fault; throws the fault of the earliest chunk as an Error. Throws Cancelled.
template <class Body>
void for_each_chunk(const MeshSource& source, const std::vector<std::string_view>& chunks,
                    char line_end, std::string_view stage, const Body& body) {
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
    if (fault) throw_fault(source, *fault, line_end);
}

}  // namespace voxdag

#pragma once
/// A file cut into chunks that threads parse on their own, and how their faults are told: the first
/// one in the file, whatever thread met it first.
#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "voxdag/parallel/parallel_for.hpp"
#include "voxdag/readers/mesh_source.hpp"
#include "voxdag/readers/text_scan.hpp"

namespace voxdag {

inline constexpr std::size_t kChunkBytes = std::size_t{1} << 20;

/// Cuts `text` into runs of whole lines of about `chunk_bytes`. No cut follows a backslash at the
/// end of a line. The cuts depend on the text alone.
std::vector<std::string_view> split_lines(std::string_view text, char line_end,
                                          std::size_t chunk_bytes = kChunkBytes);

/// In place of a line end: the file is binary, and faults are told by their byte.
inline constexpr char kBinary = '\0';

/// Something wrong at `position`, which points into the file's bytes.
struct Fault {
  const char* position;
  std::string reason;
};

/// Throws the fault as an Error that names its line (or byte) from the start of `source.bytes`.
[[noreturn]] void throw_fault(const MeshSource& source, const Fault& fault, char line_end);

/// Runs body(i) for every chunk in parallel and lets the chunk's pages go. A body reports bad input
/// by throwing Fault; the fault of the earliest chunk is then thrown as an Error.
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

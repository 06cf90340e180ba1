#pragma once
/// URIs of glTF buffers and images.
#include <optional>
#include <string>
#include <string_view>

#include "voxdag/core/memory_budget.hpp"

namespace voxdag {

/// Returns a relative URI as the path of a file: resolves "%20" and the like.
std::string decode_percent(std::string_view uri);

/// Bytes that a `data:` URI holds.
struct DecodedUri {
  MemoryReservation memory;
  std::string bytes;
};

/// Decodes a `data:` URI. Returns nothing if it is malformed. Throws OverMemory.
std::optional<DecodedUri> decode_data_uri(std::string_view uri, MemoryBudget* memory);

}  // namespace voxdag

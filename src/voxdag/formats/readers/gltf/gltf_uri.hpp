#pragma once
/// URIs of glTF buffers and images.
#include <optional>
#include <string>
#include <string_view>

#include "voxdag/core/memory_budget.hpp"
#include "voxdag/core/parallel/work.hpp"

namespace voxdag {

/// Returns a relative URI as the path of a file: resolves "%20" and the like. Throws Cancelled.
std::string decode_percent(std::string_view uri, Work work = {});

/// The bytes of a `data:` URI.
struct DecodedUri {
  MemoryReservation memory;
  std::string bytes;
};

/// Decodes a `data:` URI. Returns nothing if it is malformed. Throws OverMemory and Cancelled.
std::optional<DecodedUri> decode_data_uri(std::string_view uri, Work work);

}  // namespace voxdag

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

/// Returns whether a URI begins with `data:`, in any letter case.
bool is_data_uri(std::string_view uri);

/// Decodes a `data:` URI. It is base64 if its last parameter is `base64`, in any letter case, with
/// blanks around it or without a semicolon before it; blanks and line ends in base64 do not count.
/// Returns nothing if it is malformed. Throws OverMemory and Cancelled.
std::optional<DecodedUri> decode_data_uri(std::string_view uri, Work work);

}  // namespace voxdag

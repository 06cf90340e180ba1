#pragma once
/// Buffer views of EXT_meshopt_compression, decoded by meshoptimizer.
#include <string_view>

#include "voxdag/core/memory_budget.hpp"
#include "voxdag/formats/readers/gltf/gltf_value.hpp"

namespace voxdag {

/// Returns the bytes of a buffer view that the extension `packed` describes; `bytes` are those that
/// it refers to. Throws Error, and OverMemory before it decodes.
CountedVector<char> decode_meshopt(const GltfValue& packed, std::string_view bytes,
                                   MemoryBudget* memory);

}  // namespace voxdag

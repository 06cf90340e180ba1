#pragma once
/// XXH3-64 (Yann Collet's xxHash), seed 0, of a run of bytes.
#include <cstddef>
#include <cstdint>
#include <span>

namespace voxdag {

std::uint64_t xxh3_64(std::span<const std::byte> bytes);

}  // namespace voxdag

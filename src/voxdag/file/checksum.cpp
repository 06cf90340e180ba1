#include "voxdag/file/checksum.hpp"

// The header-only form, so that an installed voxdag needs no libxxhash beside it.
#define XXH_INLINE_ALL
#include <xxhash.h>

namespace voxdag {

std::uint64_t xxh3_64(std::span<const std::byte> bytes) {
  return XXH3_64bits(bytes.data(), bytes.size());
}

}  // namespace voxdag

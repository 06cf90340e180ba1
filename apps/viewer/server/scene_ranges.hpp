#pragma once
/// The ranges of a request for the scene.
#include <sys/types.h>

#include <cstdint>
#include <utility>
#include <vector>

namespace voxdag {

/// First and last byte. In a request of the HTTP library, -1 is a byte that the client left out.
using ByteRange = std::pair<ssize_t, ssize_t>;

/// Makes the ranges explicit for a content of `size` bytes: 0 <= first <= last < size. Removes the
/// ranges behind its end. Returns false if no range is left, or if all together have more than
/// `size` bytes.
bool resolve_ranges(std::vector<ByteRange>& ranges, std::uint64_t size);

}  // namespace voxdag

#pragma once
/// The ranges of a request for the scene.
#include <sys/types.h>

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace voxdag {

/// First and last byte, as the HTTP library gives them: -1 if the client left one out.
using ByteRange = std::pair<ssize_t, ssize_t>;

/// Makes ranges explicit for a content of `size` bytes: 0 <= first <= last < size. Leaves out those
/// that lie behind its end. Returns false if none is left, or if they have more than `size` bytes
/// together.
bool resolve_ranges(std::vector<ByteRange>& ranges, std::uint64_t size);

/// Returns whether the list of entity tags of If-None-Match has `tag` (with its quotation marks),
/// or is "*". A weak tag of the list matches too.
bool has_tag(std::string_view list, std::string_view tag);

}  // namespace voxdag

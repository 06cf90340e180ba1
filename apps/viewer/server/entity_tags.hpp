#pragma once
/// Entity tags (RFC 9110, section 8.8.3): texts in quotation marks that differ for different bytes.
#include <string>
#include <string_view>

namespace voxdag {

/// Returns `tag` in quotation marks.
std::string quoted_tag(std::string_view tag);

/// Returns an entity tag made from a checksum of `bytes`.
std::string tag_of(std::string_view bytes);

/// Returns whether `list`, the value of If-None-Match, names the entity tag `tag` or is "*". A weak
/// tag of the list matches, too.
bool has_tag(std::string_view list, std::string_view tag);

}  // namespace voxdag

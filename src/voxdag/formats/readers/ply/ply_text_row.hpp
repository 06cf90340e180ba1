#pragma once
/// Parses a row of an ascii PLY file.
#include <cstdint>
#include <string>
#include <string_view>

#include "voxdag/formats/readers/chunks.hpp"
#include "voxdag/formats/readers/ply/ply_header.hpp"
#include "voxdag/formats/readers/text_scan.hpp"

namespace voxdag {

/// Removes the values of one property from a row and calls on_item(token) for each. Throws Fault,
/// Cancelled.
template <class OnItem>
void take_ply_property(std::string_view& row, const PlyProperty& property, CancelPoll& poll,
                       const OnItem& on_item) {
  const auto token = [&] {
    const std::string_view text = next_token(row);
    if (text.empty())
      throw Fault{row.data(), "the row ends before property " + in_quotes(property.name)};
    return text;
  };
  std::int64_t items = 1;
  if (property.count_type) {
    const std::string_view count = token();
    if (!parse_int(count, items) || items < 0)
      throw Fault{row.data(),
                  "list count " + in_quotes(count) + " is not a whole number of 0 or more"};
  }
  for (; items > 0; --items) {
    poll.step();
    on_item(token());
  }
}

/// Throws Fault if the row has values after its last property.
inline void check_ply_row_end(std::string_view row) {
  const std::string_view extra = next_token(row);
  if (!extra.empty())
    throw Fault{extra.data(), "the row has " + in_quotes(extra) + " after its last property"};
}

}  // namespace voxdag

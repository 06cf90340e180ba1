#pragma once
/// The values of the vertex and face lines of an OBJ file.
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "voxdag/core/vec.hpp"
#include "voxdag/formats/readers/chunks.hpp"
#include "voxdag/formats/readers/text_scan.hpp"

namespace voxdag {

/// Returns the index of the vertex that a corner (`v`, `v/vt`, `v//vn` or `v/vt/vn`) names. `seen`
/// vertices precede the line in the file, `total` are in the file. Throws Fault.
inline std::uint32_t parse_vertex_index(std::string_view corner, std::size_t seen,
                                        std::size_t total, const char* position) {
  const std::string_view reference = corner.substr(0, corner.find('/'));
  std::int64_t index = 0;
  if (!parse_int(reference, index) || corner.find_first_not_of("0123456789+-/") != corner.npos)
    throw Fault{position, "face corner " + in_quotes(corner) + " is not a vertex index"};
  if (index < 0 && static_cast<std::uint64_t>(-(index + 1)) < seen)
    return static_cast<std::uint32_t>(seen - static_cast<std::uint64_t>(-(index + 1)) - 1);
  if (index > 0 && static_cast<std::uint64_t>(index) <= total)
    return static_cast<std::uint32_t>(index - 1);
  const bool relative = index < 0;
  throw Fault{position, "vertex index " + std::to_string(index) +
                            " is out of range: " + std::to_string(relative ? seen : total) +
                            (relative ? " vertices so far" : " vertices")};
}

/// Removes three coordinates from a line. Throws Fault.
inline Vec3f take_vertex(std::string_view& numbers, const char* position) {
  Vec3f vertex;
  for (int axis = 0; axis < 3; ++axis) {
    const std::string_view token = next_token(numbers);
    if (token.empty()) throw Fault{position, "the vertex has fewer than three coordinates"};
    if (!parse_float(token, vertex[axis]))
      throw Fault{position, "coordinate " + in_quotes(token) + " is not a number"};
  }
  return vertex;
}

}  // namespace voxdag

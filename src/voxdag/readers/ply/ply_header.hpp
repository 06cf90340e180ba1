#pragma once
/// The header of a PLY file (Greg Turk, The PLY Polygon File Format, 1994).
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "voxdag/readers/mesh_bytes.hpp"

namespace voxdag {

enum class PlyType : std::uint8_t {
  kInt8,
  kUint8,
  kInt16,
  kUint16,
  kInt32,
  kUint32,
  kFloat,
  kDouble
};

constexpr std::size_t size_of(PlyType type) {
  constexpr std::size_t sizes[] = {1, 1, 2, 2, 4, 4, 4, 8};
  return sizes[static_cast<int>(type)];
}
constexpr bool is_integer(PlyType type) { return type < PlyType::kFloat; }

struct PlyProperty {
  std::string name;
  PlyType type;                       ///< Of the value, or of each item of the list.
  std::optional<PlyType> count_type;  ///< Of the number of items, where this is a list.
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;

  /// Index of the property that has one of the names, or -1.
  int find(std::initializer_list<std::string_view> names) const;
  /// The least number of bytes that a row takes in a binary file.
  std::size_t least_row_bytes() const;
};

enum class PlyFormat : std::uint8_t { kAscii, kLittleEndian, kBigEndian };

struct PlyHeader {
  PlyFormat format = PlyFormat::kAscii;
  char line_end = '\n';  ///< Of the header, and of the body if that is text.
  std::vector<PlyElement> elements;
  std::vector<std::string> materials;  ///< From comments `material NUMBER NAME`, numbered from 0.
  std::vector<std::string> textures;   ///< From comments `TextureFile NAME`.
  std::size_t body = 0;                ///< Offset of the first byte after the header.

  int vertex = -1;  ///< Index of element `vertex`; after parse_ply_header always in range.
  int face = -1;    ///< Index of element `face`; after parse_ply_header always in range.
};

/// Parses and checks the header: every line is known, there are vertices with x, y and z and faces
/// with a list of integer indices, and the file is long enough for the least size that the counts
/// imply. Throws Error with the line.
PlyHeader parse_ply_header(const MeshBytes& source);

}  // namespace voxdag

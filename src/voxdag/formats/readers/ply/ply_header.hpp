#pragma once
/// The header of a PLY file (Greg Turk, The PLY Polygon File Format, 1994).
#include <array>
#include <bit>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "voxdag/formats/readers/mesh_source.hpp"

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

/// Names are views into the file.
struct PlyProperty {
  std::string_view name;
  PlyType type;                       ///< Type of the value, or of the items of a list.
  std::optional<PlyType> count_type;  ///< Type of a list's item count. None: not a list.
};

struct PlyElement {
  std::string_view name;
  std::uint64_t count = 0;  ///< Number of rows.
  CountedVector<PlyProperty> properties;

  /// Returns the index of the property that has one of the names, or -1. If none has one as it is,
  /// capitals do not matter.
  int find(std::initializer_list<std::string_view> names) const;
  /// Returns the minimum number of bytes of a row in a binary file.
  std::size_t least_row_bytes() const;
};

enum class PlyFormat : std::uint8_t { kAscii, kLittleEndian, kBigEndian };

struct PlyHeader {
  PlyFormat format = PlyFormat::kAscii;
  std::string_view version;  ///< If it is 1.x, but not 1.0.
  char line_end = '\n';      ///< Ends the lines of the header, and of a body of text.
  std::vector<PlyElement> elements;
  CountedVector<std::string_view> materials;  ///< Comments `material NUMBER NAME`, by number.
  CountedVector<std::string_view> textures;   ///< Comments `TextureFile NAME`.
  /// Faces name one of several textures. Then `materials` are the textures, and one without a name.
  bool has_texture_numbers = false;
  bool has_strips = false;  ///< `face` is element `tristrips`: lists of strips, which -1 separates.
  std::size_t body = 0;     ///< Offset of the first byte after the header.

  /// Returns whether the bytes of values are in another order than this machine's.
  bool swaps_bytes() const {
    return (format == PlyFormat::kBigEndian) != (std::endian::native == std::endian::big);
  }

  int vertex = -1;  ///< Index of element `vertex`; always in range after parse_ply_header().
  int face = -1;    ///< Index of element `face` or `tristrips`; in range if the use is kMesh.
};

/// The parts of a file that a reader wants.
enum class PlyUse : std::uint8_t {
  kMesh,   ///< Vertices and faces.
  kPoints  ///< Vertices; the file may have faces, strips or other elements.
};

/// Parses the header and checks it: every line is known, vertices have x, y and z (points may have
/// packed_position instead), and the file is at least as long as the counts imply. A mesh also
/// needs faces with a list of integer indices and at most 2^32 - 2 vertices. Throws Error with the
/// line, OverMemory.
PlyHeader parse_ply_header(const MeshSource& source, PlyUse use = PlyUse::kMesh);

/// The elements and the indices of the properties that belong to the mesh. `header` must outlive
/// it.
struct PlyFields {
  explicit PlyFields(const PlyHeader& header)
      : vertex(header.elements[header.vertex]),
        face(header.elements[header.face]),
        axes{vertex.find({"x"}), vertex.find({"y"}), vertex.find({"z"})},
        indices(face.find({"vertex_indices", "vertex_index"})),
        material(header.materials.empty()
                     ? -1
                     : face.find({header.has_texture_numbers ? "texnumber" : "material_index"})) {
    if (material >= 0) {
      const PlyProperty& property = face.properties[material];
      if (property.count_type || !is_integer(property.type)) material = -1;
    }
  }

  const PlyElement& vertex;
  const PlyElement& face;
  std::array<int, 3> axes;
  int indices;
  int material;  ///< -1: the file has no materials.
};

}  // namespace voxdag

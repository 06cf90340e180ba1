#pragma once
/// Counts the statements of an OBJ file, chunk by chunk: the first pass of the reader.
#include <cstdint>
#include <string_view>

#include "voxdag/formats/readers/mesh_source.hpp"
#include "voxdag/formats/readers/name_table.hpp"
#include "voxdag/formats/readers/obj/obj_lines.hpp"

namespace voxdag {

enum class ObjStatement { kVertex, kUv, kNormal, kFace, kMaterial, kLibrary, kOther };

/// Removes the keyword from a line, which must not start with a blank, and returns the statement
/// that it stands for.
inline ObjStatement take_keyword(std::string_view& line) {
  const std::string_view keyword = next_token(line);
  if (keyword == "v") return ObjStatement::kVertex;
  if (keyword == "f") return ObjStatement::kFace;
  if (keyword == "vt") return ObjStatement::kUv;
  if (keyword == "vn") return ObjStatement::kNormal;
  if (keyword == "usemtl") return ObjStatement::kMaterial;
  if (keyword == "mtllib") return ObjStatement::kLibrary;
  return ObjStatement::kOther;
}

struct ObjCounts {
  std::size_t vertices = 0, uvs = 0, normals = 0, triangles = 0;

  ObjCounts& operator+=(const ObjCounts& other) {
    vertices += other.vertices;
    uvs += other.uvs;
    normals += other.normals;
    triangles += other.triangles;
    return *this;
  }
};

struct ObjChunk {
  /// Counts the statements of `text`, which is part of `source`.
  ObjChunk(const MeshSource& source, std::string_view text, char line_end);

  ObjCounts counts;
  NameTable materials, libraries;   ///< Arguments of `usemtl` and `mtllib`.
  std::uint32_t last_material = 0;  ///< Index into `materials` of the last `usemtl`.
  bool faces_before_material = false;
  bool has_colors = false;  ///< Some vertex has six numbers.
};

/// Returns the number of triangles in the fan of a face line.
std::size_t count_fan_triangles(std::string_view corners, CancelPoll& poll);

}  // namespace voxdag

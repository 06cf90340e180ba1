#pragma once
/// The three passes over an OBJ file: statements are counted, vertices read, faces read. Each pass
/// takes the chunks in any order, and several at a time.
#include <cstdint>
#include <span>
#include <string_view>

#include "voxdag/core/memory_budget.hpp"
#include "voxdag/formats/readers/face_writer.hpp"
#include "voxdag/formats/readers/mesh_source.hpp"
#include "voxdag/formats/readers/name_table.hpp"
#include "voxdag/formats/readers/obj/obj_lines.hpp"

namespace voxdag {

class ObjAttributes;
struct ObjReferences;

enum class ObjStatement {
  kVertex,
  kUv,
  kNormal,
  kFace,
  kMaterial,
  kLibrary,
  kObject,
  kGroup,
  kOther
};

/// Removes the keyword from a line, which must not start with a blank, and returns the statement
/// that it stands for.
inline ObjStatement take_keyword(std::string_view& line) {
  // Most lines have one of four short keywords. These are found without a search for their end.
  const auto is_short = [&line](std::string_view keyword) {
    if (!line.starts_with(keyword)) return false;
    if (line.size() > keyword.size() && !is_blank(line[keyword.size()])) return false;
    line.remove_prefix(keyword.size());
    return true;
  };
  if (is_short("v")) return ObjStatement::kVertex;
  if (is_short("f")) return ObjStatement::kFace;
  if (is_short("vt")) return ObjStatement::kUv;
  if (is_short("vn")) return ObjStatement::kNormal;
  const std::string_view keyword = next_token(line);
  if (keyword == "usemtl") return ObjStatement::kMaterial;
  if (keyword == "mtllib") return ObjStatement::kLibrary;
  if (keyword == "o") return ObjStatement::kObject;
  if (keyword == "g") return ObjStatement::kGroup;
  return ObjStatement::kOther;
}

/// Returns whether a statement defines a vertex, texture coordinate or normal.
inline bool is_value(ObjStatement statement) { return statement <= ObjStatement::kNormal; }

struct ObjCounts {
  std::size_t vertices = 0, uvs = 0, normals = 0, triangles = 0;

  ObjCounts& operator+=(const ObjCounts& other) {
    vertices += other.vertices;
    uvs += other.uvs;
    normals += other.normals;
    triangles += other.triangles;
    return *this;
  }
  /// Returns these counts with the values of others added, and the same triangles.
  ObjCounts with_values(const ObjCounts& more) const {
    return {vertices + more.vertices, uvs + more.uvs, normals + more.normals, triangles};
  }
  /// Counts the value that a statement defines, if it defines one.
  void add_value(ObjStatement statement) {
    vertices += statement == ObjStatement::kVertex;
    uvs += statement == ObjStatement::kUv;
    normals += statement == ObjStatement::kNormal;
  }
};

/// Neighbouring lines of a chunk without values (`v`, `vt`, `vn`), or without faces and materials.
struct ObjRun {
  std::string_view text;
  bool has_values = true;
  ObjCounts before;  ///< The values that precede the run in its chunk.
};

/// A statement `o` or `g` of a chunk.
struct ObjPart {
  std::uint64_t first_triangle = 0;
  std::uint32_t name = 0;  ///< Index into ObjChunk::objects.
  bool is_group = false;
};

/// The contents of a chunk.
struct ObjChunk {
  explicit ObjChunk(MemoryBudget* memory)
      : materials(memory), libraries(memory), objects(memory), parts(memory), runs(memory) {}

  ObjCounts counts;
  NameTable materials, libraries;   ///< Arguments of `usemtl` and `mtllib`.
  NameTable objects;                ///< Arguments of `o` and `g`, if they are read.
  CountedVector<ObjPart> parts;     ///< Where each begins.
  std::uint32_t last_material = 0;  ///< Index into `materials` of the last `usemtl`.
  bool has_faces = false, has_faces_before_material = false;
  bool has_colors = false;     ///< Some vertex has six numbers.
  CountedVector<ObjRun> runs;  ///< In order. None if there would be more than kMaxRuns.

  /// A chunk whose values and faces alternate more often is read as a whole.
  static constexpr std::size_t kMaxRuns = 1024;
};

/// An OBJ file in chunks. All functions throw Fault at malformed lines, OverMemory and Cancelled.
class ObjFile {
 public:
  /// `source` must outlive the file.
  ObjFile(const MeshSource& source, std::size_t chunk_bytes);

  const LineChunks& chunks() const { return chunks_; }
  char line_end() const { return chunks_.line_end; }

  /// Looks for colours of vertices only if the appearance is wanted.
  ObjChunk count(std::string_view chunk, ReadParts parts) const;
  /// Reads the vertices of a chunk. If `attributes` is not null, also reads colours, texture
  /// coordinates and normals; `seen` counts what precedes the chunk.
  void read_vertices(std::string_view chunk, std::span<Vec3f> vertices, ObjCounts seen,
                     ObjAttributes* attributes) const;
  /// Calls body(statement, the rest of its line, start of its line in the file) for each statement.
  template <class Body>
  void for_each_statement(std::string_view chunk, const Body& body) const {
    for_each_line(chunk, line_end(), source_.work().memory,
                  [&](std::string_view line, const char* position) {
                    const ObjStatement statement = take_keyword(line);
                    body(statement, line, position);
                  });
  }

 private:
  const MeshSource& source_;
  LineChunks chunks_;
};

/// Reads the faces of a chunk, one after the other: the third pass, when all vertices are known.
class ObjFaces {
 public:
  /// Writes to `triangles`. If `attributes` is not null, also sets the references of the triangles.
  ObjFaces(const MeshSource& source, const AllVertices& vertices, std::span<Triangle> triangles,
           ObjAttributes* attributes);

  /// Reads a face line that starts at `position` in the file. `seen` counts what precedes it.
  /// Returns the number of triangles. Throws Fault, Error, OverMemory, Cancelled.
  std::size_t read(std::string_view line, const char* position, const ObjCounts& seen);
  /// Throws Error if some triangles are not written.
  void check_full() const { writer_.check_full(); }

 private:
  const AllVertices& vertices_;
  ObjAttributes* attributes_;
  FaceWriter writer_;
  CountedVector<ObjReferences> references_;  ///< Of the corners of the face.
};

}  // namespace voxdag

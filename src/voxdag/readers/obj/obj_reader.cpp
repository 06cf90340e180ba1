/// OBJ in two passes over chunks of whole lines, both parallel: the first counts what each chunk
/// holds, so that the second can parse straight into its place in arrays of the exact size.
#include "voxdag/readers/obj/obj_reader.hpp"

#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "voxdag/mesh/polygon.hpp"
#include "voxdag/readers/chunks.hpp"
#include "voxdag/readers/obj/obj_lines.hpp"

namespace voxdag {
namespace {

constexpr std::uint32_t kNoMaterial = std::numeric_limits<std::uint32_t>::max();

/// What one chunk holds, then where that starts in the mesh.
struct Chunk {
  std::size_t vertices = 0, triangles = 0;
  std::size_t first_vertex = 0, first_triangle = 0;
  std::uint32_t material = kNoMaterial;  ///< In force at the start of the chunk.
  bool faces_before_material = false;
  bool not_finite = false;         ///< A vertex of the chunk is NaN or infinite.
  std::vector<bool> is_same_face;  ///< Triangles of the face of the one before, if there are any.
  std::vector<std::string> materials;  ///< Distinct, in the order of first appearance.
  std::set<std::string, std::less<>> known_materials;
  std::string last_material;
};

enum class Statement { kVertex, kFace, kMaterial, kOther };

/// What a line, which is not empty and starts with no blank, states; leaves its arguments in
/// `line`.
Statement take_keyword(std::string_view& line) {
  const std::size_t size = line.starts_with("usemtl") ? 6 : 1;
  if (line.size() > size && !is_blank(line[size])) return Statement::kOther;
  const char first = line.front();
  line.remove_prefix(size);
  if (size == 6) return Statement::kMaterial;
  return first == 'v' ? Statement::kVertex : first == 'f' ? Statement::kFace : Statement::kOther;
}

/// Index of the vertex that a corner (`v`, `v/vt`, `v//vn` or `v/vt/vn`) names. `seen` vertices
/// precede the line in the file; `total` are in the file.
std::uint32_t parse_corner(std::string_view corner, std::size_t seen, std::size_t total,
                           const char* position) {
  const std::string_view reference = corner.substr(0, corner.find('/'));
  std::int64_t index = 0;
  if (!parse_int(reference, index) || corner.find_first_not_of("0123456789+-/") != corner.npos)
    throw Fault{position, "face corner " + in_quotes(corner) + " is not an index"};
  if (index < 0 && static_cast<std::uint64_t>(-(index + 1)) < seen)
    return static_cast<std::uint32_t>(seen - static_cast<std::uint64_t>(-(index + 1)) - 1);
  if (index > 0 && static_cast<std::uint64_t>(index) <= total)
    return static_cast<std::uint32_t>(index - 1);
  const bool relative = index < 0;
  throw Fault{position, "vertex index " + std::to_string(index) +
                            " is out of range: " + std::to_string(relative ? seen : total) +
                            (relative ? " vertices so far" : " vertices")};
}

Vec3f parse_vertex(std::string_view numbers, const char* position) {
  Vec3f vertex;
  for (int axis = 0; axis < 3; ++axis) {
    const std::string_view token = next_token(numbers);
    if (token.empty()) throw Fault{position, "vertex with fewer than three coordinates"};
    if (!parse_float(token, vertex[axis]))
      throw Fault{position, "coordinate " + in_quotes(token) + " is not a number"};
  }
  return vertex;
}

class ObjReader {
 public:
  explicit ObjReader(const MeshBytes& source)
      : source_(source),
        line_end_(line_end_of(source.bytes)),
        texts_(split_lines(without_byte_order_mark(source.bytes), line_end_)),
        chunks_(texts_.size()) {}

  Mesh read() {
    for_each_chunk(source_, texts_, line_end_, "scan", [this](std::size_t i) { count(i); });
    place_chunks();
    for_each_chunk(source_, texts_, line_end_, "read", [this](std::size_t i) { parse(i); });
    check_finite();
    parallel_for(chunks_.size(), [this](std::size_t i) { cut_faces(chunks_[i]); });
    return std::move(mesh_);
  }

 private:
  void count(std::size_t i) {
    Chunk& chunk = chunks_[i];
    for_each_line(texts_[i], line_end_, [&](std::string_view line, const char*) {
      const Statement statement = take_keyword(line);
      if (statement == Statement::kVertex) {
        ++chunk.vertices;
      } else if (statement == Statement::kFace) {
        chunk.triangles += count_fan_triangles(line);
        chunk.faces_before_material |= chunk.materials.empty();
      } else if (statement == Statement::kMaterial) {
        const std::string_view name = trim(line);
        if (chunk.known_materials.contains(name)) {
          chunk.last_material = name;
        } else {
          chunk.last_material = chunk.materials.emplace_back(name);
          chunk.known_materials.emplace(name);
        }
      }
    });
    chunk.known_materials.clear();
  }

  /// Turns the counts of the chunks into places in the mesh, and makes room there.
  void place_chunks() {
    std::size_t vertices = 0, triangles = 0;
    std::uint32_t material = kNoMaterial;
    for (Chunk& chunk : chunks_) {
      chunk.first_vertex = vertices;
      chunk.first_triangle = triangles;
      vertices += chunk.vertices;
      triangles += chunk.triangles;
      if (material == kNoMaterial && chunk.faces_before_material)
        material = material_id("");  // The faces before any usemtl; unused if there is none.
      chunk.material = material;
      for (const auto& name : chunk.materials) material_id(name);
      if (!chunk.materials.empty()) material = material_id(chunk.last_material);
    }
    if (triangles == 0) throw source_.error("OBJ without faces: there is no surface to read");
    if (vertices >= kNoMaterial) throw source_.error("more than 4,294,967,294 vertices");
    const bool has_materials = material_ids_.size() > material_ids_.count("");
    if (!has_materials) mesh_.materials.clear();
    mesh_.vertices.resize(vertices);
    mesh_.triangles.resize(triangles);
    if (has_materials) mesh_.triangle_materials.resize(triangles);
  }

  std::uint32_t material_id(std::string_view name) {
    const auto found = material_ids_.find(name);
    if (found != material_ids_.end()) return found->second;
    const auto id = static_cast<std::uint32_t>(mesh_.materials.size());
    material_ids_.emplace(name, id);
    mesh_.materials.emplace_back(name);
    return id;
  }

  void parse(std::size_t i) {
    Chunk& chunk = chunks_[i];
    std::size_t vertex = chunk.first_vertex, triangle = chunk.first_triangle;
    std::uint32_t material = chunk.material;
    for_each_line(texts_[i], line_end_, [&](std::string_view line, const char* position) {
      const Statement statement = take_keyword(line);
      if (statement == Statement::kVertex) {
        const Vec3f p = parse_vertex(line, position);
        chunk.not_finite |= !is_finite(p);
        mesh_.vertices[vertex++] = p;
      } else if (statement == Statement::kFace) {
        const std::size_t end = parse_face(line, position, vertex, triangle);
        if (!mesh_.triangle_materials.empty())
          std::fill(mesh_.triangle_materials.begin() + static_cast<std::ptrdiff_t>(triangle),
                    mesh_.triangle_materials.begin() + static_cast<std::ptrdiff_t>(end), material);
        if (end > triangle + 1) mark_face(chunk, triangle, end);
        triangle = end;
      } else if (statement == Statement::kMaterial) {
        material = material_ids_.find(trim(line))->second;
      }
    });
  }

  /// Writes the fan of one face from `triangle` on and returns the index after it.
  std::size_t parse_face(std::string_view corners, const char* position, std::size_t seen,
                         std::size_t triangle) {
    std::uint32_t first = 0, previous = 0;
    for (std::size_t n = 0;; ++n) {
      const std::string_view corner = next_corner(corners);
      if (corner.empty()) return triangle;
      const std::uint32_t index = parse_corner(corner, seen, mesh_.vertices.size(), position);
      if (n == 0) first = index;
      if (n >= 2) mesh_.triangles[triangle++] = {first, previous, index};
      previous = index;
    }
  }

  /// Notes that the triangles [first, end) are the fan of one face.
  static void mark_face(Chunk& chunk, std::size_t first, std::size_t end) {
    if (chunk.is_same_face.empty()) chunk.is_same_face.resize(chunk.triangles, false);
    for (std::size_t t = first + 1; t < end; ++t)
      chunk.is_same_face[t - chunk.first_triangle] = true;
  }

  /// Cuts the faces of a chunk, now that every vertex is known.
  void cut_faces(const Chunk& chunk) {
    const std::vector<bool>& is_same_face = chunk.is_same_face;
    const auto triangles = std::span(mesh_.triangles).subspan(chunk.first_triangle);
    for (std::size_t first = 0; first < is_same_face.size();) {
      std::size_t end = first + 1;
      while (end < is_same_face.size() && is_same_face[end]) ++end;
      cut_polygon(triangles.subspan(first, end - first), mesh_.vertices);
      first = end;
    }
  }

  /// Refuses a triangle with a vertex that is not finite; such vertices may stay if nothing uses
  /// them.
  void check_finite() const {
    if (std::none_of(chunks_.begin(), chunks_.end(), [](const Chunk& c) { return c.not_finite; }))
      return;
    for (const Triangle& triangle : mesh_.triangles)
      for (const std::uint32_t index : triangle)
        if (!is_finite(mesh_.vertices[index]))
          throw_fault(source_, {vertex_line(index), "vertex is not finite and a face uses it"},
                      line_end_);
  }

  /// The line of the file that defines a vertex.
  const char* vertex_line(std::size_t index) const {
    std::size_t i = chunks_.size() - 1;
    while (chunks_[i].first_vertex > index) --i;
    const char* found = nullptr;
    std::size_t vertex = chunks_[i].first_vertex;
    for_each_line(texts_[i], line_end_, [&](std::string_view line, const char* position) {
      if (take_keyword(line) == Statement::kVertex && vertex++ == index) found = position;
    });
    return found;
  }

  const MeshBytes& source_;
  const char line_end_;
  const std::vector<std::string_view> texts_;
  std::vector<Chunk> chunks_;
  std::map<std::string, std::uint32_t, std::less<>> material_ids_;
  Mesh mesh_;
};

}  // namespace

Mesh read_obj(const MeshBytes& source) {
  if (source.bytes.empty()) throw source.error("the file is empty");
  if (source.bytes.starts_with("\xFF\xFE") || source.bytes.starts_with("\xFE\xFF"))
    throw source.error("OBJ in UTF-16: save it as ASCII or UTF-8");
  return ObjReader(source).read();
}

}  // namespace voxdag

/// Makes two parallel passes over chunks of whole lines. The first counts the contents of each
/// chunk, so that the second can parse into arrays of their final size. When all vertices are
/// known, faces are cut.
#include "voxdag/formats/readers/obj/obj_reader.hpp"

#include <limits>
#include <optional>

#include "voxdag/formats/readers/bad_vertex.hpp"
#include "voxdag/formats/readers/chunks.hpp"
#include "voxdag/formats/readers/obj/obj_attributes.hpp"
#include "voxdag/formats/readers/obj/obj_materials.hpp"
#include "voxdag/formats/readers/obj/obj_values.hpp"

namespace voxdag {
namespace {

constexpr std::uint32_t kNoMaterial = std::numeric_limits<std::uint32_t>::max();

/// The start of a chunk in the mesh, and the data that the second pass leaves for the cut.
struct PlacedChunk {
  explicit PlacedChunk(MemoryBudget* memory) : is_same_face(memory) {}

  ObjCounts first;                       ///< Counts of everything before the chunk.
  std::size_t triangles = 0;             ///< Number of triangles in the chunk.
  std::uint32_t material = kNoMaterial;  ///< The material at the start of the chunk.
  bool has_bad_vertex = false;           ///< A vertex of the chunk is NaN or infinite.
  /// For each triangle of the chunk: whether it belongs to the face of the previous triangle. Empty
  /// if no triangle does.
  CountedVector<bool> is_same_face;
};

/// A parsed corner of a face.
struct Corner {
  std::uint32_t vertex = 0;
  ObjReferences references;
};

class ObjReader {
 public:
  ObjReader(const MeshSource& source, ReadParts parts)
      : source_(source),
        has_appearance_(parts == ReadParts::kMeshAndAppearance),
        line_end_(line_end_of(source.bytes)),
        texts_(split_lines(without_byte_order_mark(source.bytes), line_end_)),
        memory_(source.work().memory, 0),
        material_ids_(source.work().memory),
        libraries_(source.work().memory),
        mesh_(empty_mesh(source.options.arrays)) {}

  MeshWithAppearance read() {
    count_chunks();
    report_obj_libraries(source_, libraries_);
    for_each_chunk(source_, texts_, line_end_, "read", [this](std::size_t i) { parse(i); });
    check_finite();
    source_.end_pass();
    parallel_for(chunks_.size(), [this](std::size_t i) {
      cut_faces(chunks_[i]);
      source_.count_work(texts_[i].size());
    });
    MeshWithAppearance result;
    if (has_appearance_) {
      attributes_->finish(mesh_, result.appearance);
      result.warnings = read_obj_materials(source_, mesh_, libraries_, attributes_->has_colors(),
                                           attributes_->bad_references(), result.appearance);
    }
    result.mesh = std::move(mesh_);
    return result;
  }

 private:
  /// Counts the contents of the chunks, turns the counts into positions in the mesh, and makes room
  /// for them.
  void count_chunks() {
    std::vector<std::optional<ObjChunk>> counted(texts_.size());
    for_each_chunk(source_, texts_, line_end_, "scan",
                   [&](std::size_t i) { counted[i].emplace(source_, texts_[i], line_end_); });
    std::uint32_t material = kNoMaterial;
    bool has_colors = false;
    for (std::optional<ObjChunk>& chunk : counted) {
      PlacedChunk& placed = chunks_.emplace_back(source_.work().memory);
      placed.first = totals_;
      placed.triangles = chunk->counts.triangles;
      totals_ += chunk->counts;
      has_colors = has_colors || chunk->has_colors;
      if (material == kNoMaterial && chunk->faces_before_material)
        material = material_ids_.find_or_add("");  // The material of faces before any usemtl.
      placed.material = material;
      for (std::size_t i = 0; i < chunk->materials.size(); ++i)
        material_ids_.find_or_add(chunk->materials[i]);
      if (!chunk->materials.empty())
        material = *material_ids_.find(chunk->materials[chunk->last_material]);
      for (std::size_t i = 0; i < chunk->libraries.size(); ++i)
        libraries_.find_or_add(chunk->libraries[i]);
      chunk.reset();
    }
    if (totals_.triangles == 0)
      throw source_.error("OBJ without faces: there is no surface to read");
    if (totals_.vertices >= kNoMaterial)
      throw source_.error("the mesh has more than 4,294,967,294 vertices");
    make_room(has_colors);
  }

  void make_room(bool has_colors) {
    const bool has_materials = material_ids_.size() > (material_ids_.find("") ? 1 : 0);
    std::uint64_t bytes = source_.options.counted(
        totals_.vertices * sizeof(Vec3f) +
        totals_.triangles * (sizeof(Triangle) + (has_materials ? sizeof(std::uint32_t) : 0)));
    if (has_materials) {
      for (std::size_t i = 0; i < material_ids_.size(); ++i)
        bytes += sizeof(std::string) + material_ids_[i].size() + 1;
    }
    memory_.resize(bytes);
    mesh_.vertices.resize(totals_.vertices);
    mesh_.triangles.resize(totals_.triangles);
    if (has_materials) {
      mesh_.triangle_materials.resize(totals_.triangles);
      mesh_.materials.reserve(material_ids_.size());
      for (std::size_t i = 0; i < material_ids_.size(); ++i)
        mesh_.materials.push_back(material_ids_[i]);
    }
    if (has_appearance_) attributes_.emplace(source_, totals_, has_colors);
  }

  void parse(std::size_t i) {
    PlacedChunk& chunk = chunks_[i];
    ObjCounts seen = chunk.first;  // Counts of everything before the line.
    std::uint32_t material = chunk.material;
    CancelPoll poll(source_.work());
    for_each_line(texts_[i], line_end_, source_.work().memory,
                  [&](std::string_view line, const char* position) {
                    switch (take_keyword(line)) {
                      case ObjStatement::kVertex: {
                        const Vec3f p = take_vertex(line, position);
                        chunk.has_bad_vertex |= !is_finite(p);
                        mesh_.vertices[seen.vertices] = p;
                        if (has_appearance_ && attributes_->has_colors() && is_finite(p))
                          attributes_->set_color(seen.vertices, line);
                        ++seen.vertices;
                        break;
                      }
                      case ObjStatement::kUv:
                        if (has_appearance_) attributes_->set_uv(seen.uvs, line);
                        ++seen.uvs;
                        break;
                      case ObjStatement::kNormal:
                        if (has_appearance_) attributes_->set_normal(seen.normals, line);
                        ++seen.normals;
                        break;
                      case ObjStatement::kFace: {
                        const std::size_t first = seen.triangles;
                        parse_face(line, position, seen, poll);
                        if (!mesh_.triangle_materials.empty())
                          for (std::size_t t = first; t < seen.triangles; ++t)
                            mesh_.triangle_materials[t] = material;
                        if (seen.triangles > first + 1) mark_face(chunk, first, seen.triangles);
                        break;
                      }
                      case ObjStatement::kMaterial:
                        material = *material_ids_.find(trim(line));
                        break;
                      default:
                        break;
                    }
                  });
  }

  /// Writes the fan of one face from seen.triangles on, and adds the fan's size to seen.triangles.
  void parse_face(std::string_view corners, const char* position, ObjCounts& seen,
                  CancelPoll& poll) {
    Corner first, previous;
    for (std::size_t n = 0;; ++n) {
      poll.step();
      const std::string_view text = next_corner(corners);
      if (text.empty()) return;
      Corner corner{parse_vertex_index(text, seen.vertices, mesh_.vertices.size(), position), {}};
      if (has_appearance_) {
        const std::size_t slash = text.find('/');
        if (slash != text.npos)
          corner.references = attributes_->parse_references(text.substr(slash + 1), seen);
      }
      if (n == 0) first = corner;
      if (n >= 2) {
        mesh_.triangles[seen.triangles] = {first.vertex, previous.vertex, corner.vertex};
        if (has_appearance_)
          attributes_->set_references(seen.triangles, first.references, previous.references,
                                      corner.references);
        ++seen.triangles;
      }
      previous = corner;
    }
  }

  /// Records that the triangles [first, end) are the fan of one face.
  static void mark_face(PlacedChunk& chunk, std::size_t first, std::size_t end) {
    if (chunk.is_same_face.empty()) chunk.is_same_face.resize(chunk.triangles, false);
    for (std::size_t t = first + 1; t < end; ++t)
      chunk.is_same_face[t - chunk.first.triangles] = true;
  }

  void cut_faces(const PlacedChunk& chunk) {
    source_.work().poll();
    FaceCutter cutter(source_);
    const auto& is_same_face = chunk.is_same_face;
    const auto triangles = std::span(mesh_.triangles).subspan(chunk.first.triangles);
    for (std::size_t first = 0; first < is_same_face.size();) {
      std::size_t end = first + 1;
      while (end < is_same_face.size() && is_same_face[end]) ++end;
      const auto fan = triangles.subspan(first, end - first);
      if (has_appearance_) {
        cutter.cut_and_match(fan, mesh_.vertices);
        attributes_->move_references(cutter, chunk.first.triangles + first, fan.size());
      } else {
        cutter.cut(fan, mesh_.vertices);
      }
      first = end;
    }
  }

  /// Refuses triangles with a vertex that is not finite. Such a vertex may stay if unused.
  void check_finite() const {
    if (std::none_of(chunks_.begin(), chunks_.end(),
                     [](const PlacedChunk& chunk) { return chunk.has_bad_vertex; }))
      return;
    if (const auto bad = find_bad_vertex(source_, mesh_))
      throw_fault(source_, {vertex_line(*bad), kBadVertex}, line_end_);
  }

  /// Returns the start of the line that defines a vertex.
  const char* vertex_line(std::size_t index) const {
    std::size_t i = chunks_.size() - 1;
    while (chunks_[i].first.vertices > index) --i;
    const char* found = nullptr;
    std::size_t vertex = chunks_[i].first.vertices;
    for_each_line(texts_[i], line_end_, source_.work().memory,
                  [&](std::string_view line, const char* position) {
                    if (take_keyword(line) == ObjStatement::kVertex && vertex++ == index)
                      found = position;
                  });
    return found;
  }

  const MeshSource& source_;
  const bool has_appearance_;
  const char line_end_;
  const std::vector<std::string_view> texts_;
  std::vector<PlacedChunk> chunks_;
  ObjCounts totals_;
  MemoryReservation memory_;  ///< The arrays of the mesh.
  NameTable material_ids_, libraries_;
  std::optional<ObjAttributes> attributes_;  ///< Set if the appearance is read.
  Mesh mesh_;
};

}  // namespace

MeshWithAppearance read_obj(const MeshSource& source, ReadParts parts) {
  if (source.bytes.empty()) throw source.error("the file is empty");
  if (source.bytes.starts_with("\xFF\xFE") || source.bytes.starts_with("\xFE\xFF"))
    throw source.error("OBJ in UTF-16: save it as ASCII or UTF-8");
  return ObjReader(source, parts).read();
}

}  // namespace voxdag

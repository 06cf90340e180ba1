#include "voxdag/formats/readers/obj/obj_reader.hpp"

#include <algorithm>
#include <limits>
#include <optional>

#include "voxdag/core/checked_size.hpp"
#include "voxdag/formats/readers/face_writer.hpp"
#include "voxdag/formats/readers/obj/obj_attributes.hpp"
#include "voxdag/formats/readers/obj/obj_materials.hpp"
#include "voxdag/formats/readers/obj/obj_passes.hpp"

namespace voxdag {
namespace {

constexpr std::uint32_t kNoMaterial = std::numeric_limits<std::uint32_t>::max();

/// A chunk's place in the mesh.
struct PlacedChunk {
  std::string_view text;
  CountedVector<ObjRun> runs;            ///< At least one.
  ObjCounts counts, first;               ///< Its contents; the contents of all chunks before.
  std::uint32_t material = kNoMaterial;  ///< The material at the start of the chunk.
  bool has_faces = false;
};

/// Reads all chunks into arrays that have their final size from the start.
class ObjReader {
 public:
  ObjReader(const MeshSource& source, ReadParts parts)
      : source_(source),
        parts_(parts),
        file_(source, kChunkBytes),
        texts_(file_.chunks().all()),
        memory_(source.work().memory, 0),
        material_ids_(source.work().memory),
        object_names_(source.work().memory),
        object_runs_(source.work().memory),
        libraries_(source.work().memory),
        mesh_(empty_mesh(source.options.arrays)) {}

  MeshWithAppearance read() {
    count_chunks();
    report_obj_libraries(source_, libraries_);
    read_chunks();
    MeshWithAppearance result;
    if (attributes_) {
      attributes_->finish(result.appearance);
      result.warnings = read_obj_materials(source_, mesh_, libraries_,
                                           attributes_->bad_references(), result.appearance);
      if (attributes_->has_colors()) attributes_->join_colors(mesh_, result);
    }
    result.mesh = std::move(mesh_);
    return result;
  }

 private:
  /// Counts the contents of the chunks, turns the counts into positions in the mesh, and makes room
  /// for them.
  void count_chunks() {
    std::vector<std::optional<ObjChunk>> counted(texts_.size());
    for_each_chunk(source_, texts_, file_.line_end(), "scan",
                   [&](std::size_t i) { counted[i].emplace(file_.count(texts_[i], parts_)); });
    std::uint32_t material = kNoMaterial;
    bool has_colors = false;
    for (std::size_t c = 0; c < counted.size(); ++c) {
      ObjChunk& chunk = *counted[c];
      has_colors = has_colors || chunk.has_colors;
      if (material == kNoMaterial && chunk.has_faces_before_material)
        material = material_ids_.find_or_add("");  // The material of faces before any usemtl.
      const bool is_whole = chunk.runs.empty();
      chunks_.push_back(
          {texts_[c], std::move(chunk.runs), chunk.counts, totals_, material, chunk.has_faces});
      if (is_whole)
        for (const bool has_values : {true, false})
          chunks_.back().runs.push_back({texts_[c], has_values, {}});
      for (const ObjPart& part : chunk.parts)
        object_runs_.push_back({totals_.triangles + part.first_triangle,
                                object_of(chunk.objects[part.name], part.is_group)});
      totals_ += chunk.counts;
      for (std::size_t i = 0; i < chunk.materials.size(); ++i)
        material_ids_.find_or_add(chunk.materials[i]);
      if (!chunk.materials.empty())
        material = *material_ids_.find(chunk.materials[chunk.last_material]);
      for (std::size_t i = 0; i < chunk.libraries.size(); ++i)
        libraries_.find_or_add(chunk.libraries[i]);
      counted[c].reset();
    }
    if (totals_.triangles == 0)
      throw source_.error("OBJ without faces: there is no surface to read");
    if (totals_.vertices >= kNoMaterial)
      throw source_.error("the mesh has more than 4,294,967,294 vertices");
    make_room(has_colors);
  }

  /// Returns the object that a statement `o` or `g` begins or goes on with: that of the name, or of
  /// both names, the first one cut, if the group is in an object of another name.
  std::uint32_t object_of(std::string_view name, bool is_group) {
    if (!is_group) object_ = name;
    if (!is_group || object_.empty() || object_ == name) return object_names_.find_or_add(name);
    return object_names_.find_or_add(object_.substr(0, kLongestName) + "/" + std::string(name));
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
    set_objects();
    bytes += mesh_.objects.size() * sizeof(std::string) +
             mesh_.object_runs.capacity() * sizeof(ObjectRun);
    for (const std::string& name : mesh_.objects) bytes += name.capacity();
    memory_.resize(bytes);
    mesh_.vertices.resize(totals_.vertices);
    mesh_.triangles.resize(totals_.triangles);
    if (has_materials) {
      mesh_.triangle_materials.resize(totals_.triangles);
      mesh_.materials.reserve(material_ids_.size());
      for (std::size_t i = 0; i < material_ids_.size(); ++i)
        mesh_.materials.push_back(material_ids_[i]);
    }
    if (parts_ == ReadParts::kMeshAndAppearance) attributes_.emplace(source_, totals_, has_colors);
  }

  /// Numbers the objects that have triangles, in the order of their first ones.
  void set_objects() {
    if (object_runs_.empty()) return;
    const std::uint32_t unnamed = object_names_.find_or_add("default");
    NameTable used(source_.work().memory);
    const auto add = [&](std::uint64_t first, std::uint64_t end, std::uint32_t name) {
      if (first == end) return;
      const std::uint32_t object = used.find_or_add(object_names_[name]);
      if (mesh_.object_runs.empty() || mesh_.object_runs.back().object != object)
        mesh_.object_runs.push_back({first, object});
    };
    add(0, object_runs_[0].first_triangle, unnamed);
    for (std::size_t i = 0; i < object_runs_.size(); ++i)
      add(object_runs_[i].first_triangle,
          i + 1 < object_runs_.size() ? object_runs_[i + 1].first_triangle : totals_.triangles,
          object_runs_[i].object);
    for (std::size_t i = 0; i < used.size(); ++i) mesh_.objects.emplace_back(used[i]);
  }

  /// Reads the vertices, then the faces. A face can precede its vertices, and cutting it needs them
  /// all. If a vertex is at fault, a face before it can be too: the first fault in the file counts.
  void read_chunks() {
    std::optional<Fault> fault =
        find_fault(source_, texts_, "read", [this](std::size_t i) { read_vertices(chunks_[i]); });
    source_.end_pass();
    const AllVertices vertices{0, totals_.vertices,
                               [this](std::uint32_t vertex) { return mesh_.vertices[vertex]; }};
    const std::optional<Fault> in_faces = find_fault(
        source_, texts_, "read", [&](std::size_t i) { read_faces(chunks_[i], vertices); });
    if (!fault || (in_faces && in_faces->position < fault->position)) fault = in_faces;
    if (fault) throw_fault(source_, *fault, file_.line_end());
  }

  void read_vertices(PlacedChunk& chunk) {
    const ObjCounts& counts = chunk.counts;
    const std::size_t attribute_values = attributes_ ? counts.uvs + counts.normals : 0;
    if (counts.vertices + attribute_values == 0) return;
    const auto vertices = std::span(mesh_.vertices).subspan(chunk.first.vertices, counts.vertices);
    for (auto run = chunk.runs.begin(); run != chunk.runs.end(); ++run) {
      if (!run->has_values) continue;
      const auto next = std::find_if(run + 1, chunk.runs.end(),
                                     [](const ObjRun& other) { return other.has_values; });
      const std::size_t begin = run->before.vertices,
                        end = next == chunk.runs.end() ? counts.vertices : next->before.vertices;
      file_.read_vertices(run->text, vertices.subspan(begin, end - begin),
                          chunk.first.with_values(run->before), attributes());
    }
  }

  void read_faces(const PlacedChunk& chunk, const AllVertices& vertices) {
    if (!chunk.has_faces) return;
    const auto triangles =
        std::span(mesh_.triangles).subspan(chunk.first.triangles, chunk.counts.triangles);
    ObjFaces faces(source_, vertices, triangles, attributes());
    ObjCounts seen = chunk.first;
    std::uint32_t material = chunk.material;
    for (const ObjRun& run : chunk.runs) {
      if (run.has_values) continue;
      const std::size_t triangle = seen.triangles;
      seen = chunk.first.with_values(run.before);
      seen.triangles = triangle;
      file_.for_each_statement(
          run.text, [&](ObjStatement statement, std::string_view line, const char* position) {
            seen.add_value(statement);
            if (statement == ObjStatement::kMaterial) material = *material_ids_.find(trim(line));
            if (statement != ObjStatement::kFace) return;
            const std::size_t count = faces.read(line, position, seen);
            if (!mesh_.triangle_materials.empty())
              std::fill_n(mesh_.triangle_materials.data() + seen.triangles, count, material);
            seen.triangles += count;
          });
    }
    faces.check_full();
  }

  ObjAttributes* attributes() { return attributes_ ? &*attributes_ : nullptr; }

  const MeshSource& source_;
  const ReadParts parts_;
  const ObjFile file_;
  const std::vector<std::string_view> texts_;
  std::vector<PlacedChunk> chunks_;
  ObjCounts totals_;
  MemoryReservation memory_;  ///< The arrays of the mesh.
  NameTable material_ids_, object_names_;
  std::string object_;                    ///< The name of the last `o`.
  CountedVector<ObjectRun> object_runs_;  ///< In the order of the file, with empty ones.
  NameTable libraries_;
  std::optional<ObjAttributes> attributes_;  ///< Set if the appearance is read.
  Mesh mesh_;
};

/// Reads chunks on demand.
class ObjMeshChunks final : public MeshChunks {
 public:
  ObjMeshChunks(MappedFile file, const std::filesystem::path& path, const ReadOptions& options,
                std::size_t chunk_bytes)
      : MeshChunks(std::move(file), path, options), file_(source(), chunk_bytes) {}

  std::uint64_t count() const override { return file_.chunks().count(); }

  std::optional<ChunkCounts> counts(std::uint64_t chunk) const override {
    ChunkCounts counts;
    read(chunk, [&](std::string_view text) {
      const ObjCounts counted = file_.count(text, ReadParts::kMesh).counts;
      counts = {counted.vertices, counted.triangles};
    });
    return counts;
  }

  void read_vertices(std::uint64_t chunk, std::span<Vec3f> vertices) const override {
    read(chunk, [&](std::string_view text) { file_.read_vertices(text, vertices, {}, nullptr); });
  }

  void read_triangles(std::uint64_t chunk, const AllVertices& vertices,
                      std::span<Triangle> triangles) const override {
    read(chunk, [&](std::string_view text) {
      ObjFaces faces(source(), vertices, triangles, nullptr);
      ObjCounts seen{.vertices = checked_size(vertices.before)};
      file_.for_each_statement(
          text, [&](ObjStatement statement, std::string_view line, const char* position) {
            seen.add_value(statement);
            if (statement == ObjStatement::kFace) faces.read(line, position, seen);
          });
      faces.check_full();
    });
  }

 private:
  template <class Work>
  void read(std::uint64_t chunk, const Work& work) const {
    const std::string_view text = file_.chunks()[chunk];
    MeshChunks::read(text, file_.line_end(), [&] { work(text); });
  }

  ObjFile file_;
};

}  // namespace

MeshWithAppearance read_obj(const MeshSource& source, ReadParts parts) {
  if (source.bytes.empty()) throw source.error("the file is empty");
  if (is_utf16(source.bytes)) throw source.error("OBJ in UTF-16: save it as ASCII or UTF-8");
  return ObjReader(source, parts).read();
}

std::unique_ptr<MeshChunks> open_obj_chunks(MappedFile file, const std::filesystem::path& path,
                                            const ReadOptions& options, std::size_t chunk_bytes) {
  return std::make_unique<ObjMeshChunks>(std::move(file), path, options, chunk_bytes);
}

}  // namespace voxdag

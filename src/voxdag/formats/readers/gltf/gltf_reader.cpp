/// The reader first checks and counts each mesh once. Then it writes every instance into arrays of
/// their final size, directly from the bytes of the buffers.
#include "voxdag/formats/readers/gltf/gltf_reader.hpp"

#include <cmath>
#include <limits>

#include "voxdag/formats/readers/gltf/gltf_instances.hpp"
#include "voxdag/formats/readers/gltf/gltf_materials.hpp"
#include "voxdag/formats/readers/gltf/gltf_mesh.hpp"
#include "voxdag/formats/readers/gltf/gltf_pose.hpp"

namespace voxdag {
namespace {

Vec3f to_vec3(const std::array<float, 3>& v) { return {v[0], v[1], v[2]}; }

class GltfReader {
 public:
  GltfReader(const MeshSource& source, ReadParts parts)
      : source_(source),
        has_appearance_(parts == ReadParts::kMeshAndAppearance),
        file_(source, warnings_, has_appearance_),
        accessors_(file_, warnings_),
        scene_(find_gltf_scene(file_, accessors_, warnings_)),
        pose_(file_, accessors_, scene_),
        meshes_(source.work().memory),
        memory_(source.work().memory, 0),
        mesh_(empty_mesh(source.options.arrays)) {}

  MeshWithAppearance read() {
    compile(scene_.instances);
    make_room(scene_.instances);
    for (const GltfInstance& instance : scene_.instances) add_instance(instance);
    file_.release_pages();
    MeshWithAppearance result;
    if (has_appearance_) {
      read_gltf_materials(file_, mesh_, appearance_, warnings_);
      result.appearance = std::move(appearance_);
    }
    if (auto warning = file_.named_files().warning(source_.name))
      warnings_.add(std::move(*warning));
    if (!has_appearance_) report_gltf_images(file_);
    result.warnings = warnings_.take(source_.name);
    result.mesh = std::move(mesh_);
    return result;
  }

 private:
  /// Checks each mesh that an instance shows.
  void compile(const CountedVector<GltfInstance>& instances) {
    const GltfItems& meshes = file_.array(GltfArray::kMeshes);
    meshes_.reserve(meshes.size());
    for (std::size_t i = 0; i < meshes.size(); ++i) meshes_.emplace_back(source_.work().memory);
    CountedVector<char> is_compiled(meshes.size(), 0,
                                    CountedAllocator<char>(source_.work().memory));
    for (const GltfInstance& instance : instances) {
      if (is_compiled[instance.mesh]) continue;
      is_compiled[instance.mesh] = 1;
      GltfMesh& mesh = meshes_[instance.mesh];
      mesh = compile_gltf_mesh(file_, meshes[instance.mesh], accessors_,
                               has_appearance_ ? &warnings_ : nullptr);
      for (const GltfPrimitive& primitive : mesh.primitives) {
        has_normals_ |= primitive.normals != nullptr;
        has_uvs_ |= primitive.uvs != nullptr;
        has_colors_ |= primitive.colors != nullptr;
      }
      has_default_material_ |= mesh.has_default_material;
    }
  }

  /// Adds up the sizes of all instances before it reserves memory, because a small file can ask for
  /// a lot.
  void make_room(const CountedVector<GltfInstance>& instances) {
    std::uint64_t vertices = 0, triangles = 0;
    for (const GltfInstance& instance : instances) {
      vertices += meshes_[instance.mesh].vertices;
      triangles += meshes_[instance.mesh].triangles;
    }
    if (triangles == 0)
      throw source_.error("the scene has no triangles: there is no surface to read");
    constexpr std::uint64_t kMax = std::numeric_limits<std::uint32_t>::max();
    if (vertices >= kMax)
      throw source_.error(std::to_string(vertices) +
                          " vertices are too many: at most 4,294,967,294 are read");
    if (3 * triangles > kMax)
      throw source_.error(std::to_string(triangles) +
                          " triangles are too many: at most 1,431,655,765 are read");
    const GltfItems& materials = file_.array(GltfArray::kMaterials);
    std::uint64_t names = 0;
    for (const GltfValue material : materials)
      names += sizeof(std::string) + material["name"].text().size() + 1;
    const std::uint64_t per_corner = (has_normals_ ? sizeof(Vec3f) : 0) +
                                     (has_uvs_ ? sizeof(Vec2f) : 0) +
                                     (has_colors_ ? sizeof(Rgba16) : 0);
    const std::uint64_t per_triangle =
        sizeof(Triangle) + (materials.empty() ? 0 : sizeof(std::uint32_t));
    memory_.resize(source_.options.counted(vertices * sizeof(Vec3f) + triangles * per_triangle) +
                   3 * triangles * per_corner + names);
    mesh_.vertices.reserve(vertices);
    mesh_.triangles.reserve(triangles);
    if (!materials.empty()) mesh_.triangle_materials.reserve(triangles);
    mesh_.materials.reserve(materials.size() + 1);
    for (const GltfValue material : materials) mesh_.materials.push_back(material["name"].text());
    if (has_default_material_ && !materials.empty()) mesh_.materials.emplace_back();
    if (has_normals_) appearance_.normals.resize(3 * triangles);
    if (has_uvs_) appearance_.uvs.resize(3 * triangles);
    if (has_colors_) appearance_.colors.resize(3 * triangles);
  }

  /// Begins the object of an instance, named after its node or mesh.
  void add_object(const GltfInstance& instance) {
    std::string name;
    const bool has_node = instance.node != kGltfNoNode;
    if (has_node) name = file_.array(GltfArray::kNodes)[instance.node]["name"].text();
    if (name.empty()) name = file_.array(GltfArray::kMeshes)[instance.mesh]["name"].text();
    if (name.empty())
      name = has_node ? "node " + std::to_string(instance.node)
                      : "mesh " + std::to_string(instance.mesh);
    memory_.resize(memory_.bytes() + 2 * (sizeof name + name.size() + sizeof(ObjectRun)));
    mesh_.object_runs.push_back(
        {mesh_.triangles.size(), static_cast<std::uint32_t>(mesh_.objects.size())});
    mesh_.objects.push_back(std::move(name));
  }

  void add_instance(const GltfInstance& instance) {
    if (source_.options.objects) add_object(instance);
    const auto first_vertex = static_cast<std::uint32_t>(mesh_.vertices.size());
    pose_.start(instance);
    for (const GltfPrimitive& primitive : meshes_[instance.mesh].primitives) {
      pose_.start(primitive);
      if (primitive.adds_vertices)
        for (std::size_t i = 0; i < primitive.positions->size(); ++i) {
          step();
          mesh_.vertices.push_back(source_.vertex(pose_.position(i)));
        }
      for (std::size_t i = 0; i < primitive.triangles; ++i)
        add_triangle(primitive, i, first_vertex + primitive.first_vertex);
    }
  }

  void add_triangle(const GltfPrimitive& primitive, std::size_t i, std::uint32_t first_vertex) {
    step();
    const std::size_t t = mesh_.triangles.size();
    Triangle triangle{};
    auto corners = gltf_triangle_corners(primitive.mode, i);
    for (std::size_t& index : corners) {
      if (primitive.indices != nullptr) index = primitive.indices->index(index);
      if (index >= primitive.positions->size())
        throw primitive.value.error("vertex index " + std::to_string(index) + " is out of range: " +
                                    std::to_string(primitive.positions->size()) + " vertices");
    }
    if (pose_.is_mirrored(corners[0])) std::swap(corners[1], corners[2]);
    for (std::size_t c = 0; c < 3; ++c) {
      const std::size_t index = corners[c];
      triangle[c] = first_vertex + static_cast<std::uint32_t>(index);
      if (has_appearance_) set_attributes(primitive, index, 3 * t + c);
    }
    mesh_.triangles.push_back(triangle);
    if (mesh_.triangle_materials.capacity() > 0)
      mesh_.triangle_materials.push_back(primitive.material);
  }

  /// Sets the attributes of a corner of the mesh to those of a vertex of a primitive.
  void set_attributes(const GltfPrimitive& primitive, std::size_t vertex, std::size_t corner) {
    if (primitive.normals != nullptr) appearance_.normals[corner] = pose_.normal(vertex);
    if (primitive.uvs != nullptr) {
      const auto [u, v] = primitive.uvs->floats<2>(vertex);
      if (std::isfinite(u) && std::isfinite(v)) appearance_.uvs[corner] = {u, v};
    }
    if (primitive.colors != nullptr) {
      const bool has_alpha = primitive.colors->components() == 4;
      const auto c = has_alpha ? primitive.colors->floats<4>(vertex) : std::array<float, 4>{};
      const auto rgb =
          has_alpha ? std::array{c[0], c[1], c[2]} : primitive.colors->floats<3>(vertex);
      appearance_.colors[corner] = to_rgba16(to_vec3(rgb), has_alpha ? c[3] : 1);
    }
  }

  /// Counts a vertex or triangle. Once in 65,536, reports, polls cancellation, and drops the
  /// buffers' pages from memory, and from time to time those of the mesh.
  void step() {
    if ((++steps_ & 0xFFFF) != 0) return;
    file_.release_pages();
    source_.count_work(0x10000 * sizeof(Triangle));
    source_.work().poll();
    const std::size_t items = mesh_.vertices.size() + mesh_.triangles.size();
    const std::size_t all = mesh_.vertices.capacity() + mesh_.triangles.capacity();
    source_.work().report_done("read", items, all);
  }

  const MeshSource& source_;
  const bool has_appearance_;
  Warnings warnings_;
  const GltfFile file_;
  GltfAccessors accessors_;
  const GltfScene scene_;
  GltfPose pose_;
  CountedVector<GltfMesh> meshes_;  ///< Per mesh of the file; empty unless an instance shows it.
  bool has_normals_ = false, has_uvs_ = false, has_colors_ = false;
  bool has_default_material_ = false;
  std::uint32_t steps_ = 0;
  MemoryReservation memory_;  ///< The arrays of mesh and appearance.
  Mesh mesh_;
  Appearance appearance_;
};

}  // namespace

MeshWithAppearance read_gltf(const MeshSource& source, ReadParts parts) {
  if (source.bytes.empty()) throw source.error("the file is empty");
  return GltfReader(source, parts).read();
}

}  // namespace voxdag

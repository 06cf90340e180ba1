#include "voxdag/readers/gltf/gltf_reader.hpp"

#include <unistd.h>

#include <cmath>
#include <limits>
#include <map>

#include "voxdag/readers/gltf/gltf_accessor.hpp"
#include "voxdag/readers/gltf/gltf_corners.hpp"
#include "voxdag/readers/gltf/gltf_file.hpp"
#include "voxdag/readers/gltf/gltf_materials.hpp"

namespace voxdag {
namespace {

/// Rotation by a quaternion (x, y, z, w) of any length but zero.
GltfTransform rotation(const std::vector<double>& q, const GltfValue& user) {
  const double length2 = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
  if (!(length2 > 0) || !std::isfinite(length2)) throw user.error("rotation is not a quaternion");
  const double s = 2 / length2;
  const double x = q[0], y = q[1], z = q[2], w = q[3];
  return {{{{1 - s * (y * y + z * z), s * (x * y + z * w), s * (x * z - y * w)},
            {s * (x * y - z * w), 1 - s * (x * x + z * z), s * (y * z + x * w)},
            {s * (x * z + y * w), s * (y * z - x * w), 1 - s * (x * x + y * y)},
            {0, 0, 0}}}};
}

GltfTransform node_transform(const GltfValue& node) {
  const std::vector<double> m = node["matrix"].numbers(16);
  GltfTransform transform;
  if (!m.empty()) {
    if (m[3] != 0 || m[7] != 0 || m[11] != 0 || m[15] != 1)
      throw node.error("matrix whose last row is not 0 0 0 1");
    for (std::size_t c = 0; c < 4; ++c)
      transform.columns[c] = {m[4 * c], m[4 * c + 1], m[4 * c + 2]};
    return transform;
  }
  const std::vector<double> r = node["rotation"].numbers(4);
  if (!r.empty()) transform = rotation(r, node);
  const std::vector<double> s = node["scale"].numbers(3);
  for (std::size_t axis = 0; axis < s.size(); ++axis)
    transform.columns[axis] = transform.columns[axis] * s[axis];
  const std::vector<double> t = node["translation"].numbers(3);
  if (!t.empty()) transform.columns[3] = {t[0], t[1], t[2]};
  return transform;
}

enum Mode : std::uint64_t { kTriangles = 4, kStrip = 5, kFan = 6 };

std::uint64_t triangle_count(std::uint64_t mode, std::uint64_t corners) {
  if (mode == kTriangles) return corners / 3;
  return corners < 3 ? 0 : corners - 2;
}

/// The corners of triangle `i`, in the order of the glTF specification (3.7.2.1).
std::array<std::size_t, 3> triangle_corners(std::uint64_t mode, std::size_t i) {
  if (mode == kTriangles) return {3 * i, 3 * i + 1, 3 * i + 2};
  if (mode == kStrip) return {i, i + 1 + i % 2, i + 2 - i % 2};
  return {i + 1, i + 2, 0};
}

class GltfReader {
 public:
  explicit GltfReader(const MeshSource& source) : source_(source), file_(source) {}

  /// Lets `corners` gather the attributes while the mesh is read.
  void gather(GltfCorners& corners) { corners_ = &corners; }
  const GltfFile& file() const { return file_; }

  Mesh read() {
    find_instances();
    reserve();
    for (const auto& [mesh, transform] : instances_) {
      if (source_.options.progress != nullptr) source_.options.progress->throw_if_cancelled();
      vertex_starts_.clear();
      for (const GltfValue& primitive : (*mesh)["primitives"].items())
        add_primitive(primitive, transform);
    }
    if (mesh_.triangles.empty())
      throw source_.error("the scene shows no triangles: there is no surface to read");
    name_materials();
    return std::move(mesh_);
  }

 private:
  struct Instance {
    const GltfValue* mesh;
    GltfTransform transform;
  };

  void find_instances() {
    const auto& scenes = file_.array("scenes");
    const auto& nodes = file_.array("nodes");
    const GltfValue default_scene = file_.root()["scene"];
    std::vector<std::uint64_t> roots;
    if (default_scene.exists() || !scenes.empty()) {
      const GltfValue& scene = file_.item("scenes", default_scene.whole(0), default_scene);
      for (const GltfValue& node : scene["nodes"].items()) roots.push_back(node.whole());
    } else {
      std::vector<char> is_child(nodes.size(), 0);
      for (const GltfValue& node : nodes)
        for (const GltfValue& child : node["children"].items())
          if (child.whole() < nodes.size()) is_child[child.whole()] = 1;
      for (std::size_t i = 0; i < nodes.size(); ++i)
        if (!is_child[i]) roots.push_back(i);
      if (nodes.empty())
        for (const GltfValue& mesh : file_.array("meshes")) instances_.push_back({&mesh, {}});
      else if (roots.empty())
        throw source_.error("nodes form a cycle");
    }
    std::vector<std::pair<std::uint64_t, GltfTransform>> stack;
    for (auto root = roots.rbegin(); root != roots.rend(); ++root) stack.push_back({*root, {}});
    std::vector<char> seen(nodes.size(), 0);
    while (!stack.empty()) {
      const auto [index, parent] = stack.back();
      stack.pop_back();
      const GltfValue& node = file_.item("nodes", index, file_.root());
      if (seen[index]) throw node.error("node is reached twice: nodes must form trees");
      seen[index] = 1;
      const GltfTransform transform = parent * node_transform(node);
      if (node["mesh"].exists())
        instances_.push_back({&file_.item("meshes", node["mesh"].whole(), node), transform});
      const auto children = node["children"].items();
      for (auto child = children.rbegin(); child != children.rend(); ++child)
        stack.push_back({child->whole(), transform});
    }
  }

  /// Adds up what the instances make before making any of it: a small file can ask for a lot.
  void reserve() {
    std::uint64_t vertices = 0, triangles = 0;
    std::map<const GltfValue*, std::pair<std::uint64_t, std::uint64_t>> counted;
    for (const Instance& instance : instances_) {
      const auto [known, is_new] = counted.try_emplace(instance.mesh);
      if (is_new) known->second = count_mesh(*instance.mesh);
      vertices += known->second.first;
      triangles += known->second.second;
      if (vertices >= std::numeric_limits<std::uint32_t>::max())
        throw source_.error("more than 4,294,967,294 vertices");
    }
    const auto memory = static_cast<double>(::sysconf(_SC_PHYS_PAGES)) *
                        static_cast<double>(::sysconf(_SC_PAGESIZE));
    if (static_cast<double>(vertices + triangles) * 12 > memory)
      throw source_.error(std::to_string(triangles) +
                          " triangles are too many for this machine's memory");
    mesh_.vertices.reserve(vertices);
    mesh_.triangles.reserve(triangles);
    if (!file_.array("materials").empty()) mesh_.triangle_materials.reserve(triangles);
  }

  /// Vertices and triangles of a mesh as declared, once the accessors are known to hold them.
  std::pair<std::uint64_t, std::uint64_t> count_mesh(const GltfValue& mesh) {
    std::uint64_t vertices = 0, triangles = 0;
    vertex_starts_.clear();
    for (const GltfValue& primitive : mesh["primitives"].items()) {
      const std::uint64_t mode = checked_mode(primitive);
      const GltfValue position = primitive["attributes"]["POSITION"];
      if (mode < kTriangles || !position.exists()) continue;
      const std::uint64_t index = position.whole();
      const std::uint64_t count = load_positions(index, primitive).size();
      if (vertex_starts_.try_emplace(index, 0).second) vertices += count;
      const GltfValue indices = primitive["indices"];
      triangles += triangle_count(
          mode, indices.exists() ? load_indices(indices.whole(), primitive).size() : count);
    }
    return {vertices, triangles};
  }

  static std::uint64_t checked_mode(const GltfValue& primitive) {
    const std::uint64_t mode = primitive["mode"].whole(kTriangles);
    if (mode > kFan) throw primitive.error("mode " + std::to_string(mode) + " is unknown");
    return mode;
  }

  const std::vector<Vec3f>& load_positions(std::uint64_t index, const GltfValue& primitive) {
    if (index == positions_index_) return positions_;
    const GltfValue& accessor = file_.item("accessors", index, primitive);
    if (!accessor["bufferView"].exists() &&
        primitive["extensions"]["KHR_draco_mesh_compression"].exists())
      throw primitive.error("compressed with Draco, which is not supported");
    positions_ = read_gltf_positions(file_, accessor);
    positions_index_ = index;
    return positions_;
  }

  const std::vector<std::uint32_t>& load_indices(std::uint64_t index, const GltfValue& primitive) {
    if (index == indices_index_) return indices_;
    indices_ = read_gltf_indices(file_, file_.item("accessors", index, primitive));
    indices_index_ = index;
    return indices_;
  }

  void add_primitive(const GltfValue& primitive, const GltfTransform& transform) {
    const std::uint64_t mode = checked_mode(primitive);
    const GltfValue position = primitive["attributes"]["POSITION"];
    if (mode < kTriangles || !position.exists()) return;
    const std::vector<Vec3f>& positions = load_positions(position.whole(), primitive);
    const auto [start, is_new] = vertex_starts_.try_emplace(
        position.whole(), static_cast<std::uint32_t>(mesh_.vertices.size()));
    if (is_new)
      for (const Vec3f& p : positions)
        mesh_.vertices.push_back(static_cast<Vec3f>(transform.point(static_cast<Vec3d>(p))));

    const bool is_indexed = primitive["indices"].exists();
    if (is_indexed) load_indices(primitive["indices"].whole(), primitive);
    const std::size_t corners = is_indexed ? indices_.size() : positions.size();
    const std::uint32_t material = material_of(primitive);
    if (corners_ != nullptr) corners_->start(file_, primitive, transform, positions.size());
    for (std::size_t i = 0; i < triangle_count(mode, corners); ++i) {
      Triangle triangle{};
      const auto triangle_corner = triangle_corners(mode, i);
      for (std::size_t c = 0; c < 3; ++c) {
        const std::size_t corner = triangle_corner[c];
        const std::size_t index = is_indexed ? indices_[corner] : corner;
        if (index >= positions.size())
          throw primitive.error("vertex index " + std::to_string(index) + " is out of range: " +
                                std::to_string(positions.size()) + " vertices");
        triangle[c] = start->second + static_cast<std::uint32_t>(index);
        if (!is_finite(mesh_.vertices[triangle[c]]))
          throw primitive.error("vertex " + std::to_string(index) +
                                " is not finite and a triangle uses it");
      }
      mesh_.triangles.push_back(triangle);
      if (corners_ != nullptr) corners_->add(triangle, start->second);
      if (!file_.array("materials").empty()) mesh_.triangle_materials.push_back(material);
    }
  }

  std::uint32_t material_of(const GltfValue& primitive) {
    const std::size_t count = file_.array("materials").size();
    if (!primitive["material"].exists()) {
      uses_default_material_ |= count > 0;
      return static_cast<std::uint32_t>(count);
    }
    file_.item("materials", primitive["material"].whole(), primitive);
    return static_cast<std::uint32_t>(primitive["material"].whole());
  }

  void name_materials() {
    for (const GltfValue& material : file_.array("materials"))
      mesh_.materials.push_back(material["name"].text());
    if (uses_default_material_) mesh_.materials.emplace_back();
  }

  const MeshSource& source_;
  const GltfFile file_;
  std::vector<Instance> instances_;
  /// Where the vertices of a position accessor start, in the instance at hand.
  std::map<std::uint64_t, std::uint32_t> vertex_starts_;
  std::uint64_t positions_index_ = std::numeric_limits<std::uint64_t>::max();
  std::uint64_t indices_index_ = std::numeric_limits<std::uint64_t>::max();
  std::vector<Vec3f> positions_;  ///< Of the accessor read last.
  std::vector<std::uint32_t> indices_;
  bool uses_default_material_ = false;
  GltfCorners* corners_ = nullptr;
  Mesh mesh_;
};

}  // namespace

MeshWithAppearance read_gltf(const MeshSource& source, ReadParts parts) {
  if (source.bytes.empty()) throw source.error("the file is empty");
  MeshWithAppearance result;
  GltfReader reader(source);
  GltfCorners corners(result.appearance, result.warnings);
  if (parts == ReadParts::kMeshAndAppearance) reader.gather(corners);
  result.mesh = reader.read();
  if (parts == ReadParts::kMeshAndAppearance)
    read_gltf_materials(source, reader.file(), result.mesh, result.appearance, result.warnings);
  return result;
}

}  // namespace voxdag

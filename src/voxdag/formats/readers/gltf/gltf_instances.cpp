#include "voxdag/formats/readers/gltf/gltf_instances.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

namespace voxdag {
namespace {

/// Returns the rotation by a quaternion (x, y, z, w) of any length but zero.
AffineTransform rotation(std::span<const double, 4> q, const GltfValue& user) {
  const double length2 = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
  if (!(length2 > 0) || !std::isfinite(length2))
    throw user.error("the rotation must be a quaternion that is finite and not zero");
  const double s = 2 / length2;
  const double x = q[0], y = q[1], z = q[2], w = q[3];
  return {{{{1 - s * (y * y + z * z), s * (x * y + z * w), s * (x * z - y * w)},
            {s * (x * y - z * w), 1 - s * (x * x + z * z), s * (y * z + x * w)},
            {s * (x * z + y * w), s * (y * z - x * w), 1 - s * (x * x + y * y)},
            {0, 0, 0}}}};
}

/// Returns the nodes that are no children.
CountedVector<std::uint64_t> find_all_roots(const GltfFile& file) {
  const GltfItems& nodes = file.array(GltfArray::kNodes);
  CountedVector<std::uint64_t> roots(file.source().work().memory);
  CountedVector<char> is_child(nodes.size(), 0, CountedAllocator<char>(roots.get_allocator()));
  CancelPoll poll(file.source().work());
  for (const GltfValue node : nodes) {
    poll.step();
    for (const GltfValue child : node["children"].items()) {
      poll.step();
      if (child.whole() < nodes.size()) is_child[child.whole()] = 1;
    }
  }
  for (std::size_t i = 0; i < nodes.size(); ++i)
    if (!is_child[i]) roots.push_back(i);
  return roots;
}

/// Returns the root nodes of the shown scene.
CountedVector<std::uint64_t> find_roots(const GltfFile& file) {
  const GltfValue default_scene = file.root()["scene"];
  if (default_scene.exists() || !file.array(GltfArray::kScenes).empty()) {
    CountedVector<std::uint64_t> roots(file.source().work().memory);
    const GltfValue scene = file.item(GltfArray::kScenes, default_scene.whole(0), default_scene);
    for (const GltfValue node : scene["nodes"].items()) roots.push_back(node.whole());
    return roots;
  }
  CountedVector<std::uint64_t> roots = find_all_roots(file);
  if (!file.array(GltfArray::kNodes).empty() && roots.empty())
    throw file.source().error("nodes form a cycle");
  return roots;
}

class SceneFinder {
 public:
  SceneFinder(const GltfFile& file, GltfAccessors& accessors)
      : file_(file), accessors_(accessors), memory_(file.source().work().memory), scene_(memory_) {}

  GltfScene find(Warnings& warnings) {
    const GltfItems& nodes = file_.array(GltfArray::kNodes);
    const GltfItems& meshes = file_.array(GltfArray::kMeshes);
    const CountedVector<std::uint64_t> roots = find_roots(file_);
    if (nodes.empty() && roots.empty() && file_.array(GltfArray::kScenes).empty()) {
      for (std::uint32_t i = 0; i < meshes.size(); ++i)
        scene_.instances.push_back({i, kGltfNoNode, {}});
      return std::move(scene_);
    }
    if (!file_.array(GltfArray::kSkins).empty()) scene_.nodes.resize(nodes.size());
    scene_.is_placed.resize(nodes.size());
    CountedVector<PlacedNode> stack(memory_), hidden(memory_);
    for (auto root = roots.rbegin(); root != roots.rend(); ++root) stack.push_back({*root, {}});
    CancelPoll poll(file_.source().work());
    while (!stack.empty()) {
      poll.step();
      const auto [index, parent] = stack.back();
      stack.pop_back();
      const GltfValue node = file_.item(GltfArray::kNodes, index, file_.root());
      if (scene_.is_placed[index]) throw node.error("node is reached twice: nodes must form trees");
      const AffineTransform transform = place(index, node, parent);
      const bool is_visible = node["extensions"]["KHR_node_visibility"]["visible"].boolean(true);
      push_children(node, transform, is_visible ? stack : hidden);
      if (is_visible && node["mesh"].exists())
        add_mesh(node, static_cast<std::uint32_t>(index), transform);
    }
    if (!scene_.nodes.empty()) place_joints(std::move(hidden));
    if (rounded_ > 0)
      warnings.add(file_.source().name + ": " + std::to_string(rounded_) +
                   " matrices whose last row is nearly 0 0 0 1 are taken as if it was");
    return std::move(scene_);
  }

 private:
  struct PlacedNode {
    std::uint64_t index;
    AffineTransform parent;
  };

  /// Returns the world transform of a node and keeps it if the asset has skins.
  AffineTransform place(std::uint64_t index, const GltfValue& node, const AffineTransform& parent) {
    scene_.is_placed[index] = 1;
    const AffineTransform transform = parent * node_transform(node);
    if (!scene_.nodes.empty()) scene_.nodes[index] = transform;
    return transform;
  }

  static void push_children(const GltfValue& node, const AffineTransform& transform,
                            CountedVector<PlacedNode>& stack) {
    const GltfItems children = node["children"].items();
    for (std::size_t i = children.size(); i-- > 0;)
      stack.push_back({children[i].whole(), transform});
  }

  /// Places the nodes below hidden ones and outside of the scene: joints may be there.
  void place_joints(CountedVector<PlacedNode> stack) {
    for (const std::uint64_t root : find_all_roots(file_)) stack.push_back({root, {}});
    CancelPoll poll(file_.source().work());
    while (!stack.empty()) {
      poll.step();
      const auto [index, parent] = stack.back();
      stack.pop_back();
      const GltfValue node = file_.item(GltfArray::kNodes, index, file_.root());
      if (!scene_.is_placed[index]) push_children(node, place(index, node, parent), stack);
    }
  }

  /// Returns the transform of a node from its matrix or its translation, rotation and scale.
  AffineTransform node_transform(const GltfValue& node) {
    const std::vector<double> m = node["matrix"].numbers(16);
    if (m.empty())
      return of_parts(node["translation"].numbers(3), node["rotation"].numbers(4),
                      node["scale"].numbers(3), node);
    constexpr double kRounding = 1e-5;  // of products of float32 matrices
    const double off =
        std::max({std::abs(m[3]), std::abs(m[7]), std::abs(m[11]), std::abs(m[15] - 1)});
    if (!(off <= kRounding)) throw node.error("the last row of the matrix must be 0 0 0 1");
    if (off > 0) ++rounded_;
    AffineTransform transform;
    for (std::size_t c = 0; c < 4; ++c)
      transform.columns[c] = {m[4 * c], m[4 * c + 1], m[4 * c + 2]};
    return transform;
  }

  /// Returns the transform of a translation, a rotation and a scale, each of which may be empty.
  static AffineTransform of_parts(std::span<const double> t, std::span<const double> r,
                                  std::span<const double> s, const GltfValue& user) {
    AffineTransform transform;
    if (!r.empty()) transform = rotation(r.first<4>(), user);
    for (std::size_t axis = 0; axis < s.size(); ++axis)
      transform.columns[axis] = transform.columns[axis] * s[axis];
    if (!t.empty()) transform.columns[3] = {t[0], t[1], t[2]};
    return transform;
  }

  void add_mesh(const GltfValue& node, std::uint32_t index, const AffineTransform& transform) {
    const std::uint64_t mesh = node["mesh"].whole();
    file_.item(GltfArray::kMeshes, mesh, node);
    const GltfValue instancing = node["extensions"]["EXT_mesh_gpu_instancing"]["attributes"];
    const GltfAccessor* const t = instance_values(instancing, "TRANSLATION", 3);
    const GltfAccessor* const r = instance_values(instancing, "ROTATION", 4);
    const GltfAccessor* const s = instance_values(instancing, "SCALE", 3);
    const auto add = [&](const AffineTransform& of) {
      scene_.instances.push_back({static_cast<std::uint32_t>(mesh), index, of});
    };
    const GltfAccessor* const any = t != nullptr ? t : r != nullptr ? r : s;
    if (any == nullptr) return add(transform);
    for (const GltfAccessor* const each : {t, r, s})
      if (each != nullptr && each->size() != any->size())
        throw instancing.error("the attributes of instances differ in number");
    CancelPoll poll(file_.source().work());
    for (std::size_t i = 0; i < any->size(); ++i) {
      poll.step();
      const auto values = [&]<std::size_t n>(const GltfAccessor* of, std::array<double, n>& to) {
        if (of == nullptr) return std::span<const double>();
        const std::array<float, n> floats = of->floats<n>(i);
        std::copy(floats.begin(), floats.end(), to.begin());
        return std::span<const double>(to);
      };
      std::array<double, 3> translation{}, scale{};
      std::array<double, 4> turn{};
      add(transform *
          of_parts(values(t, translation), values(r, turn), values(s, scale), instancing));
    }
  }

  const GltfAccessor* instance_values(const GltfValue& attributes, const char* name,
                                      int components) {
    const GltfValue index = attributes[name];
    if (!index.exists()) return nullptr;
    return &accessors_.attributes(index.whole(), attributes, components, components, name);
  }

  const GltfFile& file_;
  GltfAccessors& accessors_;
  MemoryBudget* memory_;
  GltfScene scene_;
  std::size_t rounded_ = 0;
};

}  // namespace

GltfScene find_gltf_scene(const GltfFile& file, GltfAccessors& accessors, Warnings& warnings) {
  return SceneFinder(file, accessors).find(warnings);
}

}  // namespace voxdag

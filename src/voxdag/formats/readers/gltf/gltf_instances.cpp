#include "voxdag/formats/readers/gltf/gltf_instances.hpp"

#include <cmath>
#include <utility>

namespace voxdag {
namespace {

/// Returns the rotation by a quaternion (x, y, z, w) of any length but zero.
GltfTransform rotation(const std::vector<double>& q, const GltfValue& user) {
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

/// Returns the root nodes of the shown scene.
CountedVector<std::uint64_t> find_roots(const GltfFile& file) {
  const GltfItems& nodes = file.array(GltfArray::kNodes);
  CountedVector<std::uint64_t> roots(file.source().work().memory);
  const GltfValue default_scene = file.root()["scene"];
  if (default_scene.exists() || !file.array(GltfArray::kScenes).empty()) {
    const GltfValue scene = file.item(GltfArray::kScenes, default_scene.whole(0), default_scene);
    for (const GltfValue node : scene["nodes"].items()) roots.push_back(node.whole());
    return roots;
  }
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
  if (!nodes.empty() && roots.empty()) throw file.source().error("nodes form a cycle");
  return roots;
}

}  // namespace

GltfTransform gltf_node_transform(const GltfValue& node) {
  const std::vector<double> m = node["matrix"].numbers(16);
  GltfTransform transform;
  if (!m.empty()) {
    if (m[3] != 0 || m[7] != 0 || m[11] != 0 || m[15] != 1)
      throw node.error("the last row of the matrix must be 0 0 0 1");
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

CountedVector<GltfInstance> find_gltf_instances(const GltfFile& file) {
  MemoryBudget* const memory = file.source().work().memory;
  CountedVector<GltfInstance> instances(memory);
  const GltfItems& nodes = file.array(GltfArray::kNodes);
  const GltfItems& meshes = file.array(GltfArray::kMeshes);
  const CountedVector<std::uint64_t> roots = find_roots(file);
  if (nodes.empty() && roots.empty() && file.array(GltfArray::kScenes).empty()) {
    for (std::uint32_t i = 0; i < meshes.size(); ++i) instances.push_back({i, {}});
    return instances;
  }
  CountedVector<std::pair<std::uint64_t, GltfTransform>> stack(memory);
  for (auto root = roots.rbegin(); root != roots.rend(); ++root) stack.push_back({*root, {}});
  CountedVector<char> seen(nodes.size(), 0, CountedAllocator<char>(memory));
  CancelPoll poll(file.source().work());
  while (!stack.empty()) {
    poll.step();
    const auto [index, parent] = stack.back();
    stack.pop_back();
    const GltfValue node = file.item(GltfArray::kNodes, index, file.root());
    if (seen[index]) throw node.error("node is reached twice: nodes must form trees");
    seen[index] = 1;
    const GltfTransform transform = parent * gltf_node_transform(node);
    if (node["mesh"].exists()) {
      const std::uint64_t mesh = node["mesh"].whole();
      file.item(GltfArray::kMeshes, mesh, node);
      instances.push_back({static_cast<std::uint32_t>(mesh), transform, index});
    }
    const GltfItems children = node["children"].items();
    for (std::size_t i = children.size(); i-- > 0;)
      stack.push_back({children[i].whole(), transform});
  }
  return instances;
}

}  // namespace voxdag

#include "voxdag/formats/readers/gltf/gltf_instances.hpp"

#include <utility>

namespace voxdag {
namespace {

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
      instances.push_back({static_cast<std::uint32_t>(mesh), transform});
    }
    const GltfItems children = node["children"].items();
    for (std::size_t i = children.size(); i-- > 0;)
      stack.push_back({children[i].whole(), transform});
  }
  return instances;
}

}  // namespace voxdag

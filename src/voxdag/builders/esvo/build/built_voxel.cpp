#include "voxdag/builders/esvo/build/built_voxel.hpp"

#include <bit>

namespace voxdag {
namespace {

std::ptrdiff_t count_bits(std::uint32_t mask) {
  return static_cast<std::ptrdiff_t>(std::popcount(mask));
}

/// Appends all nodes of `child` except node 0, renumbered. Returns node 0, renumbered.
EsvoNode append_tree(EsvoTree& tree, const EsvoTree& child) {
  const auto nodes = static_cast<std::uint32_t>(tree.nodes.size()) - 1;
  const auto contours = static_cast<std::uint32_t>(tree.contours.size());
  const auto values = static_cast<std::uint32_t>(tree.values.size());
  const auto packed = static_cast<std::uint32_t>(tree.packed.size());
  const auto moved = [&](EsvoNode node) {
    node.first_child += node.is_packed ? packed : nodes;
    node.first_contour += contours;
    node.first_value += values;
    return node;
  };
  for (std::size_t i = 1; i < child.nodes.size(); ++i) tree.nodes.push_back(moved(child.nodes[i]));
  tree.contours.insert(tree.contours.end(), child.contours.begin(), child.contours.end());
  tree.values.insert(tree.values.end(), child.values.begin(), child.values.end());
  tree.packed.insert(tree.packed.end(), child.packed.begin(), child.packed.end());
  return moved(child.nodes[0]);
}

}  // namespace

void BuiltVoxel::count_tree(MemoryBudget* budget) {
  memory = {budget, tree.nodes.capacity() * sizeof(EsvoNode) +
                        tree.contours.capacity() * sizeof(Contour) +
                        tree.values.capacity() * sizeof(VoxelValue) +
                        tree.packed.capacity() * sizeof(std::uint64_t)};
}

BuiltVoxel join_children(const CellDecision& decision, std::span<BuiltVoxel, 8> children,
                         bool attributes, MemoryBudget* budget) {
  BuiltVoxel built;
  built.contour = decision.contour;
  EsvoTree& tree = built.tree;
  EsvoNode node;
  for (std::size_t i = 0; i < 8; ++i) {
    const BuiltVoxel& child = children[i];
    if (!child.exists) continue;
    built.exists = true;
    built.sum.add(child.sum);
    const auto bit = static_cast<std::uint8_t>(1u << i);
    node.valid_mask |= bit;
    if (child.is_leaf) node.leaf_mask |= bit;
    if (child.contour) {
      node.contour_mask |= bit;
      tree.contours.push_back(*child.contour);
    }
    if (attributes) tree.values.push_back(voxel_value(child.sum));
  }
  if (!built.exists) return built;
  node.first_child = 1;
  tree.nodes.resize(1 + node.inner_count());
  tree.nodes[0] = node;
  std::size_t at = 1;
  for (BuiltVoxel& child : children) {
    if (!child.exists || child.is_leaf) continue;
    tree.nodes[at++] = append_tree(tree, child.tree);
    child = {};
  }
  built.count_tree(budget);
  return built;
}

void keep_packed_root(EsvoTree& tree, std::uint64_t first_child) {
  EsvoNode node = tree.nodes[0];
  EsvoTree kept;
  const auto contours = tree.contours.begin() + node.first_contour;
  kept.contours.assign(contours, contours + count_bits(node.contour_mask));
  if (tree.has_values()) {
    const auto values = tree.values.begin() + node.first_value;
    kept.values.assign(values, values + count_bits(node.valid_mask));
  }
  node.first_contour = node.first_value = node.first_child = 0;
  node.is_packed = true;
  kept.packed = {first_child};
  kept.nodes = {node};
  tree = std::move(kept);
}

}  // namespace voxdag

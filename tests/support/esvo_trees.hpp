#pragma once
/// Makes random octrees as nodes, and reads the nodes of a packed octree back.
#include <bit>
#include <cstdint>
#include <random>

#include "voxdag/builders/esvo/encode/esvo_tree.hpp"
#include "voxdag/stored/esvo/esvo.hpp"

namespace voxdag::test {

struct RandomTree {
  int levels = 5;
  double density = 0.5;      ///< Probability of a child.
  double leaf_chance = 0.2;  ///< Probability that a voxel above the finest level is a leaf.
  double contour_chance = 0.5;
  bool with_values = true;
};

/// Returns a tree of up to `levels` levels. Node 0 is the root and is never empty. Contours have
/// arbitrary values.
inline EsvoTree random_tree(const RandomTree& want, std::uint32_t seed) {
  std::mt19937 random(seed);
  const auto chance = [&](double p) { return static_cast<double>(random()) / 4294967296.0 < p; };
  EsvoTree tree;
  tree.nodes.emplace_back();
  std::vector<int> node_level{0};
  for (std::size_t at = 0; at < tree.nodes.size(); ++at) {
    const int level = node_level[at];
    EsvoNode node;
    while (node.valid_mask == 0)
      for (std::uint32_t i = 0; i < 8; ++i)
        if (chance(want.density)) node.valid_mask |= static_cast<std::uint8_t>(1u << i);
    node.first_child = static_cast<std::uint32_t>(tree.nodes.size());
    node.first_contour = static_cast<std::uint32_t>(tree.contours.size());
    node.first_value = static_cast<std::uint32_t>(tree.values.size());
    for (std::uint32_t i = 0; i < 8; ++i) {
      const auto bit = static_cast<std::uint8_t>(1u << i);
      if ((node.valid_mask & bit) == 0) continue;
      if (level + 1 == want.levels || chance(want.leaf_chance)) {
        node.leaf_mask |= bit;
      } else {
        tree.nodes.emplace_back();
        node_level.push_back(level + 1);
      }
      if (chance(want.contour_chance)) {
        node.contour_mask |= bit;
        const auto component = [&] { return static_cast<std::int32_t>(random() % 63) - 31; };
        Vec3i normal{component(), component(), component()};
        if (normal == Vec3i{}) normal.x = 1;
        int low = static_cast<int>(random() % 128), high = static_cast<int>(random() % 128);
        if (low > high) std::swap(low, high);
        tree.contours.push_back(Contour::make(normal, low, high));
      }
      if (want.with_values) {
        VoxelValue value;
        for (auto& channel : value.color) channel = static_cast<std::uint8_t>(random() % 256);
        value.normal = {1, 0, 0};
        tree.values.push_back(value);
      }
    }
    tree.nodes[at] = node;
  }
  return tree;
}

/// Returns the nodes and contours of a packed octree, breadth first as random_tree() makes them.
inline EsvoTree unpack(const EsvoView& esvo) {
  EsvoTree tree;
  std::vector<std::uint64_t> slots{esvo.root};
  for (std::size_t at = 0; at < slots.size(); ++at) {
    const ChildDescriptor d = esvo.descriptor(slots[at]);
    EsvoNode node;
    node.valid_mask = static_cast<std::uint8_t>(d.valid_mask());
    node.leaf_mask = static_cast<std::uint8_t>(d.leaf_mask());
    node.contour_mask = static_cast<std::uint8_t>(d.contour_mask());
    node.first_child = static_cast<std::uint32_t>(slots.size());
    node.first_contour = static_cast<std::uint32_t>(tree.contours.size());
    for (int i = 0; i < 8; ++i) {
      if ((d.inner_mask() >> i & 1) != 0) slots.push_back(esvo.child(slots[at], d, i));
      if ((d.contour_mask() >> i & 1) != 0) tree.contours.push_back(esvo.contour(slots[at], d, i));
    }
    tree.nodes.push_back(node);
  }
  return tree;
}

}  // namespace voxdag::test

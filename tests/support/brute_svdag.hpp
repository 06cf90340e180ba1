#pragma once
/// Builds the minimal DAG of a set of voxels by a slow and obvious method: the reference for the
/// builders.
#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <map>
#include <random>
#include <utility>
#include <vector>

#include "voxdag/core/morton.hpp"
#include "voxdag/stored/svdag/svdag.hpp"

namespace voxdag {

/// Builds the whole octree of `voxels` (coordinates in [0, 2^levels), duplicates allowed) level by
/// level with std::map, merges equal nodes of a level, and numbers the unique nodes in the
/// canonical order of svdag.hpp. Shares no code with the library but the Svdag type.
class BruteSvdagBuilder {
 public:
  BruteSvdagBuilder(int levels, const std::vector<Vec3i>& voxels) : levels_(levels) {
    merge_leaf_blocks(voxels);
    for (int level = levels - 3; level >= 0; --level) merge_level(level);
    ranks_.resize(levels - 1);
    order_.resize(levels - 1);
    if (!cells_.empty()) visit(0, cells_.begin()->second);
  }

  Svdag build() const {
    Svdag dag;
    dag.levels = levels_;
    std::vector<std::vector<std::uint32_t>> address(levels_ - 1);
    std::uint32_t words = 0;
    for (int level = 0; level < levels_ - 2; ++level) {
      dag.level_begin[level] = words;
      for (const int id : order_[level]) {
        address[level].push_back(words);
        words += 1 + child_count(nodes_[level][id]);
      }
    }
    for (int level = levels_ - 2; level <= kMaxLevels; ++level) dag.level_begin[level] = words;
    for (std::size_t i = 0; i < order_[levels_ - 2].size(); ++i)
      address[levels_ - 2].push_back(static_cast<std::uint32_t>(i));

    for (int level = 0; level < levels_ - 2; ++level)
      for (const int id : order_[level]) {
        const Children& children = nodes_[level][id];
        std::uint32_t mask = 0;
        for (int i = 0; i < 8; ++i)
          if (children[i] >= 0) mask |= 1u << i;
        dag.nodes.push_back(mask);
        for (const int child : children)
          if (child >= 0) dag.nodes.push_back(address[level + 1][ranks_[level + 1].at(child)]);
      }
    for (const int id : order_[levels_ - 2]) dag.leaf_blocks.push_back(leaf_masks_[id]);
    return dag;
  }

 private:
  using Cell = std::array<int, 3>;
  using Children = std::array<int, 8>;  ///< Ids in the next level; -1: no child.

  static int child_count(const Children& children) {
    return static_cast<int>(8 - std::count(children.begin(), children.end(), -1));
  }

  void merge_leaf_blocks(const std::vector<Vec3i>& voxels) {
    std::map<Cell, std::uint64_t> masks;
    for (const Vec3i v : voxels) {
      if (std::min({v.x, v.y, v.z}) < 0 || std::max({v.x, v.y, v.z}) >> levels_ != 0) std::abort();
      // Morton order in a block: the high bits choose the octant, the low bits the voxel.
      const int octant = child_index(v, 1), voxel = child_index(v, 0);
      masks[{v.x >> 2, v.y >> 2, v.z >> 2}] |= std::uint64_t{1} << (8 * octant + voxel);
    }
    std::map<std::uint64_t, int> ids;
    for (const auto& [cell, mask] : masks) {
      const auto [it, is_new] = ids.try_emplace(mask, static_cast<int>(leaf_masks_.size()));
      if (is_new) leaf_masks_.push_back(mask);
      cells_[cell] = it->second;
    }
    nodes_.resize(levels_ - 2);
  }

  void merge_level(int level) {
    std::map<Cell, Children> parents;
    for (const auto& [cell, id] : cells_) {
      Children none;
      none.fill(-1);
      Children& parent =
          parents.try_emplace({cell[0] >> 1, cell[1] >> 1, cell[2] >> 1}, none).first->second;
      parent[(cell[0] & 1) + 2 * (cell[1] & 1) + 4 * (cell[2] & 1)] = id;
    }
    std::map<Children, int> ids;
    cells_.clear();
    for (const auto& [cell, children] : parents) {
      const auto [it, is_new] = ids.try_emplace(children, static_cast<int>(nodes_[level].size()));
      if (is_new) nodes_[level].push_back(children);
      cells_[cell] = it->second;
    }
  }

  void visit(int level, int id) {
    const int rank = static_cast<int>(order_[level].size());
    if (!ranks_[level].try_emplace(id, rank).second) return;
    order_[level].push_back(id);
    if (level == levels_ - 2) return;
    for (const int child : nodes_[level][id])
      if (child >= 0) visit(level + 1, child);
  }

  int levels_;
  std::map<Cell, int> cells_;  ///< Non-empty cells of the current level, with their ids.
  std::vector<std::uint64_t> leaf_masks_;
  std::vector<std::vector<Children>> nodes_;  ///< [level][id]
  std::vector<std::map<int, int>> ranks_;     ///< [level]: id to canonical rank
  std::vector<std::vector<int>> order_;       ///< [level]: ids in canonical order
};

/// Builds the DAG with a BruteSvdagBuilder. O(voxels × levels × log): for small sets.
inline Svdag brute_svdag(int levels, const std::vector<Vec3i>& voxels) {
  return BruteSvdagBuilder(levels, voxels).build();
}

/// Returns at least `count` random voxels of a grid of 2^levels. Half of them lie in a small corner
/// that is repeated half a grid away, so that nodes of several levels are shared. Depends on the
/// seed alone.
inline std::vector<Vec3i> random_voxels(int levels, int count, unsigned seed) {
  std::mt19937 rng(seed);
  const std::int32_t last = (1 << levels) - 1;
  const auto below = [&](std::int32_t n) {
    return static_cast<std::int32_t>(rng() % static_cast<unsigned>(n));
  };
  std::vector<Vec3i> voxels;
  for (int i = 0; i < count; ++i) {
    Vec3i v{below(last + 1), below(last + 1), below(last + 1)};
    if (i % 2 == 1) {
      const std::int32_t n = std::min(8, last + 1);
      v = {below(n), below(n), below(n)};
      // Repeats the voxel half a grid away: equal subtrees.
      const std::int32_t half = (last + 1) / 2;
      if (levels > 3) voxels.push_back({v.x + half, v.y, v.z + half});
    }
    voxels.push_back(v);
  }
  return voxels;
}

}  // namespace voxdag

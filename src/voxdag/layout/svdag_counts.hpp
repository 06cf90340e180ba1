#pragma once
/// How many nodes a DAG has, and how many the octree has that it stands for.
#include <cstdint>
#include <vector>

#include "voxdag/layout/svdag.hpp"

namespace voxdag {

/// Levels 0..L-1, root first. Level L-1 is that of the 2³ nodes whose children are voxels; the DAG
/// counts its unique ones although the layout stores them inside the leaf blocks.
struct SvdagCounts {
  std::uint64_t voxels = 0;
  std::vector<std::uint64_t> svo_nodes_per_level;
  std::vector<std::uint64_t> dag_nodes_per_level;

  std::uint64_t svo_nodes() const;
  std::uint64_t dag_nodes() const;
  friend bool operator==(const SvdagCounts&, const SvdagCounts&) = default;
};

/// Counts by one pass over the DAG from the root down. Serial; O(DAG) time, 16 bytes per node of
/// the two largest neighbouring levels. The view must be valid (see validate_svdag).
SvdagCounts count_svdag(const SvdagView& dag);

}  // namespace voxdag

#pragma once
/// Counts of the nodes of a DAG, and of the octree that it represents.
#include <cstdint>
#include <vector>

#include "voxdag/stored/svdag/long_svdag.hpp"
#include "voxdag/stored/svdag/svdag.hpp"

namespace voxdag {

/// Levels 0..L-1, root first. A node of level L-1 has 2³ voxels. The counts of the DAG include the
/// unique nodes of level L-1, although the layout stores them inside leaf blocks.
struct SvdagCounts {
  std::uint64_t voxels = 0;
  std::vector<std::uint64_t> svo_nodes_per_level;
  std::vector<std::uint64_t> dag_nodes_per_level;

  std::uint64_t svo_nodes() const;
  std::uint64_t dag_nodes() const;
  friend bool operator==(const SvdagCounts&, const SvdagCounts&) = default;
};

/// Counts the nodes in one pass over the DAG from the root down. Serial; O(DAG) time, 16 bytes per
/// node of the two largest neighbouring levels. The view must be valid (see validate_svdag).
SvdagCounts count_svdag(const SvdagView& dag);
SvdagCounts count_svdag(const LongSvdagView& dag);

}  // namespace voxdag

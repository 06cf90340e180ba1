#pragma once
/// Connected regions of a DAG's voxels, or of the places without voxels, found per node.
///
/// A node has the same regions wherever it occurs, as far as its own cell shows. A region that
/// touches no side of the cell is *closed*: it is a whole region of the grid. The others are
/// *open*: a region of the node above consists of those of its children that touch each other. So
/// each different node is visited once, and not each voxel.
///
/// Which regions of two cells side by side touch follows from the two nodes alone, and is found by
/// recursion over their children, once for each different pair.
#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "voxdag/algebra/grow.hpp"
#include "voxdag/algebra/source_dag.hpp"
#include "voxdag/core/parallel/work.hpp"
#include "voxdag/stored/svdag/unique_cells.hpp"

namespace voxdag {

/// Regions of voxels, or of places without voxels.
enum class RegionKind { kVoxels, kEmpty };

/// The regions of all nodes. Numbers of a node's regions count from 0, the open ones first. A node
/// kNoCell stands for a cell without voxels.
class Regions {
 public:
  /// `dag` must be valid and outlive this object. Throws OverMemory and Cancelled.
  Regions(const SvdagView& dag, RegionKind kind, Neighbours neighbours, Work work);

  struct Counts {
    std::uint32_t open = 0, closed = 0;
  };
  Counts counts(int level, std::uint32_t node) const;
  /// Returns the number of voxels, or of places without voxels, of a region.
  std::uint64_t size(int level, std::uint32_t node, std::uint32_t region) const;
  /// Returns the region of `node` that open region `region` of its child belongs to.
  std::uint32_t region_above(int level, std::uint32_t node, int child, std::uint32_t region) const;
  /// Returns whether the node, or a node below it, has closed regions.
  bool has_closed(int level, std::uint32_t node) const {
    return node != kNoCell && record(level, node).has_closed;
  }
  /// Returns a voxel, or a place without a voxel, of a region, counted from the node's first one.
  Vec3i place_in(int level, std::uint32_t node, std::uint32_t region) const;
  /// Returns the voxels of a region of a leaf block.
  std::uint64_t block_voxels(std::uint32_t block, std::uint32_t region) const;

  const SourceDag& source() const { return source_; }
  int levels() const { return levels_; }

 private:
  using Touch = std::pair<std::uint32_t, std::uint32_t>;

  /// The regions of a node are regions_[level][first_region + region].
  struct Node {
    std::uint32_t open, closed;
    bool has_closed;
    std::uint64_t first_region, first_above;
  };
  struct Region {
    std::uint64_t size = 0;
    std::uint8_t sides = 0;  ///< Bit 2a: touches the low side of axis a, 2a + 1: the high one.
  };
  /// Says which region of a node each open region of its children belongs to. `words` lists where
  /// the regions of each child begin, then their total, then the region above each of them.
  struct RegionsAbove {
    const std::uint32_t* words;

    std::uint32_t count(int child) const { return words[child + 1] - words[child]; }
    std::uint32_t of(int child, std::uint32_t region) const {
      return words[9 + words[child] + region];
    }
  };
  struct List {
    std::uint64_t begin = 0;
    std::uint32_t count = 0;
  };
  /// The pairs of nodes of a level whose touching regions are known.
  struct Pairs {
    explicit Pairs(MemoryBudget* memory) : keys(memory), lists(memory), touches(memory) {}
    UniqueCells<std::array<std::uint32_t, 3>> keys;
    CountedVector<List> lists;
    CountedVector<Touch> touches;
  };

  void number_nodes(const SvdagView& dag);
  void find_blocks(const SvdagView& dag);
  void find_nodes(const SvdagView& dag, int level);
  RegionsAbove regions_above(int level, std::uint32_t node) const;
  /// Adds a node of `level` with these regions, the open ones first.
  void add_node(int level, const std::vector<Region>& regions, std::uint64_t first_above,
                bool has_closed_below);
  const Node& record(int level, std::uint32_t node) const;
  bool is_whole(std::uint32_t node) const { return node == kNoCell && kind_ == RegionKind::kEmpty; }
  /// Appends the pairs of regions of `a` and `b` that touch. `b` is the cell beside `a` in this
  /// direction.
  void add_touches(int level, std::uint32_t a, std::uint32_t b, int direction,
                   std::vector<Touch>& touches);
  List touches_of_nodes(int level, std::uint32_t a, std::uint32_t b, int direction);
  void add_touches_of_blocks(std::uint32_t a, std::uint32_t b, int direction,
                             std::vector<Touch>& touches) const;

  SourceDag source_;
  int levels_;
  RegionKind kind_;
  Neighbours neighbours_;
  Work work_;
  /// The number of the node that begins at a word, for each level above the leaf blocks.
  std::vector<CountedVector<std::uint32_t>> numbers_;
  std::vector<std::uint64_t> level_begin_;
  std::vector<CountedVector<Node>> nodes_;
  std::vector<CountedVector<Region>> regions_;
  /// For each node above the leaf blocks: the words of its RegionsAbove.
  std::vector<CountedVector<std::uint32_t>> above_;
  CountedVector<std::uint64_t> block_voxels_;
  std::vector<Pairs> pairs_;
};

}  // namespace voxdag

// Cells and their children in the depth-first builder; compiled once for each instruction set.
//
// The parent interns a cell's node after all siblings are known. The memory of the table is
// prefetched when the node's words are complete, so it has arrived by then.
#if defined(VOXDAG_CELL_CHILDREN_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef VOXDAG_CELL_CHILDREN_INL
#undef VOXDAG_CELL_CHILDREN_INL
#else
#define VOXDAG_CELL_CHILDREN_INL
#endif

#include <hwy/highway.h>

#include <array>
#include <cstdint>

#include "voxdag/builders/dag/node_store.hpp"
#include "voxdag/builders/voxelize/block_bits.hpp"
#include "voxdag/builders/voxelize/cell_triangle-inl.hpp"
#include "voxdag/core/morton.hpp"

HWY_BEFORE_NAMESPACE();
namespace voxdag {
namespace HWY_NAMESPACE {

/// A finished cell: a node still to be interned, or the id of one. An empty cell has neither.
struct Cell {
  PendingNode pending;
  NodeId id = kNoNode;
};

/// Collects the children of one cell. Each child has 2^log2_size voxels a side.
template <class Sink>
class Children {
 public:
  Children(Sink& sink, int levels, int log2_size)
      : sink_(sink), log2_size_(log2_size), level_(levels - log2_size) {}

  void add(int child, const Cell& cell) {
    if (cell.pending.count == 0 && cell.id == kNoNode) return;
    mask_ |= 1u << child;
    Cell& added = cells_[count_++];
    added = cell;
    if (cell.pending.count != 0) sink_.prefetch(level_, added.pending);
  }
  /// Interns the children and returns their parent.
  PendingNode node() {
    PendingNode parent;
    if (count_ == 0) return parent;
    parent.words[0] = mask_;
    for (int i = 0; i < count_; ++i)
      if (cells_[i].pending.count != 0) sink_.prefetch_found(level_, cells_[i].pending);
    for (int i = 0; i < count_; ++i) {
      const Cell& cell = cells_[i];
      parent.words[1 + i] = cell.pending.count == 0 ? cell.id
                            : log2_size_ == 2       ? sink_.leaf(cell.pending)
                                                    : sink_.node(level_, cell.pending);
    }
    parent.count = 1 + count_;
    return parent;
  }

 private:
  Sink& sink_;
  int log2_size_, level_;
  std::uint32_t mask_ = 0;
  int count_ = 0;
  Cell cells_[8];
};

/// Interns a cell of 2^log2_size voxels a side; returns kNoNode for an empty one.
template <class Sink>
NodeId intern_cell(Sink& sink, int levels, int log2_size, const Cell& cell) {
  Children<Sink> self(sink, levels, log2_size);
  self.add(0, cell);
  const PendingNode interned = self.node();
  return interned.count == 0 ? kNoNode : interned.words[1];
}

/// Returns the cell of a leaf block's voxels, in linear order.
HWY_INLINE Cell leaf_block_cell(std::uint64_t linear_mask) {
  Cell cell;
  if (linear_mask == 0) return cell;
  const std::uint64_t mask = linear_to_morton(linear_mask);
  cell.pending.words[0] = static_cast<std::uint32_t>(mask);
  cell.pending.words[1] = static_cast<std::uint32_t>(mask >> 32);
  cell.pending.count = 2;
  return cell;
}

/// Returns the first voxel of a child of the cell at `at`; children have `half` voxels a side.
HWY_INLINE Vec3i child_origin(Vec3i at, std::int32_t half, int child) {
  return {at.x + (child & 1) * half, at.y + ((child >> 1) & 1) * half,
          at.z + ((child >> 2) & 1) * half};
}

/// Builds a cell of 2^log2_size voxels a side from its grandchildren in the mask `any` (Morton
/// order). grandchild(code, log2_size - 2, first voxel) returns each of them.
template <class Sink, class Grandchild>
HWY_INLINE Cell cell_of_grandchildren(Sink& sink, int levels, Vec3i at, int log2_size,
                                      std::uint64_t any, const Grandchild& grandchild) {
  const int log2_child = log2_size - 2;
  Children<Sink> octants(sink, levels, log2_size - 1);
  for (int octant = 0; octant < 8; ++octant) {
    std::uint64_t left = any & (std::uint64_t{0xFF} << (8 * octant));
    if (left == 0) continue;
    Children<Sink> children(sink, levels, log2_child);
    for (; left != 0; left &= left - 1) {
      const int code = static_cast<int>(hwy::Num0BitsBelowLS1Bit_Nonzero64(left));
      const Vec3i step = morton_decode(static_cast<std::uint64_t>(code));
      const Vec3i child_at{at.x + (step.x << log2_child), at.y + (step.y << log2_child),
                           at.z + (step.z << log2_child)};
      children.add(code & 7, grandchild(code, log2_child, child_at));
    }
    octants.add(octant, {children.node(), kNoNode});
  }
  return {octants.node(), kNoNode};
}

/// Maps a Morton code in a cell of 4³ blocks to x + 4y + 16z.
inline constexpr std::array<std::uint8_t, 64> kMortonToLinear = [] {
  std::array<std::uint8_t, 64> table{};
  for (unsigned code = 0; code < 64; ++code) {
    const Vec3i at = morton_decode(code);
    table[code] = static_cast<std::uint8_t>(at.x + 4 * at.y + 16 * at.z);
  }
  return table;
}();

/// Rasterises triangles into the 4³ leaf blocks of a cell of 16³ voxels.
class BlockMasks {
 public:
  explicit BlockMasks(Vec3i cell) : cell_(cell) {}

  HWY_INLINE void add(const TriangleSetup& t, std::uint32_t conditions) {
    const std::uint64_t met = enter_cell(t, conditions, cell_, triangle_);
    any_ |= met;
    for (std::uint64_t left = met; left != 0; left &= left - 1) {
      const int place = static_cast<int>(hwy::Num0BitsBelowLS1Bit_Nonzero64(left));
      const Vec3i block{place & 3, (place >> 2) & 3, place >> 4};
      masks_[place] |=
          triangle_.wide
              ? triangle_children(
                    t, conditions,
                    {cell_.x + 4 * block.x, cell_.y + 4 * block.y, cell_.z + 4 * block.z}, 0)
              : block_voxels(triangle_, block);
    }
  }

  /// Interns the blocks and returns the cell.
  template <class Sink>
  Cell cell(Sink& sink, int levels) const {
    std::uint64_t blocks[64];
    std::uint32_t codes[64];
    NodeId ids[64];
    int block_count = 0;
    for (std::uint64_t left = linear_to_morton(any_); left != 0; left &= left - 1) {
      const auto code = static_cast<std::uint32_t>(hwy::Num0BitsBelowLS1Bit_Nonzero64(left));
      const std::uint64_t mask = masks_[kMortonToLinear[code]];
      if (mask == 0) continue;
      blocks[block_count] = linear_to_morton(mask);
      codes[block_count++] = code;
    }
    sink.leaves(blocks, block_count, ids);
    Children<Sink> octants(sink, levels, 3);
    for (int i = 0; i < block_count;) {
      const std::uint32_t octant = codes[i] >> 3;
      Cell cell;
      std::uint32_t* words = cell.pending.words;
      words[0] = 0;
      cell.pending.count = 1;
      for (; i < block_count && codes[i] >> 3 == octant; ++i) {
        words[0] |= 1u << (codes[i] & 7);
        words[cell.pending.count++] = ids[i];
      }
      octants.add(static_cast<int>(octant), cell);
    }
    return {octants.node(), kNoNode};
  }

 private:
  Vec3i cell_;
  std::uint64_t masks_[64] = {};
  std::uint64_t any_ = 0;
  CellTriangle triangle_;
};

}  // namespace HWY_NAMESPACE
}  // namespace voxdag
HWY_AFTER_NAMESPACE();

#endif

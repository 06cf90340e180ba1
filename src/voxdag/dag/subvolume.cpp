// The depth-first recursion of the builder. Compiled once for each instruction set; the best that
// the machine has is chosen at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "voxdag/dag/subvolume.cpp"
#include "voxdag/dag/subvolume.hpp"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <numeric>

#include "voxdag/core/morton.hpp"
#include "voxdag/voxelize/block_bits.hpp"
#include "voxdag/voxelize/block_raster-inl.hpp"
#include "voxdag/voxelize/cell_classify.hpp"
#include "voxdag/voxelize/cell_triangle-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace voxdag {
namespace HWY_NAMESPACE {
namespace {

constexpr std::uint64_t kUnbounded = ~std::uint64_t{0} >> 2;

/// x + 4y + 16z of the block with a Morton code in a cell of 4³.
constexpr std::array<std::uint8_t, 64> kMortonToLinear = [] {
  std::array<std::uint8_t, 64> table{};
  for (unsigned code = 0; code < 64; ++code) {
    const Vec3i at = morton_decode(code);
    table[code] = static_cast<std::uint8_t>(at.x + 4 * at.y + 16 * at.z);
  }
  return table;
}();

// A cell's node is interned by its parent, after all its siblings are known: by then the table's
// memory, asked for as soon as the words were, has arrived.
template <class Sink>
class Recursion {
 public:
  using Context = SubvolumeContext<Sink>;
  using Item = typename Context::Item;
  using Classified = typename Context::Classified;

  explicit Recursion(Context& context) : context_(context), sink_(context.sink) {}

  NodeId root(int log2_size, std::size_t count) {
    Children children(*this, log2_size);
    children.add(0, cell({0, 0, 0}, log2_size, 0, count));
    const PendingNode root = children.node();
    return root.count == 0 ? kNoNode : root.words[1];
  }

 private:
  /// What a cell turned out to be: a node still to be interned, or the id of one.
  struct Cell {
    PendingNode pending;
    NodeId id = kNoNode;
  };

  /// The children of one cell, of 2^log2_size voxels a side each.
  class Children {
   public:
    Children(Recursion& recursion, int log2_size)
        : sink_(recursion.sink_),
          log2_size_(log2_size),
          level_(recursion.context_.levels - log2_size) {}

    void add(int child, const Cell& cell) {
      if (cell.pending.count == 0 && cell.id == kNoNode) return;
      mask_ |= 1u << child;
      Cell& added = cells_[count_++];
      added = cell;
      if (cell.pending.count != 0) sink_.prefetch(level_, added.pending);
    }
    /// The parent.
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

  static Vec3i child_cell(Vec3i at, std::int32_t half, int child) {
    return at + child_offset(child) * half;
  }

  /// Where the column of a cell is inside the triangle its plane alone matters.
  Item child_item(std::uint32_t triangle, std::uint64_t conditions) const {
    std::uint32_t left = static_cast<std::uint32_t>(conditions & 0xFFFF);
    const TriangleSetup& t = context_.setups[triangle];
    if ((left & kPlane) && (left & t.dominant_edges) == 0) left = kPlane;
    return {triangle, left};
  }

  static Cell block(std::uint64_t linear_mask) {
    Cell cell;
    if (linear_mask == 0) return cell;
    const std::uint64_t mask = linear_to_morton(linear_mask);
    cell.pending.words[0] = static_cast<std::uint32_t>(mask);
    cell.pending.words[1] = static_cast<std::uint32_t>(mask >> 32);
    cell.pending.count = 2;
    return cell;
  }

  /// The cell of 2^log2_size voxels at `at`, from `count` items on the stack at `first`.
  Cell cell(Vec3i at, int log2_size, std::size_t first, std::size_t count) {
    if (count == 1) return single(at, log2_size, context_.items[first]);
    if (log2_size == 2) {
      std::uint64_t mask = 0;
      for (std::size_t i = first; i < first + count; ++i) {
        const Item& item = context_.items[i];
        mask |= triangle_children(context_.setups[item.triangle], item.conditions, at, 0);
      }
      return block(mask);
    }
    if (log2_size == 4) return cell_of_blocks(at, first, count);
    return log2_size % 2 == 0 ? cell_by_64(at, log2_size, first, count)
                              : cell_by_8(at, log2_size, first, count);
  }

  /// One level down: for the odd size, of which a sub-volume has at most one.
  Cell cell_by_8(Vec3i at, int log2_size, std::size_t first, std::size_t count) {
    const std::int32_t half = std::int32_t{1} << (log2_size - 1);
    const std::size_t list = context_.items.size();
    Children children(*this, log2_size - 1);
    for (int child = 0; child < 8; ++child) {
      const Vec3i child_at = child_cell(at, half, child);
      for (std::size_t i = first; i < first + count; ++i) {
        const Item item = context_.items[i];
        const TriangleSetup& t = context_.setups[item.triangle];
        const ChildConditions c = classify_children(t, item.conditions, at, half);
        if ((c.alive >> child) & 1) context_.items.push_back({item.triangle, c.conditions(child)});
      }
      if (context_.items.size() != list)
        children.add(child, cell(child_at, log2_size - 1, list, context_.items.size() - list));
      context_.items.resize(list);
    }
    return {children.node(), kNoNode};
  }

  /// A cell of 16³ voxels: all leaf blocks that each triangle meets, then all leaf blocks' ids.
  Cell cell_of_blocks(Vec3i at, std::size_t first, std::size_t count) {
    std::uint64_t masks[64] = {};
    std::uint64_t any = 0;
    CellTriangle triangle;
    for (std::size_t i = first; i < first + count; ++i) {
      const Item item = context_.items[i];
      const TriangleSetup& t = context_.setups[item.triangle];
      const std::uint64_t met = enter_cell(t, item.conditions, at, triangle);
      any |= met;
      for (std::uint64_t left = met; left != 0; left &= left - 1) {
        const int place = static_cast<int>(hwy::Num0BitsBelowLS1Bit_Nonzero64(left));
        const Vec3i block{place & 3, (place >> 2) & 3, place >> 4};
        masks[place] |=
            triangle.wide
                ? triangle_children(t, item.conditions,
                                    {at.x + 4 * block.x, at.y + 4 * block.y, at.z + 4 * block.z}, 0)
                : block_voxels(triangle, block);
      }
    }
    std::uint64_t blocks[64];
    std::uint32_t codes[64];
    NodeId ids[64];
    int block_count = 0;
    for (std::uint64_t left = linear_to_morton(any); left != 0; left &= left - 1) {
      const auto code = static_cast<std::uint32_t>(hwy::Num0BitsBelowLS1Bit_Nonzero64(left));
      const std::uint64_t mask = masks[kMortonToLinear[code]];
      if (mask == 0) continue;
      blocks[block_count] = linear_to_morton(mask);
      codes[block_count++] = code;
    }
    sink_.leaves(blocks, block_count, ids);
    Children octants(*this, 3);
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

  /// Two levels down at once: each triangle's 4³ grandchildren as one mask.
  Cell cell_by_64(Vec3i at, int log2_size, std::size_t first, std::size_t count) {
    const int log2_child = log2_size - 2;
    const std::size_t classified = context_.classified.size();
    std::uint64_t any = 0;
    for (std::size_t i = first; i < first + count; ++i) {
      const Item item = context_.items[i];
      const TriangleSetup& t = context_.setups[item.triangle];
      const std::uint32_t open = open_conditions(t, item.conditions, at, 1 << log2_size);
      const std::uint64_t met = linear_to_morton(triangle_children(t, open, at, log2_child));
      any |= met;
      if (met != 0) context_.classified.push_back({item.triangle, open, met});
    }
    // The children's lists, one after the other on the stack.
    std::array<std::uint32_t, 65> begin{};
    for (std::size_t i = classified; i < context_.classified.size(); ++i)
      for (std::uint64_t left = context_.classified[i].met; left != 0; left &= left - 1)
        ++begin[hwy::Num0BitsBelowLS1Bit_Nonzero64(left) + 1];
    std::partial_sum(begin.begin(), begin.end(), begin.begin());
    const std::size_t lists = context_.items.size();
    context_.items.resize(lists + begin[64]);
    std::array<std::uint32_t, 65> next = begin;
    for (std::size_t i = classified; i < context_.classified.size(); ++i) {
      const Classified& c = context_.classified[i];
      for (std::uint64_t left = c.met; left != 0; left &= left - 1)
        context_.items[lists + next[hwy::Num0BitsBelowLS1Bit_Nonzero64(left)]++] = {c.triangle,
                                                                                    c.conditions};
    }
    context_.classified.resize(classified);

    Children octants(*this, log2_size - 1);
    for (int octant = 0; octant < 8; ++octant) {
      std::uint64_t left = any & (std::uint64_t{0xFF} << (8 * octant));
      if (left == 0) continue;
      Children children(*this, log2_child);
      for (; left != 0; left &= left - 1) {
        const int code = static_cast<int>(hwy::Num0BitsBelowLS1Bit_Nonzero64(left));
        const Vec3i step = morton_decode(static_cast<std::uint64_t>(code));
        const Vec3i child_at{at.x + (step.x << log2_child), at.y + (step.y << log2_child),
                             at.z + (step.z << log2_child)};
        children.add(code & 7, listed_cell(child_at, log2_child, lists + begin[code],
                                           begin[code + 1] - begin[code]));
      }
      octants.add(octant, {children.node(), kNoNode});
    }
    context_.items.resize(lists);
    return {octants.node(), kNoNode};
  }

  /// A cell whose items have the conditions of its parent.
  Cell listed_cell(Vec3i at, int log2_size, std::size_t first, std::size_t count) {
    // enter_cell() sees for itself which conditions are open.
    if (log2_size == 4 && count > 1) return cell_of_blocks(at, first, count);
    for (std::size_t i = first; i < first + count; ++i) {
      Item& item = context_.items[i];
      item.conditions =
          open_conditions(context_.setups[item.triangle], item.conditions, at, 1 << log2_size);
    }
    return cell(at, log2_size, first, count);
  }

  Cell single(Vec3i at, int log2_size, const Item item) {
    const TriangleSetup& t = context_.setups[item.triangle];
    if (log2_size == 2) return block(triangle_children(t, item.conditions, at, 0));
    if constexpr (Sink::kMemo) {
      if (item.conditions == kPlane) {
        const int range = slab_range(t, at, std::int32_t{1} << log2_size);
        if (range == 0) return {};
        if (range == 1) return {{}, slab(t.plane, slab_lo_at(t, at), log2_size).id};
      }
    }
    const std::int32_t half = std::int32_t{1} << (log2_size - 1);
    const ChildConditions conditions = classify_children(t, item.conditions, at, half);
    Children children(*this, log2_size - 1);
    for (std::uint32_t left = conditions.alive; left != 0; left &= left - 1) {
      const int child = static_cast<int>(hwy::Num0BitsBelowLS1Bit_Nonzero32(left));
      children.add(child, single(child_cell(at, half, child), log2_size - 1,
                                 child_item(item.triangle, conditions.conditions(child))));
    }
    return {children.node(), kNoNode};
  }

  /// The node of a cell that holds a slab and nothing else, by way of the memo. Not for leaf
  /// blocks.
  SlabNode slab(const PlaneSlab& plane, std::int64_t lo, int log2_size) {
    SlabNode result;
    if (sink_.memo.find(plane, lo, log2_size, result)) return result;
    result = {kNoNode, kUnbounded, kUnbounded};
    const std::int64_t half = std::int64_t{1} << (log2_size - 1), last = half - 1;
    const Vec3l& n = plane.normal;
    const std::int64_t most =
        last * (detail::positive(n.x) + detail::positive(n.y) + detail::positive(n.z));
    const std::int64_t least =
        last * (detail::negative(n.x) + detail::negative(n.y) + detail::negative(n.z));
    Children children(*this, log2_size - 1);
    for (int child = 0; child < 8; ++child) {
      const std::int64_t child_lo = lo - (child & 1 ? n.x * half : 0) -
                                    (child & 2 ? n.y * half : 0) - (child & 4 ? n.z * half : 0);
      std::uint64_t down = kUnbounded, up = kUnbounded;
      if (child_lo > most) {
        down = static_cast<std::uint64_t>(child_lo - most - 1);
      } else if (child_lo + plane.width < least) {
        up = static_cast<std::uint64_t>(least - child_lo - plane.width - 1);
      } else if (log2_size == 3) {
        const SlabBlock part = slab_block(plane, child_lo);
        children.add(child, block(part.mask));
        down = part.down, up = part.up;
      } else {
        const SlabNode part = slab(plane, child_lo, log2_size - 1);
        children.add(child, {{}, part.id});
        down = part.down, up = part.up;
      }
      result.down = std::min(result.down, down);
      result.up = std::min(result.up, up);
    }
    Children self(*this, log2_size);
    self.add(0, {children.node(), kNoNode});
    const PendingNode interned = self.node();
    if (interned.count != 0) result.id = interned.words[1];
    sink_.memo.insert(plane, lo, log2_size, result);
    return result;
  }

  Context& context_;
  Sink& sink_;
};

template <class Sink>
NodeId build(SubvolumeContext<Sink>& context, const SubvolumeJob& job) {
  context.setups.clear();
  context.items.clear();
  for (std::uint32_t index : job.triangles) {
    const TriangleSetup& t =
        context.setups.emplace_back(make_triangle_setup(context.mesh->triangle(index), job.origin));
    context.items.push_back({static_cast<std::uint32_t>(context.setups.size() - 1), t.conditions});
  }
  if (context.items.empty()) return kNoNode;
  return Recursion<Sink>(context).root(job.log2_size, context.items.size());
}

}  // namespace

NodeId build_dag(SubvolumeContext<DagSink>& context, const SubvolumeJob& job) {
  return build(context, job);
}
NodeId build_tree(SubvolumeContext<TreeSink>& context, const SubvolumeJob& job) {
  return build(context, job);
}

}  // namespace HWY_NAMESPACE
}  // namespace voxdag
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace voxdag {

HWY_EXPORT(build_dag);
HWY_EXPORT(build_tree);

NodeId build_subvolume(SubvolumeContext<DagSink>& context, const SubvolumeJob& job) {
  return HWY_DYNAMIC_DISPATCH(build_dag)(context, job);
}
NodeId build_subvolume(SubvolumeContext<TreeSink>& context, const SubvolumeJob& job) {
  return HWY_DYNAMIC_DISPATCH(build_tree)(context, job);
}

}  // namespace voxdag
#endif

// The depth-first recursion over cells whose triangles are set up and listed; compiled once for
// each instruction set.
#if defined(VOXDAG_LISTED_CELLS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef VOXDAG_LISTED_CELLS_INL
#undef VOXDAG_LISTED_CELLS_INL
#else
#define VOXDAG_LISTED_CELLS_INL
#endif

#include <algorithm>
#include <array>
#include <cstdint>
#include <numeric>

#include "voxdag/builders/dag/cell_children-inl.hpp"
#include "voxdag/builders/dag/plane_memo.hpp"
#include "voxdag/builders/dag/subvolume.hpp"
#include "voxdag/builders/voxelize/cell_classify.hpp"
#include "voxdag/core/parallel/polled_for.hpp"

HWY_BEFORE_NAMESPACE();
namespace voxdag {
namespace HWY_NAMESPACE {

/// Returns the node of a cell of 2^log2_size voxels a side (at least 8) that contains the voxels of
/// a slab, whose least value relative to the cell is `lo`, and nothing else (see "Plane memo" in
/// the design).
template <class Sink>
SlabNode slab_cell(Sink& sink, int levels, const PlaneSlab& plane, std::int64_t lo, int log2_size) {
  constexpr std::uint64_t kUnbounded = ~std::uint64_t{0} >> 2;
  SlabNode result;
  if (sink.memo.find(plane, lo, log2_size, result)) return result;
  result = {kNoNode, kUnbounded, kUnbounded};
  const std::int64_t half = std::int64_t{1} << (log2_size - 1), last = half - 1;
  const Vec3l& n = plane.normal;
  const std::int64_t most =
      last * (detail::positive(n.x) + detail::positive(n.y) + detail::positive(n.z));
  const std::int64_t least =
      last * (detail::negative(n.x) + detail::negative(n.y) + detail::negative(n.z));
  Children<Sink> children(sink, levels, log2_size - 1);
  for (int child = 0; child < 8; ++child) {
    const std::int64_t child_lo = lo - (child & 1 ? n.x * half : 0) - (child & 2 ? n.y * half : 0) -
                                  (child & 4 ? n.z * half : 0);
    std::uint64_t down = kUnbounded, up = kUnbounded;
    if (child_lo > most) {
      down = static_cast<std::uint64_t>(child_lo - most - 1);
    } else if (child_lo + plane.width < least) {
      up = static_cast<std::uint64_t>(least - child_lo - plane.width - 1);
    } else if (log2_size == 3) {
      const SlabBlock part = slab_block(plane, child_lo);
      children.add(child, leaf_block_cell(part.mask));
      down = part.down, up = part.up;
    } else {
      const SlabNode part = slab_cell(sink, levels, plane, child_lo, log2_size - 1);
      children.add(child, {{}, part.id});
      down = part.down, up = part.up;
    }
    result.down = std::min(result.down, down);
    result.up = std::min(result.up, up);
  }
  result.id = intern_cell(sink, levels, log2_size, {children.node(), kNoNode});
  sink.memo.insert(plane, lo, log2_size, result);
  return result;
}

template <class Sink>
class ListedCells {
 public:
  using Context = SubvolumeContext<Sink>;
  using Item = typename Context::Item;
  using Classified = typename Context::Classified;

  explicit ListedCells(Context& context) : context_(context), sink_(context.sink) {}

  /// Returns the cell of 2^log2_size voxels a side at `at`, from `count` items on the stack from
  /// `first` on. Their conditions include all that can fail in the cell.
  Cell cell(Vec3i at, int log2_size, std::size_t first, std::size_t count) {
    if (count == 1) return single(at, log2_size, context_.items[first]);
    if (log2_size == 2) {
      std::uint64_t mask = 0;
      for (std::size_t i = first; i < first + count; ++i) {
        const Item& item = context_.items[i];
        mask |= triangle_children(context_.setups[item.triangle], item.conditions, at, 0);
      }
      return leaf_block_cell(mask);
    }
    if (log2_size == 4) return cell_of_blocks(at, first, count);
    return log2_size % 2 == 0 ? cell_by_64(at, log2_size, first, count)
                              : cell_by_8(at, log2_size, first, count);
  }

 private:
  /// Returns the item of a child. If the child's column is inside the triangle, only the plane can
  /// fail.
  Item child_item(std::uint32_t triangle, std::uint64_t conditions) const {
    std::uint32_t left = static_cast<std::uint32_t>(conditions & 0xFFFF);
    const TriangleSetup& t = context_.setups[triangle];
    if ((left & kPlane) && (left & t.dominant_edges) == 0) left = kPlane;
    return {triangle, left};
  }

  /// Goes down one level, for an odd log2_size. A path needs this at most once.
  Cell cell_by_8(Vec3i at, int log2_size, std::size_t first, std::size_t count) {
    const std::int32_t half = std::int32_t{1} << (log2_size - 1);
    const std::size_t list = context_.items.size();
    Children<Sink> children(sink_, context_.levels, log2_size - 1);
    for (int child = 0; child < 8; ++child) {
      for (std::size_t i = first; i < first + count; ++i) {
        const Item item = context_.items[i];
        const TriangleSetup& t = context_.setups[item.triangle];
        const ChildConditions c = classify_children(t, item.conditions, at, half);
        if ((c.alive >> child) & 1) context_.items.push_back({item.triangle, c.conditions(child)});
      }
      if (context_.items.size() != list)
        children.add(child, cell(child_origin(at, half, child), log2_size - 1, list,
                                 context_.items.size() - list));
      context_.items.resize(list);
    }
    return {children.node(), kNoNode};
  }

  Cell cell_of_blocks(Vec3i at, std::size_t first, std::size_t count) {
    BlockMasks masks(at);
    for (std::size_t i = first; i < first + count; ++i) {
      const Item item = context_.items[i];
      masks.add(context_.setups[item.triangle], item.conditions);
    }
    return masks.cell(sink_, context_.levels);
  }

  /// Goes down two levels: each triangle's 4³ grandchildren are one mask.
  Cell cell_by_64(Vec3i at, int log2_size, std::size_t first, std::size_t count) {
    context_.work.poll();
    const std::size_t classified = context_.classified.size();
    std::uint64_t any = 0;
    for (std::size_t i = first; i < first + count; ++i) {
      const Item item = context_.items[i];
      const TriangleSetup& t = context_.setups[item.triangle];
      const std::uint32_t open = open_conditions(t, item.conditions, at, 1 << log2_size);
      const std::uint64_t met = linear_to_morton(triangle_children(t, open, at, log2_size - 2));
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

    const Cell cell = cell_of_grandchildren(
        sink_, context_.levels, at, log2_size, any, [&](int code, int log2_child, Vec3i child_at) {
          return grandchild(child_at, log2_child, lists + begin[code],
                            begin[code + 1] - begin[code]);
        });
    context_.items.resize(lists);
    return cell;
  }

  /// Returns a cell; its items still have the conditions of its grandparent.
  Cell grandchild(Vec3i at, int log2_size, std::size_t first, std::size_t count) {
    // BlockMasks finds the open conditions itself.
    if (log2_size == 4 && count > 1) return cell_of_blocks(at, first, count);
    for (std::size_t i = first; i < first + count; ++i) {
      Item& item = context_.items[i];
      item.conditions =
          open_conditions(context_.setups[item.triangle], item.conditions, at, 1 << log2_size);
    }
    return cell(at, log2_size, first, count);
  }

  /// Returns a cell that one triangle meets.
  Cell single(Vec3i at, int log2_size, const Item item) {
    const TriangleSetup& t = context_.setups[item.triangle];
    if (log2_size == 2) return leaf_block_cell(triangle_children(t, item.conditions, at, 0));
    if constexpr (Sink::kMemo) {
      if (item.conditions == kPlane) {
        const int range = slab_range(t, at, std::int32_t{1} << log2_size);
        if (range == 0) return {};
        if (range == 1)
          return {{}, slab_cell(sink_, context_.levels, t.plane, slab_lo_at(t, at), log2_size).id};
      }
    }
    if (log2_size >= 6) context_.work.poll();
    const std::int32_t half = std::int32_t{1} << (log2_size - 1);
    const ChildConditions conditions = classify_children(t, item.conditions, at, half);
    Children<Sink> children(sink_, context_.levels, log2_size - 1);
    for (std::uint32_t left = conditions.alive; left != 0; left &= left - 1) {
      const int child = static_cast<int>(hwy::Num0BitsBelowLS1Bit_Nonzero32(left));
      children.add(child, single(child_origin(at, half, child), log2_size - 1,
                                 child_item(item.triangle, conditions.conditions(child))));
    }
    return {children.node(), kNoNode};
  }

  Context& context_;
  Sink& sink_;
};

}  // namespace HWY_NAMESPACE
}  // namespace voxdag
HWY_AFTER_NAMESPACE();

#endif

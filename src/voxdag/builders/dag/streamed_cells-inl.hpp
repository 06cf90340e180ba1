// Cells with so many triangles that their setups would take too much memory. Each setup is made
// when it is needed and not stored. Compiled once for each instruction set.
#if defined(VOXDAG_STREAMED_CELLS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef VOXDAG_STREAMED_CELLS_INL
#undef VOXDAG_STREAMED_CELLS_INL
#else
#define VOXDAG_STREAMED_CELLS_INL
#endif

#include <array>
#include <cstdint>
#include <numeric>

#include "voxdag/builders/dag/listed_cells-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace voxdag {
namespace HWY_NAMESPACE {

/// Goes down from a sub-volume by lists of the triangles' indices, until a cell has few enough for
/// ListedCells or its triangles only set bits.
template <class Sink>
class StreamedCells {
 public:
  using Context = SubvolumeContext<Sink>;

  /// `origin` is the first voxel of the sub-volume; coordinates of cells are relative to it.
  StreamedCells(Context& context, Vec3i origin)
      : context_(context), sink_(context.sink), listed_(context), origin_(origin) {}

  /// Returns the cell of 2^log2_size voxels a side at `at`, from `count` triangles on the stack
  /// from `first` on.
  Cell cell(Vec3i at, int log2_size, std::size_t first, std::size_t count) {
    if (count <= kMaxSetups) return listed_cell(at, log2_size, first, count);
    if (log2_size == 2) {
      std::uint64_t mask = 0;
      for_each_setup(first, count, [&](std::uint32_t, const TriangleSetup& t) {
        mask |= triangle_children(t, t.conditions, at, 0);
      });
      return leaf_block_cell(mask);
    }
    if (log2_size == 4) {
      BlockMasks masks(at);
      for_each_setup(first, count,
                     [&](std::uint32_t, const TriangleSetup& t) { masks.add(t, t.conditions); });
      return masks.cell(sink_, context_.levels);
    }
    return log2_size % 2 == 0 ? cell_by_64(at, log2_size, first, count)
                              : cell_by_8(at, log2_size, first, count);
  }

 private:
  /// 4 MiB of setups.
  static constexpr std::size_t kMaxSetups = std::size_t{1} << 14;

  /// The positions of the children's lists on the stack.
  struct Lists {
    std::size_t stack;
    std::array<std::size_t, 65> begin{};
    std::uint64_t any = 0;
  };

  TriangleSetup setup(std::uint32_t triangle) const {
    return make_triangle_setup(context_.mesh->triangle(triangle), origin_);
  }

  template <class Body>
  void for_each_setup(std::size_t first, std::size_t count, const Body& body) {
    for (std::size_t i = first; i < first + count; ++i) {
      if (i % 1024 == 0) context_.work.poll();
      const std::uint32_t triangle = context_.triangles[i];
      body(triangle, setup(triangle));
    }
  }

  Cell listed_cell(Vec3i at, int log2_size, std::size_t first, std::size_t count) {
    context_.work.poll();
    context_.setups.clear();
    context_.items.clear();
    for (std::size_t i = first; i < first + count; ++i) {
      const auto index = static_cast<std::uint32_t>(context_.setups.size());
      context_.setups.push_back(setup(context_.triangles[i]));
      context_.items.push_back({index, context_.setups.back().conditions});
    }
    return listed_.cell(at, log2_size, 0, count);
  }

  /// Appends to the stack, for each child, the list of the triangles that meet it: children_of(t)
  /// returns a mask.
  template <class ChildrenOf>
  Lists lists_of_children(std::size_t first, std::size_t count, const ChildrenOf& children_of) {
    Lists lists;
    for_each_setup(first, count, [&](std::uint32_t triangle, const TriangleSetup& t) {
      const std::uint64_t met = children_of(t);
      lists.any |= met;
      if (met != 0) context_.classified.push_back({triangle, 0, met});
      for (std::uint64_t left = met; left != 0; left &= left - 1)
        ++lists.begin[hwy::Num0BitsBelowLS1Bit_Nonzero64(left) + 1];
    });
    std::partial_sum(lists.begin.begin(), lists.begin.end(), lists.begin.begin());
    lists.stack = context_.triangles.size();
    context_.triangles.resize(lists.stack + lists.begin[64]);
    std::array<std::size_t, 65> next = lists.begin;
    for (const auto& c : context_.classified)
      for (std::uint64_t left = c.met; left != 0; left &= left - 1)
        context_.triangles[lists.stack + next[hwy::Num0BitsBelowLS1Bit_Nonzero64(left)]++] =
            c.triangle;
    context_.classified.release();
    return lists;
  }

  Cell cell_by_8(Vec3i at, int log2_size, std::size_t first, std::size_t count) {
    const std::int32_t half = std::int32_t{1} << (log2_size - 1);
    const Lists lists = lists_of_children(first, count, [&](const TriangleSetup& t) {
      return std::uint64_t{classify_children(t, t.conditions, at, half).alive};
    });
    Children<Sink> children(sink_, context_.levels, log2_size - 1);
    for (int child = 0; child < 8; ++child) {
      const std::size_t begin = lists.begin[child], end = lists.begin[child + 1];
      if (begin != end)
        children.add(child, cell(child_origin(at, half, child), log2_size - 1, lists.stack + begin,
                                 end - begin));
    }
    context_.triangles.resize(lists.stack);
    return {children.node(), kNoNode};
  }

  Cell cell_by_64(Vec3i at, int log2_size, std::size_t first, std::size_t count) {
    const Lists lists = lists_of_children(first, count, [&](const TriangleSetup& t) {
      return linear_to_morton(triangle_children(t, t.conditions, at, log2_size - 2));
    });
    const Cell result =
        cell_of_grandchildren(sink_, context_.levels, at, log2_size, lists.any,
                              [&](int code, int log2_child, Vec3i child_at) {
                                return cell(child_at, log2_child, lists.stack + lists.begin[code],
                                            lists.begin[code + 1] - lists.begin[code]);
                              });
    context_.triangles.resize(lists.stack);
    return result;
  }

  Context& context_;
  Sink& sink_;
  ListedCells<Sink> listed_;
  Vec3i origin_;
};

}  // namespace HWY_NAMESPACE
}  // namespace voxdag
HWY_AFTER_NAMESPACE();

#endif

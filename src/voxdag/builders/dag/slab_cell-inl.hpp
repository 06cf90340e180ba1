// Cells that contain one plane and nothing else (see "Plane memo" in the design). Compiled once for
// each instruction set.
#if defined(VOXDAG_SLAB_CELL_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef VOXDAG_SLAB_CELL_INL
#undef VOXDAG_SLAB_CELL_INL
#else
#define VOXDAG_SLAB_CELL_INL
#endif

#include <algorithm>
#include <cstdint>

#include "voxdag/builders/dag/cell_children-inl.hpp"
#include "voxdag/builders/dag/plane_memo.hpp"

HWY_BEFORE_NAMESPACE();
namespace voxdag {
namespace HWY_NAMESPACE {

/// Returns the node of a cell of 2^log2_size voxels a side (at least 8) that contains the voxels of
/// a slab, whose least value relative to the cell is `lo`, and nothing else.
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

}  // namespace HWY_NAMESPACE
}  // namespace voxdag
HWY_AFTER_NAMESPACE();

#endif

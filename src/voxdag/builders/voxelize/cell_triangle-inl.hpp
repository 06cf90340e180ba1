// Rasterises a triangle into the 4³ leaf blocks of a cell of 16³ voxels, vectorised. Included once
// for each instruction set.
//
// Values that the blocks share are computed once for each edge: its values over a block's square of
// voxels, and its values over the cell's square of blocks. For a block, one of the second is added
// to the first. All edges of a projection are tested together, without a branch per edge.
#if defined(VOXDAG_CELL_TRIANGLE_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef VOXDAG_CELL_TRIANGLE_INL
#undef VOXDAG_CELL_TRIANGLE_INL
#else
#define VOXDAG_CELL_TRIANGLE_INL
#endif

#include "voxdag/builders/voxelize/block_raster-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace voxdag {
namespace HWY_NAMESPACE {

struct alignas(64) CellTriangle {
  std::int32_t voxel[9][16];  ///< a*u + b*v of an edge, over a block's square: lane u + 4v.
  std::int32_t block[9][16];  ///< Its value in the first voxel of each block, clamped.
  ScaledSlab slab{};
  std::int64_t slab_lo = 0;   ///< The slab's least value, relative to the cell.
  std::uint32_t box[3] = {};  ///< By axis: bit i is set if the bounding box meets layer i of 16.
  std::uint32_t projections = 0;  ///< Bit p: edges of projection p can fail.
  bool has_plane = false;         ///< The plane can fail.
  bool wide = false;              ///< Too large for 32 bits: triangle_children() decides.
};

inline constexpr int kLog2CellBlocks = 2;
inline constexpr std::int64_t kCellLast = 15;

/// Returns the block columns that pass the edges of a projection, as 16 bits u + 4v. If a voxel of
/// the cell may fail one of the edges, adds the projection to `c`. Dominant edges count as edges
/// that may fail until the cell's whole column is inside the triangle.
HWY_INLINE std::uint64_t enter_projection(const TriangleSetup& t, int projection, Vec3i cell,
                                          bool dominant, CellTriangle& c) {
  using detail::absolute;
  using detail::negative;
  using detail::positive;
  const hn::CappedTag<std::int32_t, 16> d;
  const hn::RebindToUnsigned<decltype(d)> du;
  constexpr std::size_t kLanes = hn::MaxLanes(d);
  constexpr std::int64_t kFar = std::int64_t{1} << 29;
  std::int32_t value[3], most[3];
  bool open = false;
  for (int e = 0; e < 3; ++e) {
    const std::int64_t a = t.a[3 * projection + e], b = t.b[3 * projection + e];
    const std::int64_t first = t.c[3 * projection + e] + a * cell[kProjectionU[projection]] +
                               b * cell[kProjectionV[projection]];
    if (first + kCellLast * (positive(a) + positive(b)) < 0) return 0;
    const std::int64_t needed = dominant ? absolute(a) + absolute(b) : 0;
    open |= first + kCellLast * (negative(a) + negative(b)) < needed;
    // A value beyond kFar has the same sign in the whole cell.
    value[e] = static_cast<std::int32_t>(std::clamp(first, -kFar, kFar));
    most[e] = static_cast<std::int32_t>(3 * (positive(a) + positive(b)));
  }
  if (!open) return 0xFFFF;
  c.projections |= 1u << projection;
  std::uint64_t met = 0;
  for (std::size_t i = 0; i < 16; i += kLanes) {
    const auto u = hn::BitCast(d, hn::Load(du, kSquare.u + i));
    const auto v = hn::BitCast(d, hn::Load(du, kSquare.v + i));
    auto outside = hn::Zero(d);
    for (int e = 0; e < 3; ++e) {
      const int edge = 3 * projection + e;
      const auto voxel =
          hn::Add(hn::Mul(hn::Set(d, t.a[edge]), u), hn::Mul(hn::Set(d, t.b[edge]), v));
      const auto block = hn::Add(hn::Set(d, value[e]), hn::ShiftLeft<kLog2CellBlocks>(voxel));
      hn::Store(voxel, d, c.voxel[edge] + i);
      hn::Store(block, d, c.block[edge] + i);
      outside = hn::Or(outside, hn::Add(block, hn::Set(d, most[e])));
    }
    met |= mask_bits(d, hn::Gt(outside, hn::Set(d, -1))) << i;
  }
  return met;
}

/// Returns the leaf blocks of the cell of 16³ voxels at `cell` that pass `conditions`, in linear
/// order. Fills `c` if there is one.
HWY_INLINE std::uint64_t enter_cell(const TriangleSetup& t, std::uint32_t conditions, Vec3i cell,
                                    CellTriangle& c) {
  using detail::negative;
  using detail::positive;
  constexpr std::int32_t kLast = static_cast<std::int32_t>(kCellLast);
  const int range = (conditions & kPlane) ? slab_range(t, cell, kLast + 1) : 1;
  if (range == 0) return 0;
  // If an edge is shorter than this, its value changes by less than 2^28 over the cell.
  constexpr std::int32_t kLongestEdge = 1 << 15;
  const Vec3i size = t.box_hi - t.box_lo;
  c.wide = range == 2 || std::max({size.x, size.y, size.z}) >= kLongestEdge - 1;
  if (c.wide) return triangle_children(t, conditions, cell, kLog2CellBlocks);

  c.has_plane = (conditions & kPlane) != 0;
  c.projections = 0;
  std::uint64_t met = ~std::uint64_t{0};
  c.box[0] = c.box[1] = c.box[2] = 0xFFFF;
  bool plane_alone = conditions == kPlane;
  if (conditions & t.dominant_edges) {
    const int dominant = std::countr_zero(t.dominant_edges) / 3;
    met = expand_square(dominant, enter_projection(t, dominant, cell, true, c));
    plane_alone = c.projections == 0;
  }
  if (!plane_alone) {
    if (conditions & kBox) {
      Vec3i lo = t.box_lo - cell, hi = t.box_hi - cell;
      for (int axis = 0; axis < 3; ++axis) {
        if (lo[axis] > kLast || hi[axis] < 0) return 0;
        c.box[axis] = (2u << std::min(hi[axis], kLast)) - (1u << std::max(lo[axis], 0));
        lo[axis] >>= kLog2CellBlocks, hi[axis] >>= kLog2CellBlocks;
      }
      met &= box_mask({0, 0, 0}, lo, hi);
    }
    for (int projection = 0; projection < 3 && met != 0; ++projection) {
      const std::uint32_t edges = 7u << (3 * projection);
      if ((conditions & edges) == 0 || edges == t.dominant_edges) continue;
      met &= expand_square(projection, enter_projection(t, projection, cell, false, c));
    }
  }
  if (c.has_plane && met != 0) {
    constexpr std::int64_t kBlock = 4, kBlockLast = kBlock - 1;
    const Vec3l& n = t.plane.normal;
    const std::int64_t above = kBlockLast * (positive(n.x) + positive(n.y) + positive(n.z));
    const std::int64_t below = kBlockLast * (negative(n.x) + negative(n.y) + negative(n.z));
    c.slab = scale_slab(t.plane);
    c.slab_lo = slab_lo_at(t, cell);
    const PlaneSlab blocks{n * kBlock, t.plane.width + above - below};
    met &= slab_mask(scale_slab(blocks), c.slab_lo - above);
  }
  return met;
}

/// Returns the voxels of a leaf block that the triangle sets, in linear order. `block` is the
/// block's position in the cell, 0 to 3 on each axis. The triangle must not be wide.
HWY_INLINE std::uint64_t block_voxels(const CellTriangle& c, Vec3i block) {
  const hn::CappedTag<std::int32_t, 16> d;
  constexpr std::size_t kLanes = hn::MaxLanes(d);
  const auto layers = [&](int axis) {
    return static_cast<std::uint64_t>((c.box[axis] >> (4 * block[axis])) & 0xF);
  };
  const std::uint64_t y = layers(1), z = layers(2);
  std::uint64_t mask = layers(0) * ((y | y << 3 | y << 6 | y << 9) & 0x1111) *
                       ((z | z << 15 | z << 30 | z << 45) & 0x0001000100010001ull);
  for (std::uint32_t left = c.projections; left != 0; left &= left - 1) {
    const int projection = std::countr_zero(left), edge = 3 * projection;
    const int column = block[kProjectionU[projection]] + 4 * block[kProjectionV[projection]];
    std::uint64_t square = 0;
    for (std::size_t i = 0; i < 16; i += kLanes) {
      auto outside = hn::Zero(d);
      for (int e = edge; e < edge + 3; ++e)
        outside =
            hn::Or(outside, hn::Add(hn::Set(d, c.block[e][column]), hn::Load(d, c.voxel[e] + i)));
      square |= mask_bits(d, hn::Gt(outside, hn::Set(d, -1))) << i;
    }
    mask &= expand_square(projection, square);
  }
  if (c.has_plane) {
    const Vec3l& n = c.slab.exact.normal;
    mask &= slab_mask(c.slab, c.slab_lo - 4 * (n.x * block.x + n.y * block.y + n.z * block.z));
  }
  return mask;
}

}  // namespace HWY_NAMESPACE
}  // namespace voxdag
HWY_AFTER_NAMESPACE();

#endif

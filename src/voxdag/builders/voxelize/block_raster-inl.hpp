// Rasterises triangles into leaf blocks of 4³ voxels, vectorised. Included once for each
// instruction set.
//
// Every lane holds an integer that decides one voxel or column exactly. So the masks are equal for
// all vector widths.
#if defined(VOXDAG_BLOCK_RASTER_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef VOXDAG_BLOCK_RASTER_INL
#undef VOXDAG_BLOCK_RASTER_INL
#else
#define VOXDAG_BLOCK_RASTER_INL
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <bit>

#include "voxdag/builders/voxelize/block_bits.hpp"
#include "voxdag/builders/voxelize/triangle_setup.hpp"

HWY_BEFORE_NAMESPACE();
namespace voxdag {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// The voxels of a slab in a block, and the interval of offsets for which they are the same.
struct SlabBlock {
  std::uint64_t mask;  ///< Linear order.
  std::uint64_t down, up;
};

/// Returns lane i of the mask as bit i, for up to 16 lanes. Loads exactly the stored bytes, because
/// a wider load would wait for the store.
template <class D, class M>
HWY_INLINE std::uint64_t mask_bits([[maybe_unused]] D d, M mask) {
#if HWY_TARGET == HWY_WASM  // Highway 1.0 takes the lanes one by one.
  return sizeof(hn::TFromD<D>) == 4 ? wasm_i32x4_bitmask(mask.raw) : wasm_i64x2_bitmask(mask.raw);
#else
  std::uint8_t bytes[8];
  hn::StoreMaskBits(d, mask, bytes);
  if constexpr (hn::MaxLanes(D()) <= 8) return bytes[0];
  return bytes[0] | static_cast<std::uint64_t>(bytes[1]) << 8;
#endif
}

/// The coordinates of lane u + 4v of a block's square.
struct SquareLanes {
  alignas(64) std::uint32_t u[16] = {0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3};
  alignas(64) std::uint32_t v[16] = {0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3};
};
inline constexpr SquareLanes kSquare;

/// Returns sixteen bits: bit u + 4v is set if value + a*u + b*v >= 0. The sums must fit in 32 bits.
HWY_INLINE std::uint64_t edge_square(std::int32_t value, std::int32_t a, std::int32_t b) {
  const hn::CappedTag<std::int32_t, 16> d;
  constexpr std::size_t kLanes = hn::MaxLanes(d);
  const hn::RebindToUnsigned<decltype(d)> du;
  std::uint64_t bits = 0;
  for (std::size_t i = 0; i < 16; i += kLanes) {
    const auto lane =
        hn::Add(hn::Set(d, value),
                hn::Add(hn::Mul(hn::Set(d, a), hn::BitCast(d, hn::Load(du, kSquare.u + i))),
                        hn::Mul(hn::Set(d, b), hn::BitCast(d, hn::Load(du, kSquare.v + i)))));
    bits |= mask_bits(d, hn::Gt(lane, hn::Set(d, -1))) << i;
  }
  return bits;
}

inline std::uint64_t edge_square_wide(std::int64_t value, std::int64_t a, std::int64_t b) {
  std::uint64_t bits = 0;
  for (int i = 0; i < 16; ++i)
    bits |= static_cast<std::uint64_t>(value + a * (i & 3) + b * (i >> 2) >= 0) << i;
  return bits;
}

/// Returns the voxels of a slab in a block. T must hold 16 |n|1. Negative distances are huge as
/// unsigned numbers. So the least and greatest distances to the slab's two ends give the distance
/// by which the slab can move in both directions.
template <class T>
HWY_INLINE SlabBlock slab_block_in(const PlaneSlab& slab, std::int64_t lo) {
  using U = hwy::MakeUnsigned<T>;
  const hn::CappedTag<T, 16> d;
  const hn::RebindToUnsigned<decltype(d)> du;
  constexpr std::size_t kLanes = hn::MaxLanes(d);
  const T x = static_cast<T>(slab.normal.x), y = static_cast<T>(slab.normal.y),
          z = static_cast<T>(slab.normal.z);
  const auto value_at = [&](std::size_t i) {
    return static_cast<T>(x * static_cast<T>(i & 3) + y * static_cast<T>((i >> 2) & 3) +
                          z * static_cast<T>(i >> 4));
  };
  alignas(64) T pattern[kLanes];
  for (std::size_t i = 0; i < kLanes; ++i) pattern[i] = value_at(i);
  const auto lanes = hn::Load(d, pattern);
  const auto thickness = hn::Set(d, static_cast<T>(slab.width + 1));
  auto least = hn::Set(du, static_cast<U>(~U{0}));
  auto most = hn::Zero(du);
  std::uint64_t mask = 0;
  for (std::size_t i = 0; i < 64; i += kLanes) {
    const auto above = hn::Add(lanes, hn::Set(d, static_cast<T>(value_at(i) - static_cast<T>(lo))));
    const auto beyond = hn::Sub(above, thickness);
    mask |= mask_bits(d, hn::Lt(hn::AndNot(above, beyond), hn::Zero(d))) << i;
    const auto a = hn::BitCast(du, above), b = hn::BitCast(du, beyond);
    least = hn::Min(least, hn::Min(a, b));
    most = hn::Max(most, hn::Max(a, b));
  }
  alignas(64) U low[kLanes], high[kLanes];
  hn::Store(least, du, low);
  hn::Store(most, du, high);
  U up = low[0], top = high[0];
  for (std::size_t i = 1; i < kLanes; ++i) {
    up = low[i] < up ? low[i] : up;
    top = high[i] > top ? high[i] : top;
  }
  return {mask, static_cast<U>(~top), up};
}

/// Returns the voxels of the slab whose least value relative to the block is `lo`. The slab must be
/// near the block: |lo| <= 16 |n|1.
HWY_INLINE SlabBlock slab_block(const PlaneSlab& slab, std::int64_t lo) {
  return slab.width < (std::int64_t{1} << 26) ? slab_block_in<std::int32_t>(slab, lo)
                                              : slab_block_in<std::int64_t>(slab, lo);
}

/// A slab whose numbers are shifted right so that sums over a block fit in 32 bits.
struct ScaledSlab {
  PlaneSlab exact;
  int shift;
  std::uint32_t x, y, z, thickness;
};

inline ScaledSlab scale_slab(const PlaneSlab& slab) {
  using detail::absolute;
  const Vec3l& n = slab.normal;
  const auto length1 = static_cast<std::uint64_t>(absolute(n.x) + absolute(n.y) + absolute(n.z));
  const int shift = std::max(0, static_cast<int>(std::bit_width(length1)) - 24);
  const auto scaled = [&](std::int64_t v) { return static_cast<std::uint32_t>(v >> shift); };
  return {slab, shift, scaled(n.x), scaled(n.y), scaled(n.z), scaled(slab.width + 1)};
}

/// Returns the voxels of a slab in a block, in linear order. `lo` is the slab's least value
/// relative to the block, |lo| <= 60 |n|1. The shift changes a voxel's distance from the slab's
/// near end by -9 to +1, and from its far end by -9 to +2, exclusive. If no distance is that close
/// to 0, the scaled numbers decide exactly; else the exact numbers decide.
HWY_INLINE std::uint64_t slab_mask(const ScaledSlab& slab, std::int64_t lo) {
  const hn::CappedTag<std::uint32_t, 16> d;
  constexpr std::size_t kLanes = hn::MaxLanes(d);
  const std::uint32_t margin = slab.shift == 0 ? 0 : 8;
  const auto begin = hn::Set(d, margin - static_cast<std::uint32_t>(lo >> slab.shift));
  const auto x = hn::Set(d, slab.x), y = hn::Set(d, slab.y), z = hn::Set(d, slab.z);
  const auto thickness = hn::Set(d, slab.thickness);
  const auto limit = hn::Set(d, slab.thickness + margin);
  auto nearest = hn::Set(d, ~std::uint32_t{0});
  std::uint64_t mask = 0;
  for (std::size_t i = 0; i < 16; i += kLanes) {
    // Distances below -margin are huge as unsigned numbers.
    auto distance = hn::Add(begin, hn::Add(hn::Mul(x, hn::Load(d, kSquare.u + i)),
                                           hn::Mul(y, hn::Load(d, kSquare.v + i))));
    for (std::size_t k = 0; k < 4; ++k) {
      mask |= mask_bits(d, hn::Lt(distance, limit)) << (16 * k + i);
      nearest = hn::Min(nearest, hn::Min(distance, hn::Sub(distance, thickness)));
      distance = hn::Add(distance, z);
    }
  }
  if (slab.shift != 0 && !hn::AllTrue(d, hn::Gt(nearest, hn::Set(d, 9))))
    return slab_block_in<std::int64_t>(slab.exact, lo).mask;
  return mask;
}

/// Returns the children of a cell that pass `conditions`, in linear order. The cell has 4³ children
/// of 2^log2_child voxels a side. With log2_child = 0 they are the voxels of a leaf block.
HWY_INLINE std::uint64_t triangle_children(const TriangleSetup& t, std::uint32_t conditions,
                                           Vec3i cell, int log2_child) {
  using detail::absolute;
  using detail::negative;
  using detail::positive;
  std::uint64_t mask = ~std::uint64_t{0};
  if (conditions & kBox) {
    const Vec3i lo = t.box_lo - cell, hi = t.box_hi - cell;
    mask = box_mask({0, 0, 0}, {lo.x >> log2_child, lo.y >> log2_child, lo.z >> log2_child},
                    {hi.x >> log2_child, hi.y >> log2_child, hi.z >> log2_child});
  }
  const std::int64_t size = std::int64_t{1} << log2_child, last = size - 1;
  for (std::uint32_t left = conditions & kAllEdges; left != 0 && mask != 0; left &= left - 1) {
    const int edge = static_cast<int>(hwy::Num0BitsBelowLS1Bit_Nonzero32(left));
    const int projection = edge / 3;
    const std::int64_t a = t.a[edge], b = t.b[edge];
    // The greatest value in the first child. From child to child it changes by a * size or b *
    // size.
    const std::int64_t value = t.c[edge] + a * cell[kProjectionU[projection]] +
                               b * cell[kProjectionV[projection]] +
                               last * (positive(a) + positive(b));
    // Beyond the reach, all children pass or all fail.
    const std::int64_t reach = 3 * size * (absolute(a) + absolute(b));
    if (value >= reach) continue;
    if (value < -reach) return 0;
    const std::uint64_t square =
        reach < (std::int64_t{1} << 29)
            ? edge_square(static_cast<std::int32_t>(value), static_cast<std::int32_t>(a * size),
                          static_cast<std::int32_t>(b * size))
            : edge_square_wide(value, a * size, b * size);
    mask &= expand_square(projection, square);
  }
  if ((conditions & kPlane) && mask != 0) {
    const int range = slab_range(t, cell, 4 << log2_child);
    if (range == 0) return 0;
    if (range == 1) {
      const Vec3l& n = t.plane.normal;
      const std::int64_t above = last * (positive(n.x) + positive(n.y) + positive(n.z));
      const std::int64_t below = last * (negative(n.x) + negative(n.y) + negative(n.z));
      const PlaneSlab children{n * size, t.plane.width + above - below};
      mask &= slab_mask(scale_slab(children), slab_lo_at(t, cell) - above);
    }
  }
  return mask;
}

}  // namespace HWY_NAMESPACE
}  // namespace voxdag
HWY_AFTER_NAMESPACE();

#endif

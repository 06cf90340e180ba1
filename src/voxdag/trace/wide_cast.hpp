#pragma once
/// The ray cast of cast.hpp at the wide layout: the same cells for every ray, to the bit, in fewer
/// steps. A step tests one of a node's 4³ cells. If the octant of the cell is empty, the step
/// leaves the whole octant. PUSH and POP move by two levels of the tree.
///
/// Invariant: the cell of size 1 << `bit` at (x,y,z) is the one that the ray is in at `t`.
#include "voxdag/trace/cast.hpp"
#include "voxdag/trace/wide_nodes.hpp"

namespace voxdag {

/// Casts a ray like cast() in cast.hpp. `stop` must ignore t_enter. It must have first_level(): the
/// coarsest level at which it can be true.
template <WideLayout Nodes, class Stop>
VOXDAG_HD inline bool cast(const Nodes& nodes, const GridRay& ray, const Stop& stop, CellHit& hit) {
  constexpr std::uint32_t kOne = 0x3F800000u;  // the bits of 1.0f
  if (ray.misses() || nodes.is_empty()) return false;

  const float ox = ray.origin.x, oy = ray.origin.y, oz = ray.origin.z;
  const float ix = ray.inverse.x, iy = ray.inverse.y, iz = ray.inverse.z;
  const WideLevels range(nodes.levels());
  const std::uint32_t mirror = wide_mirror(ray.mirrored);
  const int first_stop = stop.first_level();

  float t = ray.t_min;
  if (ray.exit_t() <= t) return false;

  std::uint32_t stack[kMaxWideDepth];
  int bit = range.root_bit;
  std::uint32_t node = nodes.root();
  std::uint64_t mask = nodes.mask(node);
  std::uint32_t x = kOne, y = kOne, z = kOne;

  // Moves from a cell of twice the size to its child that the ray is in at t. Does nothing if the
  // position is at that child already.
  const auto refine = [&](int at) {
    const std::uint32_t half = 1u << at;
    x |= (ox - float_from_bits(x | half)) * ix > t ? half : 0u;
    y |= (oy - float_from_bits(y | half)) * iy > t ? half : 0u;
    z |= (oz - float_from_bits(z | half)) * iz > t ? half : 0u;
  };
  const auto exit_t = [&](std::uint32_t cx, std::uint32_t cy, std::uint32_t cz) {
    const float tx = (ox - float_from_bits(cx)) * ix;
    const float ty = (oy - float_from_bits(cy)) * iy;
    const float tz = (oz - float_from_bits(cz)) * iz;
    const float txy = tx < ty ? tx : ty;
    return txy < tz ? txy : tz;
  };
  refine(bit + 1);
  refine(bit);

  for (;;) {
    if constexpr (requires { nodes.on_step(); }) nodes.on_step();
    const std::uint32_t cell =
        ((x >> bit & 3u) | (y >> bit & 3u) << 2 | (z >> bit & 3u) << 4) ^ mirror;
    const auto half = static_cast<std::uint32_t>(mask >> (cell & 32u));
    const bool octant_is_empty = (half >> (cell & 10u) & kOctantCells) == 0;
    if (!octant_is_empty) {
      const int level = 23 - bit;
      if (level > first_stop && level > 1) {
        const std::uint32_t above = ~0u << (bit + 1);
        if (stop(level - 1, t, exit_t(x & above, y & above, z & above))) {
          hit = {t, x & above, y & above, z & above, level - 1};
          return true;
        }
      }
      if ((half >> (cell & 31u) & 1u) != 0) {
        if (bit == range.leaf_bit || (level >= first_stop && stop(level, t, exit_t(x, y, z)))) {
          hit = {t, x, y, z, level};
          return true;
        }
        // PUSH
        stack[(range.root_bit - bit) >> 1] = node;
        node = nodes.child(node, mask, cell);
        mask = nodes.mask(node);
        bit -= 2;
        refine(bit + 1);
        refine(bit);
        continue;
      }
    }

    // ADVANCE
    const int size = bit + (octant_is_empty ? 1 : 0);
    const std::uint32_t above = ~0u << size;
    x &= above;
    y &= above;
    z &= above;
    const float tx = (ox - float_from_bits(x)) * ix;
    const float ty = (oy - float_from_bits(y)) * iy;
    const float tz = (oz - float_from_bits(z)) * iz;
    const float txy = tx < ty ? tx : ty;
    const float t_exit = txy < tz ? txy : tz;
    if (t_exit > ray.t_max) return false;
    t = t_exit;
    const std::uint32_t next_x = x - ((tx == t_exit ? 1u : 0u) << size);
    const std::uint32_t next_y = y - ((ty == t_exit ? 1u : 0u) << size);
    const std::uint32_t next_z = z - ((tz == t_exit ? 1u : 0u) << size);
    const std::uint32_t changed = (x ^ next_x) | (y ^ next_y) | (z ^ next_z);
    x = next_x;
    y = next_y;
    z = next_z;
    if ((changed & leaves_node(bit)) == 0) {
      refine(bit);
      continue;
    }

    // POP
    const int highest = highest_bit(changed);
    if (highest > 22) return false;
    bit += (highest - bit) & ~1;
    const std::uint32_t kept = ~0u << bit;
    x &= kept;
    y &= kept;
    z &= kept;
    node = stack[(range.root_bit - bit) >> 1];
    mask = nodes.mask(node);
  }
}

}  // namespace voxdag

#pragma once
/// The ray cast of cast.hpp at the wide layout: the same cells for every ray, to the bit, in fewer
/// steps. A step tests one of a node's 4³ cells. If the octant of the cell is empty, the step
/// leaves the whole octant. PUSH and POP move by two levels of the tree.
///
/// A wide layout for cast() is a type with
///   kIsWide             true
///   is_empty()          no voxels at all
///   levels()            L
///   root()              the word index of the root; not called on an empty DAG
///   mask(n)             the 64-bit mask of wide node or leaf block n
///   child(n, m, c)      the child at bit c, which is set in n's mask m
///
/// Invariant: the cell of size 1 << `bit` at (x,y,z) is the one that the ray is in at `t`.
#include "voxdag/stored/svdag/wide_svdag.hpp"
#include "voxdag/trace/cast.hpp"

namespace voxdag {

/// The node layout for rays at the wide DAG (stored/svdag/wide_svdag.hpp).
class WideNodes {
 public:
  using Node = std::uint32_t;
  static constexpr bool kIsWide = true;

  VOXDAG_HD explicit WideNodes(const WideSvdagView& dag)
      : words_(dag.words), root_(dag.root), levels_(dag.levels), is_empty_(dag.is_empty()) {}

  VOXDAG_HD bool is_empty() const { return is_empty_; }
  VOXDAG_HD int levels() const { return levels_; }
  VOXDAG_HD Node root() const { return root_; }
  VOXDAG_HD const std::uint32_t* words() const { return words_; }

  VOXDAG_HD std::uint64_t mask(Node node) const {
    return words_[node] | static_cast<std::uint64_t>(words_[node + 1]) << 32;
  }
  VOXDAG_HD Node child(Node node, std::uint64_t mask, std::uint32_t cell) const {
    const std::uint64_t below = (std::uint64_t{1} << cell) - 1;
    return words_[node + 2 + static_cast<std::uint32_t>(popcount64(mask & below))];
  }

 private:
  const std::uint32_t* words_;
  std::uint32_t root_;
  int levels_;
  bool is_empty_;
};

/// A layout that cast() walks in steps of two levels.
template <class Nodes>
concept WideLayout = Nodes::kIsWide;

/// The position bits that a wide walk uses in a grid of L levels.
struct WideLevels {
  int leaf_bit;  ///< The position bit in which neighbouring voxels differ.
  int root_bit;  ///< The position bit in which neighbouring cells of the root differ.

  VOXDAG_HD explicit WideLevels(int levels)
      : leaf_bit(23 - levels), root_bit(leaf_bit + 2 * ((levels + 1) / 2 - 1)) {}
};

/// The maximum number of wide nodes on the way from the root to a voxel.
inline constexpr int kMaxWideDepth = (kMaxLevels + 1) / 2;

/// The eight cells of a wide node's octant (0, 0), as bits of the 32-bit half of the mask that
/// holds them. For other octants, shift it by the octant's x and y.
inline constexpr std::uint32_t kOctantCells = 0x00330033u;

/// Returns the number that, XORed with the cell of a mirrored position, gives the cell in the mask.
VOXDAG_HD constexpr std::uint32_t wide_mirror(std::uint32_t mirrored) {
  return (mirrored & 1u) * 3 | (mirrored >> 1 & 1u) * 12 | (mirrored >> 2 & 1u) * 48;
}

/// Returns a mask of position bits. One of them changes if a step leaves the node whose cells have
/// the size 1 << bit, or leaves the grid (which may be an octant of the root).
VOXDAG_HD constexpr std::uint32_t leaves_node(int bit) { return ~3u << bit | ~0u << 23; }

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

#pragma once
/// Steps from cell to cell along a ray: the code that the casts at all kinds of octrees share.
///
/// Source: Laine and Karras, "Efficient Sparse Voxel Octrees", I3D 2010, section 4 and Figure 8.
#include <cstdint>

#include "voxdag/core/grid.hpp"
#include "voxdag/core/host_device.hpp"
#include "voxdag/trace/grid_ray.hpp"

namespace voxdag {

/// The cell of some level that a ray is in at some T, as grid_ray.hpp defines it. Rays run down
/// along every axis, so they leave a cell through the planes of its lower corner, and coordinates
/// only decrease.
class CellWalk {
 public:
  /// T at the planes of the cell's lower corner. `t` is the least of them: the ray leaves the cell
  /// there.
  struct Exit {
    float x, y, z, t;
  };

  CellWalk() = default;
  /// Starts at the child of the root that the ray is in at `t`. The ray must be in the root at `t`.
  VOXDAG_HD CellWalk(const GridRay& ray, float t)
      : ox_(ray.origin.x),
        oy_(ray.origin.y),
        oz_(ray.origin.z),
        ix_(ray.inverse.x),
        iy_(ray.inverse.y),
        iz_(ray.inverse.z) {
    select_child(t);
  }

  /// Returns the float bits of a coordinate of the cell's lower corner.
  VOXDAG_HD std::uint32_t x() const { return x_; }
  VOXDAG_HD std::uint32_t y() const { return y_; }
  VOXDAG_HD std::uint32_t z() const { return z_; }
  VOXDAG_HD int level() const { return kTopBit + 1 - bit_; }
  /// Returns the cell's child index in its parent, mirrored.
  VOXDAG_HD std::uint32_t child() const { return child_; }
  /// Returns the position bit in which siblings of this level differ.
  VOXDAG_HD int bit() const { return bit_; }

  VOXDAG_HD Exit exit() const {
    Exit exit;
    exit.x = (ox_ - float_from_bits(x_)) * ix_;
    exit.y = (oy_ - float_from_bits(y_)) * iy_;
    exit.z = (oz_ - float_from_bits(z_)) * iz_;
    const float xy = exit.x < exit.y ? exit.x : exit.y;
    exit.t = xy < exit.z ? xy : exit.z;
    return exit;
  }

  /// Returns T at which the ray leaves the cube of `side` cells per axis that has this cell at its
  /// upper corner, or leaves the root.
  VOXDAG_HD float exit_of_cube(std::uint32_t side) const {
    const std::uint32_t by = (side - 1) << bit_;
    const float x = (ox_ - float_from_bits(lowered(x_, by))) * ix_;
    const float y = (oy_ - float_from_bits(lowered(y_, by))) * iy_;
    const float z = (oz_ - float_from_bits(lowered(z_, by))) * iz_;
    const float xy = x < y ? x : y;
    return xy < z ? xy : z;
  }

  /// Moves to the cell of the size 1 << `bit` that the ray is in at `t`. Returns whether it is in
  /// the root. `way` has 1 / ray.inverse, up to rounding.
  VOXDAG_HD bool jump(float t, int bit, const float* way) {
    bit_ = bit;
    x_ = cell_at(t, ox_, ix_, way[0]);
    y_ = cell_at(t, oy_, iy_, way[1]);
    z_ = cell_at(t, oz_, iz_, way[2]);
    return (x_ & y_ & z_ & 1u << (kTopBit + 1)) != 0;  // a bit of 1.0f
  }

  /// PUSH: moves to the child that the ray is in at `t`.
  VOXDAG_HD void push(float t) {
    --bit_;
    select_child(t);
  }

  /// Moves to the parent.
  VOXDAG_HD void ascend() {
    ++bit_;
    keep_bits_above();
  }

  /// ADVANCE: steps over all planes that the ray reaches where it leaves the cell. Returns whether
  /// the new cell has the same parent; if not, pop() must follow.
  VOXDAG_HD bool advance(const Exit& exit) {
    const std::uint32_t step_x = exit.x == exit.t ? 1u : 0u;
    const std::uint32_t step_y = exit.y == exit.t ? 1u : 0u;
    const std::uint32_t step_z = exit.z == exit.t ? 1u : 0u;
    const std::uint32_t next_x = x_ - (step_x << bit_);
    const std::uint32_t next_y = y_ - (step_y << bit_);
    const std::uint32_t next_z = z_ - (step_z << bit_);
    changed_ = (x_ ^ next_x) | (y_ ^ next_y) | (z_ ^ next_z);
    x_ = next_x;
    y_ = next_y;
    z_ = next_z;
    child_ ^= step_x | step_y << 1 | step_z << 2;
    return changed_ >> bit_ == 1;
  }

  /// Returns whether advance() left the cell of the size 1 << `bit` that the walk was in.
  VOXDAG_HD bool has_left(int bit) const { return changed_ >> bit != 0; }
  /// Moves to the cell of the size 1 << `bit` that contains this one.
  VOXDAG_HD void rise(int bit) {
    bit_ = bit;
    keep_bits_above();
  }

  /// POP: moves to the cell of the highest level at which advance() changed the position. Returns
  /// false if the ray has left the root.
  VOXDAG_HD bool pop() {
    bit_ = highest_bit(changed_);
    if (bit_ > kTopBit) return false;
    keep_bits_above();
    child_ = (x_ >> bit_ & 1u) | (y_ >> bit_ & 1u) << 1 | (z_ >> bit_ & 1u) << 2;
    return true;
  }

 private:
  static constexpr std::uint32_t kOne = 0x3F800000u;  // the bits of 1.0f
  static constexpr int kTopBit = 22;  // the position bit in which the root's children differ

  VOXDAG_HD void select_child(float t) {
    const std::uint32_t half = 1u << bit_;
    const std::uint32_t up_x = (ox_ - float_from_bits(x_ | half)) * ix_ > t ? 1u : 0u;
    const std::uint32_t up_y = (oy_ - float_from_bits(y_ | half)) * iy_ > t ? 1u : 0u;
    const std::uint32_t up_z = (oz_ - float_from_bits(z_ | half)) * iz_ > t ? 1u : 0u;
    x_ |= up_x << bit_;
    y_ |= up_y << bit_;
    z_ |= up_z << bit_;
    child_ = up_x | up_y << 1 | up_z << 2;
  }
  /// Returns the coordinate `by` below x, or that of the root's side.
  VOXDAG_HD static std::uint32_t lowered(std::uint32_t x, std::uint32_t by) {
    return x - by > kOne ? x - by : kOne;
  }
  /// Returns the coordinate of the cell that the ray is in at `t` on one axis. A product finds it,
  /// or the next one above: the errors of rounding are less than kMore. The plane rule decides.
  VOXDAG_HD std::uint32_t cell_at(float t, float origin, float inverse, float way) const {
    constexpr float kMore = 0x1p-21f;
    const std::uint32_t x = bits_of_float(origin - t * way + kMore) & ~0u << bit_;
    return x - ((origin - float_from_bits(x)) * inverse <= t ? 1u << bit_ : 0u);
  }
  VOXDAG_HD void keep_bits_above() {
    const std::uint32_t above = ~0u << bit_;
    x_ &= above;
    y_ &= above;
    z_ &= above;
  }

  float ox_ = 1, oy_ = 1, oz_ = 1, ix_ = 1, iy_ = 1, iz_ = 1;
  std::uint32_t x_ = kOne, y_ = kOne, z_ = kOne;
  std::uint32_t child_ = 0, changed_ = 0;
  int bit_ = kTopBit;
};

/// The path of a walk at any layout (svdag_nodes.hpp lists what a layout has). A layout with a
/// faster one names it as its type Path, which has the same members. The caller owns the stack of
/// kMaxLevels entries: nvcc keeps an object with an array in memory, and one without in registers.
template <class Nodes>
class NodePath {
 public:
  using Entry = typename Nodes::Node;

  /// Starts at the root. The layout must not be empty.
  VOXDAG_HD explicit NodePath(const Nodes& nodes)
      : nodes_(nodes), node_(nodes.root()), mask_(nodes.child_mask(node_, 0)) {}

  /// Returns the child mask of the node.
  VOXDAG_HD std::uint32_t mask() const { return mask_; }
  /// Goes to child `index` of the node, which is present and of `level` < L.
  VOXDAG_HD void push(Entry* stack, int level, std::uint32_t index) {
    stack[level - 1] = node_;
    node_ = nodes_.child(node_, level - 1, static_cast<int>(index));
    mask_ = nodes_.child_mask(node_, level);
  }
  /// Goes back to the node on the path whose children have this level, which is less than now.
  VOXDAG_HD void pop(const Entry* stack, int level) {
    node_ = stack[level - 1];
    mask_ = nodes_.child_mask(node_, level - 1);
  }

 private:
  const Nodes& nodes_;
  Entry node_;
  std::uint32_t mask_;
};

template <class Nodes>
struct PathOf {
  using Type = NodePath<Nodes>;
};
template <class Nodes>
requires requires { typename Nodes::Path; }
struct PathOf<Nodes> {
  using Type = typename Nodes::Path;
};

}  // namespace voxdag

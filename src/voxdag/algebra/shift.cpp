#include "voxdag/algebra/shift.hpp"

#include <algorithm>
#include <cassert>

#include "voxdag/algebra/source_dag.hpp"

namespace voxdag {
namespace {

/// A key is the 2³ source cells that a cell overlaps. Bit a of a cell's index in the key is set if
/// the cell has the larger coordinate along axis a.
///
/// Let s be the side of the cells of a level, and offset = q s + r, 0 <= r < s, along an axis. The
/// cell with coordinate c overlaps the source cells c - q - 1 and c - q; only the latter if r = 0.
/// With two children on each axis, the four halves of these two cells are numbered 0 to 3. Child k
/// of the cell overlaps the halves 1 + k - b and 2 + k - b, where b is the bit of r that stands for
/// s / 2.
class ShiftRule {
 public:
  static constexpr std::size_t kWords = 8;
  using Key = std::array<std::uint32_t, kWords>;

  ShiftRule(const SvdagView& dag, Vec3i offset, int levels)
      : source_(dag, std::max(levels, dag.levels)),
        levels_(std::max(levels, dag.levels)),
        above_(levels_ - levels) {
    const std::int32_t offsets[] = {offset.x, offset.y, offset.z};
    const std::int64_t side = std::int64_t{1} << levels_;
    for (int axis = 0; axis < 3; ++axis) {
      const std::int64_t d = offsets[axis];
      is_outside_ |= d <= -side || d >= side;
      is_negative_[axis] = d < 0;
      rest_[axis] = static_cast<std::uint32_t>(d & (side - 1));
    }
  }

  Key root() const {
    Key key = empty_key<kWords>();
    if (is_outside_) return key;
    // The root overlaps the source's root, as the larger cell if the offset is not negative.
    std::size_t index = 0;
    for (int axis = 0; axis < 3; ++axis) index |= is_negative_[axis] ? 0u : 1u << axis;
    key[index] = source_.root();
    // A smaller grid is the corner at (0,0,0).
    for (int level = 0; level < above_; ++level) {
      Key keys[8];
      wide_children(level, key, keys);
      key = keys[0];
    }
    return key;
  }
  void children(int level, const Key& key, Key (&keys)[8]) const {
    wide_children(level + above_, key, keys);
  }

  std::uint64_t block(const Key& key) const {
    std::uint64_t blocks[kWords], result = 0;
    for (std::size_t slot = 0; slot < kWords; ++slot) blocks[slot] = source_.block(key[slot]);
    for (int voxel = 0; voxel < 64; ++voxel) {
      std::size_t slot = 0;
      int from = 0;
      for (int axis = 0; axis < 3; ++axis) {
        // The coordinate in the eight voxels of the smaller and the larger cell.
        const int at = 4 + leaf_coordinate(voxel, axis) - static_cast<int>(rest_[axis] & 3);
        slot |= static_cast<std::size_t>(at >> 2) << axis;
        from |= leaf_bits(at & 3, axis);
      }
      result |= (blocks[slot] >> from & 1) << voxel;
    }
    return result;
  }

 private:
  /// Returns the keys of the children of a cell of a level of the wider grid.
  void wide_children(int level, const Key& key, Key (&keys)[8]) const {
    const int below = levels_ - level - 1;  // log2 of the side of the children
    for (int child = 0; child < 8; ++child)
      for (std::size_t slot = 0; slot < kWords; ++slot) {
        std::size_t from = 0;
        int half_index = 0;
        bool is_used = true;
        for (int axis = 0; axis < 3; ++axis) {
          const int k = child >> axis & 1, larger = static_cast<int>(slot >> axis & 1);
          const int b = static_cast<int>(rest_[axis] >> below & 1);
          if (larger == 0 && (rest_[axis] & ((1u << below) - 1)) == 0) is_used = false;
          const int half = 1 + k - b + larger;
          from |= static_cast<std::size_t>(half >> 1) << axis;
          half_index |= (half & 1) << axis;
        }
        keys[child][slot] = is_used ? source_.child(level, key[from], half_index) : kNoCell;
      }
  }

  SourceDag source_;
  int levels_;  ///< Of the wider one of both grids.
  int above_;   ///< Levels of that grid above the result's root.
  bool is_outside_ = false;
  bool is_negative_[3];
  std::uint32_t rest_[3];  ///< The offsets modulo the side of the grid.
};

}  // namespace

Svdag shift(const SvdagView& dag, Vec3i offset, int levels, Work work) {
  assert(levels >= kMinLevels && levels <= kMaxLevels);
  return rewrite(ShiftRule(dag, offset, levels), levels, work);
}

}  // namespace voxdag

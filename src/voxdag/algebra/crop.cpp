#include "voxdag/algebra/crop.hpp"

#include <algorithm>

#include "voxdag/algebra/long_source_dag.hpp"
#include "voxdag/algebra/source_dag.hpp"

namespace voxdag {
namespace {

/// A key is a node, and which sides of the box cut its cell: bit 2a for the low side of axis a, bit
/// 2a + 1 for the high side. At each level, only one cell on each axis contains a side, so the bits
/// say where in the cell it is.
template <class Source>
class CropRule {
 public:
  using Node = typename Source::Key;
  static constexpr std::size_t kWords = std::tuple_size_v<Node> + 1;
  using Key = std::array<std::uint32_t, kWords>;

  CropRule(const Source& source, const Box3i& box) : source_(source), levels_(source.levels()) {
    const std::int64_t side = std::int64_t{1} << levels_;
    const std::int32_t low[] = {box.lo.x, box.lo.y, box.lo.z};
    const std::int32_t high[] = {box.hi.x, box.hi.y, box.hi.z};
    for (int axis = 0; axis < 3; ++axis) {
      const std::int64_t first = std::clamp<std::int64_t>(low[axis], 0, side);
      const std::int64_t end = std::clamp<std::int64_t>(high[axis], 0, side);
      is_empty_ |= end <= first;
      first_[axis] = static_cast<std::uint32_t>(first);
      last_[axis] = static_cast<std::uint32_t>(end - 1);
    }
  }

  Key root() const {
    if (is_empty_ || source_.root_key() == kNoNode) return empty_key<kWords>();
    return key_of(source_.root_key(), 0, 0b111111);
  }
  void children(int level, const Key& key, Key (&keys)[8]) const {
    const int below = levels_ - level - 1;
    for (int child = 0; child < 8; ++child) {
      const Node node = source_.child_key(level, node_of(key), child);
      std::uint32_t cuts = key.back();
      bool is_outside = node == kNoNode;
      for (int axis = 0; axis < 3; ++axis) {
        const std::uint32_t k = static_cast<std::uint32_t>(child) >> axis & 1;
        const std::uint32_t low = 1u << (2 * axis), high = low << 1;
        if ((cuts & low) != 0) {
          const std::uint32_t b = first_[axis] >> below & 1;
          is_outside |= k < b;
          if (k > b) cuts &= ~low;
        }
        if ((cuts & high) != 0) {
          const std::uint32_t b = last_[axis] >> below & 1;
          is_outside |= k > b;
          if (k < b) cuts &= ~high;
        }
      }
      keys[child] = is_outside ? empty_key<kWords>() : key_of(node, level + 1, cuts);
    }
  }
  std::uint64_t block(const Key& key) const {
    const std::uint64_t voxels = source_.block(node_of(key));
    std::uint64_t kept = 0;
    for (int voxel = 0; voxel < 64; ++voxel) {
      bool is_inside = true;
      for (int axis = 0; axis < 3; ++axis) {
        const auto at = static_cast<std::uint32_t>(leaf_coordinate(voxel, axis));
        if ((key.back() >> (2 * axis) & 1) != 0) is_inside &= at >= (first_[axis] & 3);
        if ((key.back() >> (2 * axis + 1) & 1) != 0) is_inside &= at <= (last_[axis] & 3);
      }
      if (is_inside) kept |= std::uint64_t{1} << voxel;
    }
    return voxels & kept;
  }

 private:
  static constexpr Node kNoNode = empty_key<kWords - 1>();

  static Node node_of(const Key& key) {
    Node node;
    std::copy_n(key.begin(), node.size(), node.begin());
    return node;
  }
  /// Returns the key of a cell. Sides at the cell's own sides cut nothing off.
  Key key_of(const Node& node, int level, std::uint32_t cuts) const {
    const std::uint32_t within = (1u << (levels_ - level)) - 1;
    for (int axis = 0; axis < 3; ++axis) {
      if ((first_[axis] & within) == 0) cuts &= ~(1u << (2 * axis));
      if ((last_[axis] & within) == within) cuts &= ~(2u << (2 * axis));
    }
    Key key;
    *std::copy(node.begin(), node.end(), key.begin()) = cuts;
    return key;
  }

  Source source_;
  int levels_;
  bool is_empty_ = false;
  std::uint32_t first_[3], last_[3];  ///< The first and the last voxel in the box, on each axis.
};

}  // namespace

Svdag crop(const SvdagView& dag, const Box3i& box, Work work) {
  return rewrite(CropRule(SourceDag(dag), box), dag.levels, work);
}

Svdag crop(const LongSvdagView& dag, const Box3i& box, Work work) {
  return rewrite(CropRule(LongSourceDag(dag), box), dag.levels, work);
}

}  // namespace voxdag

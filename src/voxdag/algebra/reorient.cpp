#include "voxdag/algebra/reorient.hpp"

#include "voxdag/algebra/source_dag.hpp"

namespace voxdag {
namespace {

/// A key is a node.
class ReorientRule {
 public:
  static constexpr std::size_t kWords = 1;
  using Key = std::array<std::uint32_t, kWords>;

  ReorientRule(const SvdagView& dag, const Orientation& orientation) : source_(dag) {
    for (int child = 0; child < 8; ++child) {
      int from = 0;
      for (int axis = 0; axis < 3; ++axis) {
        const int k = (child >> axis & 1) ^ (orientation.is_flipped[axis] ? 1 : 0);
        from |= k << orientation.source_axis[axis];
      }
      source_child_[child] = from;
    }
    for (int voxel = 0; voxel < 64; ++voxel)
      source_voxel_[voxel] = source_child_[voxel >> 3] << 3 | source_child_[voxel & 7];
  }

  Key root() const { return {source_.root()}; }
  void children(int level, const Key& key, Key (&keys)[8]) const {
    for (int i = 0; i < 8; ++i) keys[i] = {source_.child(level, key[0], source_child_[i])};
  }
  std::uint64_t block(const Key& key) const {
    const std::uint64_t voxels = source_.block(key[0]);
    std::uint64_t result = 0;
    for (int i = 0; i < 64; ++i) result |= (voxels >> source_voxel_[i] & 1) << i;
    return result;
  }

 private:
  SourceDag source_;
  int source_child_[8], source_voxel_[64];
};

}  // namespace

Orientation mirrored(int axis) {
  Orientation orientation;
  orientation.is_flipped[axis] = true;
  return orientation;
}

Orientation rotated(int axis, int quarter_turns) {
  Orientation turn;
  // A quarter turn takes axis u to v: the new v is the old u, the new u the old v counted down.
  const int u = (axis + 1) % 3, v = (axis + 2) % 3;
  turn.source_axis[v] = u;
  turn.source_axis[u] = v;
  turn.is_flipped[u] = true;
  Orientation all;
  for (int i = 0; i < (quarter_turns % 4 + 4) % 4; ++i) all = then(all, turn);
  return all;
}

Orientation then(const Orientation& first, const Orientation& second) {
  Orientation both;
  for (int axis = 0; axis < 3; ++axis) {
    const int middle = second.source_axis[axis];
    both.source_axis[axis] = first.source_axis[middle];
    both.is_flipped[axis] = second.is_flipped[axis] != first.is_flipped[middle];
  }
  return both;
}

Svdag reorient(const SvdagView& dag, const Orientation& orientation, Work work) {
  return rewrite(ReorientRule(dag, orientation), dag.levels, work);
}

}  // namespace voxdag

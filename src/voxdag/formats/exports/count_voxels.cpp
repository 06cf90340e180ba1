#include "voxdag/formats/exports/count_voxels.hpp"

#include <bit>
#include <unordered_map>
#include <vector>

namespace voxdag {
namespace {

/// Counts are not stored for subtrees less than this many levels above the leaf blocks: storing
/// them would cost more memory than it saves time.
constexpr int kForgottenLevels = 4;
constexpr std::uint64_t kStepsPerPoll = 1 << 16;

class DagCounter {
 public:
  DagCounter(const SvdagView& dag, const Box3i& window, std::uint64_t most,
             const std::function<void()>& poll)
      : dag_(dag), window_(window), most_(most), poll_(poll), whole_(dag.levels) {}

  std::uint64_t count() { return dag_.is_empty() ? 0 : count_cell(0, 0, {0, 0, 0}); }

 private:
  std::uint64_t count_cell(int level, std::uint32_t at, Vec3i origin) {
    const std::int32_t size = std::int32_t{1} << (dag_.levels - level);
    bool is_inside = true;
    for (int axis = 0; axis < 3; ++axis) {
      if (origin[axis] >= window_.hi[axis] || origin[axis] + size <= window_.lo[axis]) return 0;
      is_inside =
          is_inside && origin[axis] >= window_.lo[axis] && origin[axis] + size <= window_.hi[axis];
    }
    if (is_inside) return count_whole(level, at);
    if (level == dag_.levels - 2)
      return static_cast<std::uint64_t>(
          popcount64(dag_.leaf_blocks[at] & leaf_window_mask(origin, window_)));
    return count_children(level, at, [&](int index, std::uint32_t child) {
      const Vec3i corner{index & 1, index >> 1 & 1, index >> 2};
      return count_cell(level + 1, child, origin + corner * (size / 2));
    });
  }

  /// Returns the number of voxels of a cell that lies completely in the window.
  std::uint64_t count_whole(int level, std::uint32_t at) {
    if (level == dag_.levels - 2)
      return static_cast<std::uint64_t>(popcount64(dag_.leaf_blocks[at]));
    const bool is_remembered = level < dag_.levels - 2 - kForgottenLevels;
    auto& known = whole_[level];
    if (is_remembered)
      if (const auto found = known.find(at); found != known.end()) return found->second;
    const std::uint64_t count = count_children(
        level, at, [&](int, std::uint32_t child) { return count_whole(level + 1, child); });
    if (is_remembered) known.emplace(at, count);
    return count;
  }

  template <class CountChild>
  std::uint64_t count_children(int level, std::uint32_t at, const CountChild& count_child) {
    if (++steps_ % kStepsPerPoll == 0) poll_();
    const std::uint32_t* node = dag_.nodes + at;
    const std::uint32_t* pointer = node + 1;
    std::uint64_t sum = 0;
    for (std::uint32_t left = child_mask(node); left != 0 && sum <= most_; left &= left - 1)
      sum += count_child(std::countr_zero(left), *pointer++);
    // The root's sum is at most 2^60: it cannot overflow.
    return level == 0 && sum > most_ ? most_ + 1 : sum;
  }

  const SvdagView& dag_;
  const Box3i& window_;
  std::uint64_t most_;
  const std::function<void()>& poll_;
  std::vector<std::unordered_map<std::uint32_t, std::uint64_t>> whole_;  ///< Per level.
  std::uint64_t steps_ = 0;
};

/// Thrown inside count_voxels() to end the walk.
struct TooMany {};

}  // namespace

std::uint64_t count_voxels(const VoxelSet& voxels, const Box3i& window, std::uint64_t most,
                           const std::function<void()>& poll) {
  if (const SvdagView* dag = voxels.dag()) return DagCounter(*dag, window, most, poll).count();
  std::uint64_t count = 0, steps = 0;
  try {
    voxels.for_each_leaf_block(window, [&](Vec3i, std::uint64_t mask) {
      count += static_cast<std::uint64_t>(popcount64(mask));
      if (count > most) throw TooMany();
      if (++steps % kStepsPerPoll == 0) poll();
    });
  } catch (const TooMany&) {
    return most + 1;
  }
  return count;
}

}  // namespace voxdag

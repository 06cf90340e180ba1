#include "voxdag/algebra/query/height_map.hpp"

#include "voxdag/core/morton.hpp"
#include "voxdag/core/parallel/polled_for.hpp"

namespace voxdag {
namespace {

class Heights {
 public:
  Heights(const SvdagView& dag, int axis, HeightSide side, Work work)
      : dag_(dag),
        axis_(axis),
        u_(axis == 0 ? 1 : 0),
        v_(axis == 2 ? 1 : 2),
        is_high_(side == HeightSide::kHigh),
        work_(work),
        heights_(std::size_t{1} << (2 * dag.levels), -1) {
    for (int level = 0; level <= dag.levels - 2; ++level)
      done_.emplace_back(std::size_t{1} << (2 * level), false);
  }

  std::vector<std::int32_t> run() {
    if (!dag_.is_empty()) visit(0, 0, {});
    return std::move(heights_);
  }

 private:
  /// Visits a cell of `level`, which is the place of a cell among those of its level.
  void visit(int level, std::uint32_t at, Vec3i cell) {
    if (level == dag_.levels - 2) return visit_block(dag_.leaf_blocks[at], cell);
    work_.poll_seldom(polled_++);
    const std::uint32_t* const node = dag_.nodes + at;
    for (const int half : {is_high_ ? 1 : 0, is_high_ ? 0 : 1})
      for (int column = 0; column < 4; ++column) {
        const int child = half << axis_ | (column & 1) << u_ | (column >> 1) << v_;
        if ((child_mask(node) >> child & 1) == 0) continue;
        const Vec3i below = cell * 2 + child_offset(child);
        if (!done(level + 1, below)) visit(level + 1, child_pointer(node, child), below);
      }
    bool is_done = true;
    for (int column = 0; column < 4; ++column)
      is_done = is_done && done(level + 1, cell * 2 + step_to(column));
    done_[static_cast<std::size_t>(level)][place(level, cell)] = is_done;
  }

  Vec3i step_to(int column) const {
    Vec3i step;
    step[u_] = column & 1;
    step[v_] = column >> 1;
    return step;
  }

  void visit_block(std::uint64_t block, Vec3i cell) {
    bool is_done = true;
    for (int v = 0; v < 4; ++v)
      for (int u = 0; u < 4; ++u) {
        std::int32_t& height =
            heights_[static_cast<std::size_t>(4 * cell[u_] + u) +
                     (static_cast<std::size_t>(4 * cell[v_] + v) << dag_.levels)];
        for (int step = 0; step < 4 && height < 0; ++step) {
          Vec3i voxel;
          voxel[u_] = u;
          voxel[v_] = v;
          voxel[axis_] = is_high_ ? 3 - step : step;
          if ((block >> morton_encode(voxel) & 1) != 0) height = 4 * cell[axis_] + voxel[axis_];
        }
        is_done = is_done && height >= 0;
      }
    done_.back()[place(dag_.levels - 2, cell)] = is_done;
  }

  std::size_t place(int level, Vec3i cell) const {
    return static_cast<std::size_t>(cell[u_]) | static_cast<std::size_t>(cell[v_]) << level;
  }
  bool done(int level, Vec3i cell) const {
    return done_[static_cast<std::size_t>(level)][place(level, cell)];
  }

  const SvdagView& dag_;
  int axis_, u_, v_;
  bool is_high_;
  Work work_;
  std::uint64_t polled_ = 0;
  std::vector<std::int32_t> heights_;
  /// Whether all columns of a square have their heights, for each level.
  std::vector<std::vector<bool>> done_;
};

}  // namespace

std::vector<std::int32_t> height_map(const SvdagView& dag, int axis, HeightSide side, Work work) {
  return Heights(dag, axis, side, work).run();
}

}  // namespace voxdag

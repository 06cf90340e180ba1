#include "voxdag/edit/filter_ball.hpp"

#include <algorithm>
#include <cstdlib>
#include <string>
#include <vector>

#include "voxdag/algebra/voxels/voxel_builder.hpp"
#include "voxdag/stored/svdag/for_each_voxel.hpp"

namespace voxdag {
namespace {

/// The bytes of a box of voxels: 1 for one that is set.
class Window {
 public:
  Window(const SvdagView& dag, const Box3i& box, MemoryBudget* memory)
      : box_(box),
        size_(box.hi - box.lo),
        bytes_(static_cast<std::size_t>(size_.x) * static_cast<std::size_t>(size_.y) *
                   static_cast<std::size_t>(size_.z),
               0, memory) {
    for_each_voxel(dag, box, [&](Vec3i voxel) { bytes_[at(voxel)] = 1; });
  }
  std::size_t at(Vec3i voxel) const {
    const Vec3i p = voxel - box_.lo;
    return (static_cast<std::size_t>(p.z) * static_cast<std::size_t>(size_.y) +
            static_cast<std::size_t>(p.y)) *
               static_cast<std::size_t>(size_.x) +
           static_cast<std::size_t>(p.x);
  }
  /// Returns the number of voxels that are set among those whose coordinates differ by at most 1,
  /// on at most `axes` axes.
  int around(Vec3i voxel, int axes) const {
    int sum = 0;
    for (int z = -1; z <= 1; ++z)
      for (int y = -1; y <= 1; ++y)
        for (int x = -1; x <= 1; ++x)
          if (std::abs(x) + std::abs(y) + std::abs(z) <= axes)
            sum += bytes_[at(voxel + Vec3i{x, y, z})];
    return sum;
  }
  bool contains(Vec3i voxel) const { return bytes_[at(voxel)] != 0; }

 private:
  Box3i box_;
  Vec3i size_;
  CountedVector<std::uint8_t> bytes_;
};

}  // namespace

Svdag filter_ball(const SvdagView& dag, const BallShape& ball, BallFilter filter, Work work) {
  if (ball.radius > kMaxFilterRadius * kSubvoxels)
    throw Error("a ball to filter has a radius of at most " + std::to_string(kMaxFilterRadius) +
                " voxels");
  const std::int64_t side = std::int64_t{1} << dag.levels;
  Box3i inner;  // the voxels of the grid that the ball may have
  for (int axis = 0; axis < 3; ++axis) {
    const std::int64_t lo = (ball.center[axis] - ball.radius) / kSubvoxels - 1,
                       hi = (ball.center[axis] + ball.radius) / kSubvoxels + 2;
    inner.lo[axis] = static_cast<std::int32_t>(std::clamp<std::int64_t>(lo, 0, side));
    inner.hi[axis] = static_cast<std::int32_t>(std::clamp<std::int64_t>(hi, 0, side));
  }
  std::vector<std::uint64_t> codes;
  const Vec3i one{1, 1, 1};
  if (inner.lo.x < inner.hi.x && inner.lo.y < inner.hi.y && inner.lo.z < inner.hi.z) {
    const Window window(dag, {inner.lo - one, inner.hi + one}, work.memory);
    const auto is_set = [&](Vec3i voxel) {
      switch (filter) {
        case BallFilter::kSmooth:
          return window.around(voxel, 3) >= 14;
        case BallFilter::kGrow:
          return window.around(voxel, 1) > 0;
        default:
          return window.around(voxel, 1) == 7;
      }
    };
    for (std::int32_t z = inner.lo.z & ~3; z < inner.hi.z; z += 4) {
      work.poll();
      for (std::int32_t y = inner.lo.y & ~3; y < inner.hi.y; y += 4)
        for (std::int32_t x = inner.lo.x & ~3; x < inner.hi.x; x += 4) {
          const Vec3i origin{x, y, z};
          std::uint64_t block = ball.block(origin) & leaf_window_mask(origin, inner);
          for (; block != 0; block &= block - 1) {
            const Vec3i voxel =
                origin + morton_decode(static_cast<std::uint64_t>(std::countr_zero(block)));
            if (is_set(voxel)) codes.push_back(morton_encode(voxel));
          }
        }
    }
  }
  std::sort(codes.begin(), codes.end());
  return svdag_of_sorted(dag.levels, codes, work.memory);
}

}  // namespace voxdag

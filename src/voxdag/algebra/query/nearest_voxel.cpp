#include "voxdag/algebra/query/nearest_voxel.hpp"

#include <algorithm>

#include "voxdag/core/vec.hpp"
#include "voxdag/stored/svdag/svdag_lookup.hpp"

namespace voxdag {
namespace {

/// Returns the squared distance from a point to a closed cube.
double distance2_to_cube(Vec3d point, Vec3i first, std::int32_t side) {
  double sum = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double low = first[axis], high = low + side;
    const double d = std::max({low - point[axis], point[axis] - high, 0.0});
    sum += d * d;
  }
  return sum;
}

class Search {
 public:
  Search(const SvdagView& dag, Vec3d point, double most2)
      : dag_(dag), point_(point), best2_(most2) {}

  void visit(int level, std::uint32_t at, Vec3i first) {
    if (level == dag_.levels - 2) return visit_block(dag_.leaf_blocks[at], first);
    const std::int32_t half = std::int32_t{1} << (dag_.levels - level - 1);
    struct Child {
      double distance2;
      std::uint32_t at;
      Vec3i first;
    };
    Child children[8];
    int count = 0;
    const std::uint32_t* const node = dag_.nodes + at;
    for (int child = 0; child < 8; ++child) {
      if ((child_mask(node) >> child & 1) == 0) continue;
      const Vec3i begin = first + child_offset(child) * half;
      const double distance2 = distance2_to_cube(point_, begin, half);
      if (distance2 > best2_) continue;
      // The nearest first.
      int place = count++;
      for (; place > 0 && children[place - 1].distance2 > distance2; --place)
        children[place] = children[place - 1];
      children[place] = {distance2, child_pointer(node, child), begin};
    }
    for (int i = 0; i < count && children[i].distance2 <= best2_; ++i)
      visit(level + 1, children[i].at, children[i].first);
  }
  bool is_found() const { return is_found_; }
  NearestVoxel result() const { return {best_, best2_}; }

 private:
  void visit_block(std::uint64_t block, Vec3i first) {
    for (; block != 0; block &= block - 1) {
      const Vec3i voxel =
          first + morton_decode(static_cast<std::uint64_t>(std::countr_zero(block)));
      const double distance2 = distance2_to_cube(point_, voxel, 1);
      if (distance2 > best2_ || (is_found_ && distance2 == best2_ && !is_before(voxel, best_)))
        continue;
      best2_ = distance2;
      best_ = voxel;
      is_found_ = true;
    }
  }

  const SvdagView& dag_;
  Vec3d point_;
  double best2_;
  Vec3i best_;
  bool is_found_ = false;
};

}  // namespace

std::optional<NearestVoxel> nearest_voxel(const SvdagView& dag, Vec3d point, double most2) {
  if (dag.is_empty() || !(most2 >= 0) || !std::isfinite(dot(point, point))) return std::nullopt;
  const double side = std::ldexp(1.0, dag.levels);
  if (std::min({point.x, point.y, point.z}) >= 0 && std::max({point.x, point.y, point.z}) < side) {
    const Vec3i voxel{static_cast<std::int32_t>(point.x), static_cast<std::int32_t>(point.y),
                      static_cast<std::int32_t>(point.z)};
    if (svdag_contains(dag, voxel, dag.levels)) return NearestVoxel{voxel, 0};
  }
  Search search(dag, point, most2);
  search.visit(0, dag.root, {});
  if (!search.is_found()) return std::nullopt;
  return search.result();
}

}  // namespace voxdag

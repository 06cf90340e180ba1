#include "voxdag/algebra/carve.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "voxdag/algebra/combine.hpp"
#include "voxdag/algebra/crop.hpp"
#include "voxdag/algebra/grow.hpp"
#include "voxdag/algebra/query/voxel_moments.hpp"
#include "voxdag/algebra/select_regions.hpp"
#include "voxdag/core/error.hpp"
#include "voxdag/core/morton.hpp"

namespace voxdag {
namespace {

/// Returns the grid with all voxels set.
Svdag full_grid(int levels) {
  Svdag full;
  full.levels = levels;
  full.leaf_blocks = {~std::uint64_t{0}};
  for (int level = 0; level < levels - 2; ++level) {
    full.level_begin[static_cast<std::size_t>(level)] = full.nodes.size();
    full.nodes.push_back(0xFF);
    const auto next = static_cast<std::uint32_t>(full.nodes.size() + 8);
    full.nodes.insert(full.nodes.end(), 8, level + 1 < levels - 2 ? next : 0);
  }
  for (std::size_t level = static_cast<std::size_t>(levels) - 2; level < full.level_begin.size();
       ++level)
    full.level_begin[level] = full.nodes.size();
  return full;
}

/// Selects the component that has a voxel. The state of a cell is 0 if the voxel is elsewhere, else
/// 1 plus the cell's level.
class OneComponent {
 public:
  static constexpr bool kKeepsVoxels = false;

  OneComponent(const Regions& regions, Vec3i voxel) : voxel_(voxel), levels_(regions.levels()) {
    std::vector<std::uint32_t> nodes{regions.source().root()};
    for (level_ = 0; level_ < levels_ - 2 && nodes.back() != kNoCell; ++level_)
      nodes.push_back(regions.source().child(level_, nodes.back(), child_at(level_)));
    if (nodes.back() == kNoCell) return;
    const int bit = child_index(voxel, 1) * 8 + child_index(voxel, 0);
    const Regions::Counts counts = regions.counts(level_, nodes.back());
    while (region_ < counts.open + counts.closed &&
           (regions.block_voxels(nodes.back(), region_) >> bit & 1) == 0)
      ++region_;
    is_found_ = region_ < counts.open + counts.closed;
    // An open region is a part of one of the node above.
    while (is_found_ && level_ > 0 &&
           region_ < regions.counts(level_, nodes[static_cast<std::size_t>(level_)]).open) {
      --level_;
      region_ = regions.region_above(level_, nodes[static_cast<std::size_t>(level_)],
                                     child_at(level_), region_);
    }
  }

  bool is_found() const { return is_found_; }
  bool is_open_selected(std::uint32_t region) const { return level_ == 0 && region == region_; }
  bool is_closed_selected(int level, std::uint32_t, std::uint32_t region,
                          std::uint32_t state) const {
    return level == level_ && state != 0 && region == region_;
  }
  static std::uint32_t root_state() { return 1; }
  std::uint32_t state_below(std::uint32_t state, int child) const {
    const int level = static_cast<int>(state) - 1;
    return level >= 0 && level < level_ && child == child_at(level) ? state + 1 : 0;
  }

 private:
  int child_at(int level) const { return child_index(voxel_, levels_ - level - 1); }

  Vec3i voxel_;
  int levels_, level_ = 0;    ///< Of the node that the component is a region of.
  std::uint32_t region_ = 0;  ///< In that node.
  bool is_found_ = false;
};

}  // namespace

Vec3i half_of_capsule(double height, double radius, int up, double voxel_size) {
  Vec3i half;
  for (int axis = 0; axis < 3; ++axis) {
    const double voxels = std::ceil((axis == up ? height / 2 : radius) / voxel_size);
    half[axis] = static_cast<std::int32_t>(std::min(voxels, std::ldexp(1.0, kMaxLevels)));
  }
  return half;
}

Vec3i voxel_at(const Grid& grid, Vec3d place) {
  const Vec3d at = grid.to_grid(place);
  Vec3i voxel;
  for (int axis = 0; axis < 3; ++axis)
    voxel[axis] = static_cast<std::int32_t>(
        std::clamp(std::floor(at[axis]), -1.0, static_cast<double>(grid.resolution())));
  return voxel;
}

Svdag carve(const SvdagView& dag, Vec3i seed, Vec3i half, CarveForm form, Work work) {
  const bool is_in_grid = static_cast<std::uint32_t>(seed.x | seed.y | seed.z) >> dag.levels == 0;
  const Svdag full = full_grid(dag.levels);
  const Box3i box = bounds_of(dag, work);
  Svdag reached;
  {
    const Svdag within = crop(full.view(), box, work);
    Svdag blocked = dilate_box(dag, half, work);
    const Svdag free = combine(within.view(), blocked.view(), SetOperation::kDifference, work);
    blocked = {};
    const Regions regions(free.view(), RegionKind::kVoxels, Neighbours::k6, work);
    const OneComponent component(regions, seed);
    if (!is_in_grid || !component.is_found())
      throw Error("", "",
                  "the body cannot be at its first place: voxels are in its way, or the place lies "
                  "outside of the box of the voxels");
    reached = select_regions(regions, component, work);
  }
  const Svdag space = crop(dilate_box(reached.view(), half, work).view(), box, work);
  reached = {};
  if (form == CarveForm::kWall) {
    const Svdag thick = dilate(space.view(), 1, Neighbours::k26, work);
    return combine(thick.view(), space.view(), SetOperation::kDifference, work);
  }
  const Box3i used = bounds_of(space.view(), work);
  const Svdag solid = crop(full.view(), {used.lo - Vec3i{1, 1, 1}, used.hi + Vec3i{1, 1, 1}}, work);
  return combine(solid.view(), space.view(), SetOperation::kDifference, work);
}

}  // namespace voxdag

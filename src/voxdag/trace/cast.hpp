#pragma once
/// The ray cast: one traversal for closest hit, any hit and level of detail, on every node layout.
///
/// Source: Laine and Karras, "Efficient Sparse Voxel Octrees", I3D 2010, section 4 and Figure 8,
/// simplified as in Kämpe, Sintorn and Assarsson, "High Resolution Sparse Voxel DAGs", SIGGRAPH
/// 2013, section 4: voxels have no contours and are visited in ray order, so the walk keeps no
/// interval of t.
///
/// The walk visits, in order of T, the cells that the ray is in (grid_ray.hpp defines "in"). From a
/// present cell it descends to the child that the ray is in (PUSH). From an absent one it steps
/// over all planes that the ray reaches at the cell's exit T (ADVANCE). If a step leaves the
/// parent, the walk continues at the highest level at which the positions differ (POP). Invariant:
/// the current cell is the cell of its level that the ray is in at `t`.
#include "voxdag/trace/cell_walk.hpp"
#include "voxdag/trace/hit.hpp"

namespace voxdag {

/// The cell at which a cast ended, in the ray's mirrored coordinates.
struct CellHit {
  float t = 0;  ///< T at which the ray is first in the cell, within its range.
  std::uint32_t x = 0, y = 0, z = 0;  ///< The float bits of the cell's lower corner.
  int level = 0;
};

/// The type of a cast's result: CellHit, or the layout's own type derived from it.
template <class Nodes>
struct FoundBy {
  using Type = CellHit;
};
template <class Nodes>
requires requires { typename Nodes::Found; }
struct FoundBy<Nodes> {
  using Type = typename Nodes::Found;
};

/// A termination hook that never ends a cast above the voxels.
struct StopAtVoxels {
  VOXDAG_HD constexpr bool operator()(int /*level*/, float /*t_enter*/, float /*t_exit*/) const {
    return false;
  }
  VOXDAG_HD constexpr int first_level() const { return kMaxLevels; }
};

/// Finds the first non-empty cell along the ray that is a voxel or for which `stop(level, t_enter,
/// t_exit)` is true, and returns whether there is one within the ray's range. Calls `stop` for
/// non-empty cells of levels 1 to L-1, with the range of T in them. O(cells on the way) time, one
/// stack entry per level.
template <class Nodes, class Stop>
VOXDAG_HD inline bool cast(const Nodes& nodes, const GridRay& ray, const Stop& stop, CellHit& hit) {
  static_assert(
      !requires { typename Nodes::Found; }, "the layout has a cast of its own");
  if (ray.misses() || nodes.is_empty()) return false;

  const int levels = nodes.levels();
  const std::uint32_t mirrored = ray.mirrored;
  float t = ray.t_min;
  if (ray.exit_t() <= t) return false;

  using Path = typename PathOf<Nodes>::Type;
  typename Path::Entry stack[kMaxLevels];
  Path path(nodes);
  CellWalk cell(ray, t);
  for (;;) {
    if constexpr (requires { nodes.on_step(); }) nodes.on_step();
    const CellWalk::Exit exit = cell.exit();
    const std::uint32_t index = cell.child() ^ mirrored;
    if ((path.mask() >> index & 1u) != 0) {
      const int level = cell.level();
      if (level == levels || stop(level, t, exit.t)) {
        hit = {t, cell.x(), cell.y(), cell.z(), level};
        return true;
      }
      path.push(stack, level, index);
      cell.push(t);
      continue;
    }
    if (exit.t > ray.t_max) return false;
    t = exit.t;
    if (cell.advance(exit)) continue;
    if (!cell.pop()) return false;
    path.pop(stack, cell.level());
  }
}

/// Returns the side of its cube through which the ray entered the cell: that of the first axis
/// whose plane the ray meets at exactly the hit's T. Returns kNone if there is no such axis.
VOXDAG_HD inline Face entered_face(const GridRay& ray, const CellHit& cell) {
  const std::uint32_t corner[3] = {cell.x, cell.y, cell.z};
  for (int axis = 0; axis < 3; ++axis) {
    const float entry = float_from_bits(corner[axis] + (1u << (23 - cell.level)));
    if ((ray.parallel >> axis & 1u) == 0 && ray.plane_t(axis, entry) == cell.t)
      return static_cast<Face>(2 * axis + ((ray.mirrored >> axis & 1u) != 0 ? 0 : 1));
  }
  return Face::kNone;
}

/// Converts the result of a cast for the library's caller. t is finite and within [t_min, t_max] as
/// the caller gave them.
VOXDAG_HD inline Hit to_hit(const GridRay& ray, const CellHit& cell, int levels, float t_min,
                            float t_max) {
  Hit hit;
  hit.hit = true;
  hit.level = static_cast<std::int8_t>(cell.level);
  hit.face = entered_face(ray, cell);
  const float t = static_cast<float>(ray.to_world_t(static_cast<double>(cell.t)));
  constexpr float kMax = 0x1.fffffep127f;
  hit.t = t < t_min ? t_min : t > t_max ? t_max : t;
  if (hit.t > kMax) hit.t = kMax;

  const std::uint32_t corner[3] = {cell.x, cell.y, cell.z};
  const std::int32_t cell_size = 1 << (levels - cell.level);
  for (int axis = 0; axis < 3; ++axis) {
    const std::int32_t low = static_cast<std::int32_t>((corner[axis] & 0x7FFFFFu) >> (23 - levels));
    const bool is_mirrored = (ray.mirrored >> axis & 1u) != 0;
    hit.voxel[axis] = is_mirrored ? (1 << levels) - cell_size - low : low;
  }
  return hit;
}

/// Returns the first voxel, or cell at which `stop` ends the cast, within the ray's range.
template <class Nodes, class Stop = StopAtVoxels>
VOXDAG_HD inline Hit closest_hit(const Nodes& nodes, const Grid& grid, const Ray& ray,
                                 const Stop& stop = {}) {
  const GridRay grid_ray = make_grid_ray(grid, ray);
  CellHit cell;
  if (!cast(nodes, grid_ray, stop, cell)) return {};
  return to_hit(grid_ray, cell, nodes.levels(), ray.t_min, ray.t_max);
}

/// Returns whether there is a voxel, or a cell at which `stop` ends the cast, within the ray's
/// range.
template <class Nodes, class Stop = StopAtVoxels>
VOXDAG_HD inline bool any_hit(const Nodes& nodes, const Grid& grid, const Ray& ray,
                              const Stop& stop = {}) {
  CellHit cell;
  return cast(nodes, make_grid_ray(grid, ray), stop, cell);
}

}  // namespace voxdag

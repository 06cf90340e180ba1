#pragma once
/// The ray cast at an ESVO, with or without contours.
///
/// Source: Laine and Karras, "Efficient Sparse Voxel Octrees", I3D 2010, section 4.1 and Figure 8,
/// whose variables have the same names here: the active span of the ray is t <= T < t_max, and h is
/// where the ray leaves the parent, or 0 if the parent is on the stack already.
///
/// The walk is that of cast.hpp, with its plane rule and voxel rule: without contours it meets
/// exactly the cells that cast() meets in a DAG of the same voxels, at the same T, to the bit. A
/// contour cuts the span of T in its voxel (contour_span.hpp) and in all descendants. Two things
/// differ from Figure 8. A cell at which `stop` ends the ray is cut by its contour first, like a
/// leaf. And once the ray has left the span of the parent, it leaves the parent without stepping
/// through the rest of the parent's cells.
#include "voxdag/trace/cast.hpp"
#include "voxdag/trace/contour_span.hpp"
#include "voxdag/trace/esvo_nodes.hpp"

namespace voxdag {

/// A contour of one of the voxels that a ray passes.
struct ContourPlane {
  Contour contour;  ///< No bits set: none.
  int level = 0;    ///< Level of its voxel.
};

/// The voxel at which a cast ended. `t` is where the ray enters the shape, which may be after it
/// enters the cube.
struct EsvoHit : CellHit {
  EsvoVoxel voxel;  ///< The leaf, or the coarser voxel at which `stop` ended the cast.
  /// The contour, of the voxel or an ancestor, through whose plane the ray enters the shape; none
  /// if it enters through a side of the cube or starts inside.
  ContourPlane plane;

  VOXDAG_HD bool is_through_contour() const { return plane.contour.bits != 0; }
};

/// Finds the first voxel along the ray that is a leaf or for which `stop(level, t_enter, t_exit)`
/// is true, and returns whether there is one within the ray's range. Calls `stop` for voxels of
/// levels 1 to L-1 that are not leaves, with the range of T in their cubes.
template <EsvoLayout Nodes, class Stop>
VOXDAG_HD inline bool cast(const Nodes& nodes, const GridRay& ray, const Stop& stop, EsvoHit& hit) {
  constexpr bool kWithContours = Nodes::kWithContours;
  if (ray.misses() || nodes.is_empty()) return false;

  const EsvoView& esvo = nodes.view();
  const std::uint32_t mirrored = ray.mirrored;
  const auto descriptor_at = [&](std::uint64_t at) {
    if constexpr (requires { nodes.on_read(8u); }) nodes.on_read(8u);
    return esvo.descriptor(at);
  };

  // INITIALIZE
  float t = ray.t_min;
  const float t_end = end_of_range(ray.t_max);
  float t_max = t_end;
  float h = ray.exit_t();
  if (h <= t) return false;
  const ContourRay contour_ray(ray);
  std::uint64_t slots[kMaxLevels];
  float t_maxes[kMaxLevels];
  std::uint64_t slot = esvo.root;
  ChildDescriptor parent = descriptor_at(slot);
  ContourPlane plane;  // the contour plane at t, if the ray crosses one there
  CellWalk cell(ray, t);
  for (;;) {
    if constexpr (requires { nodes.on_step(); }) nodes.on_step();
    CellWalk::Exit exit = cell.exit();
    const std::uint32_t index = cell.child() ^ mirrored;
    if ((parent.valid_mask() >> index & 1u) != 0 && (!kWithContours || t < t_max)) {
      // INTERSECT
      const int level = cell.level();
      float tv_min = t, tv_max = exit.t < t_max ? exit.t : t_max;
      ContourPlane entered = plane;
      if constexpr (kWithContours) {
        if ((parent.contour_mask() >> index & 1u) != 0) {
          if constexpr (requires { nodes.on_read(4u); }) nodes.on_read(4u);
          const Contour contour = esvo.contour(slot, parent, static_cast<int>(index));
          const ContourSpan span =
              contour_ray.span(contour, cell.x(), cell.y(), cell.z(), cell.bit(), exit.t);
          if (span.t_enter > tv_min) {
            tv_min = span.t_enter;
            entered = {contour, level};
          }
          tv_max = span.t_leave < tv_max ? span.t_leave : tv_max;
        }
      }
      if (!kWithContours || tv_min < tv_max) {
        const bool is_leaf = (parent.leaf_mask() >> index & 1u) != 0;
        if (is_leaf || stop(level, t, exit.t)) {
          static_cast<CellHit&>(hit) = {tv_min, cell.x(), cell.y(), cell.z(), level};
          hit.voxel = {slot, static_cast<int>(index)};
          hit.plane = entered;
          if constexpr (requires { nodes.on_hit(ray, stop, hit); }) nodes.on_hit(ray, stop, hit);
          return true;
        }
        // PUSH
        if (exit.t < h) {
          slots[level - 1] = slot;
          if constexpr (kWithContours) t_maxes[level - 1] = t_max;
        }
        h = exit.t;
        slot = esvo.child(slot, parent, static_cast<int>(index));
        parent = descriptor_at(slot);
        if constexpr (kWithContours) {
          t = tv_min;
          t_max = tv_max;
          plane = entered;
        }
        cell.push(t);
        continue;
      }
    }

    if (exit.t >= t_end) return false;
    bool leaves_parent = false;
    if constexpr (kWithContours) {
      plane = {};
      leaves_parent = exit.t >= t_max;  // never true in the root: its span is the ray's range
      if (leaves_parent) {
        cell.ascend();
        exit = cell.exit();
        if (exit.t >= t_end) return false;
      }
    }
    t = exit.t;
    if (cell.advance(exit) && !leaves_parent) continue;
    if (!cell.pop()) return false;
    slot = slots[cell.level() - 1];
    if constexpr (kWithContours) t_max = t_maxes[cell.level() - 1];
    parent = descriptor_at(slot);
    h = 0;
  }
}

/// Finds the voxel that the overload above finds, for callers that need only its cell.
template <EsvoLayout Nodes, class Stop>
VOXDAG_HD inline bool cast(const Nodes& nodes, const GridRay& ray, const Stop& stop, CellHit& hit) {
  EsvoHit found;
  if (!cast(nodes, ray, stop, found)) return false;
  hit = found;
  return true;
}

/// Returns the outward unit normal of the plane through which the ray entered the shape, of a
/// contour or of a side of the cube. Returns zero if the ray starts inside.
VOXDAG_HD inline Vec3f entered_normal(const GridRay& ray, const EsvoHit& hit) {
  if (!hit.is_through_contour()) return static_cast<Vec3f>(face_normal(entered_face(ray, hit)));
  return normalized(static_cast<Vec3f>(ContourRay(ray).entered_normal(hit.plane.contour)));
}

/// Returns the distance between the planes of a contour, in units of the grid's side.
VOXDAG_HD inline float thickness(const ContourPlane& plane) {
  const auto n = static_cast<Vec3f>(plane.contour.normal());
  const auto steps = static_cast<float>(length1(plane.contour.normal()) *
                                        (plane.contour.high() - plane.contour.low()));
  const float side = float_from_bits(static_cast<std::uint32_t>(127 - plane.level) << 23);
  return side * steps / (length(n) * Contour::kMaxPosition);
}

/// Converts the result of a cast for the library's caller. If the ray enters through a contour, the
/// face is the side of the cube whose normal is closest to the contour's.
VOXDAG_HD inline Hit to_hit(const GridRay& ray, const EsvoHit& found, int levels, float t_min,
                            float t_max) {
  Hit hit = to_hit(ray, static_cast<const CellHit&>(found), levels, t_min, t_max);
  if (!found.is_through_contour()) return hit;
  const Vec3i n = ContourRay(ray).entered_normal(found.plane.contour);
  int axis = 0;
  for (int i = 1; i < 3; ++i)
    if (n[i] * n[i] > n[axis] * n[axis]) axis = i;
  hit.face = static_cast<Face>(2 * axis + (n[axis] > 0 ? 1 : 0));
  return hit;
}

/// Returns the first leaf, or voxel at which `stop` ends the cast, within the ray's range.
template <EsvoLayout Nodes, class Stop = StopAtVoxels>
VOXDAG_HD inline Hit closest_hit(const Nodes& nodes, const Grid& grid, const Ray& ray,
                                 const Stop& stop = {}) {
  const GridRay grid_ray = make_grid_ray(grid, ray);
  EsvoHit found;
  if (!cast(nodes, grid_ray, stop, found)) return {};
  return to_hit(grid_ray, found, nodes.levels(), ray.t_min, ray.t_max);
}

}  // namespace voxdag

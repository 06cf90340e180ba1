#pragma once
/// The ray cast through an ESVO, with contours or, as cubes, without.
///
/// Source: Laine and Karras, "Efficient Sparse Voxel Octrees", I3D 2010, section 4.1 and Figure 8,
/// whose variables these are: the active span of the ray is t <= T < t_max, and h is where it
/// leaves the parent, or 0 where the parent is on the stack already.
///
/// The walk is that of cast.hpp, plane rule, voxel rule and all: without contours it meets just the
/// cells that cast() meets in a DAG of the same voxels, at the same T, to the bit. Where a voxel
/// has a contour the span of T in it is cut (contour_span.hpp); what is cut off of an ancestor
/// stays cut off of its descendants. Two things are other than in Figure 8. A cell that `stop` ends
/// the ray at, like a leaf, has its shape: the contour is looked at before. And once the ray has
/// left the span of the parent it leaves the parent, without stepping through the rest of its
/// cells.
#include "voxdag/trace/cast.hpp"
#include "voxdag/trace/contour_span.hpp"
#include "voxdag/trace/esvo_nodes.hpp"

namespace voxdag {

/// A contour among those of a ray's voxels.
struct ContourPlane {
  Contour contour;  ///< No bits: none.
  int level = 0;    ///< Of the voxel that it is of.
};

/// Where a cast ended: t is where the ray enters the shape, later than the cube where a contour
/// cuts that.
struct EsvoHit : CellHit {
  EsvoVoxel voxel;  ///< The leaf, or the coarser voxel at which `stop` ended the cast.
  /// The contour, of the voxel or an ancestor, through one of whose planes the ray enters the
  /// shape; none where it enters through a side of its cube, or starts inside.
  ContourPlane plane;

  VOXDAG_HD bool is_through_contour() const { return plane.contour.bits != 0; }
};

/// Finds the first leaf along the ray, or voxel for which `stop(level, t_enter, t_exit)` is true,
/// asked of the voxels of levels 1 to L-1 that are no leaves with the range of T in their cubes.
/// True if there is one within the ray's range.
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
  ContourPlane plane;  // by which the ray came to t, if by one
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
      leaves_parent = exit.t >= t_max;  // never the root's: its span is the ray's range
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

/// The same for who needs the cell only.
template <EsvoLayout Nodes, class Stop>
VOXDAG_HD inline bool cast(const Nodes& nodes, const GridRay& ray, const Stop& stop, CellHit& hit) {
  EsvoHit found;
  if (!cast(nodes, ray, stop, found)) return false;
  hit = found;
  return true;
}

/// The outward normal, of unit length, of the plane through which the ray entered the shape: of a
/// contour or of a side of the cube. Zero where the ray starts inside.
VOXDAG_HD inline Vec3f entered_normal(const GridRay& ray, const EsvoHit& hit) {
  if (!hit.is_through_contour()) return static_cast<Vec3f>(face_normal(entered_face(ray, hit)));
  return normalized(static_cast<Vec3f>(ContourRay(ray).entered_normal(hit.plane.contour)));
}

/// How far apart the planes of a contour are, in units of the grid's side.
VOXDAG_HD inline float thickness(const ContourPlane& plane) {
  const auto n = static_cast<Vec3f>(plane.contour.normal());
  const auto steps = static_cast<float>(length1(plane.contour.normal()) *
                                        (plane.contour.high() - plane.contour.low()));
  const float side = float_from_bits(static_cast<std::uint32_t>(127 - plane.level) << 23);
  return side * steps / (length(n) * Contour::kMaxPosition);
}

/// As of any layout. The face of a ray that enters through a contour is the side that looks most
/// the same way.
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

/// The first leaf, or voxel at which `stop` ends the cast, within the ray's range.
template <EsvoLayout Nodes, class Stop = StopAtVoxels>
VOXDAG_HD inline Hit closest_hit(const Nodes& nodes, const Grid& grid, const Ray& ray,
                                 const Stop& stop = {}) {
  const GridRay grid_ray = make_grid_ray(grid, ray);
  EsvoHit found;
  if (!cast(nodes, grid_ray, stop, found)) return {};
  return to_hit(grid_ray, found, nodes.levels(), ray.t_min, ray.t_max);
}

}  // namespace voxdag

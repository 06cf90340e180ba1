#pragma once
/// Represents a triangle as a set of voxels: the voxels v in a box for which linear functions are
/// >= 0.
///
/// Source: the overlap test of Schwarz and Seidel, "Fast Parallel Surface and Solid Voxelization on
/// GPUs", SIGGRAPH Asia 2010, made exact for half-open cubes.
///
/// A triangle meets a voxel if its bounding box and its plane meet the voxel, and if in each of the
/// three axis-aligned projections the voxel's square is not completely outside one of the
/// triangle's edges. All conditions are linear in the voxel's integer coordinates. The constants
/// include the ties of the half-open cube and the division by 256 units per voxel:
///
///   edge    a*u + b*v + c >= 0         (u, v): the two coordinates of the projection
///   plane   lo <= n*v <= lo + width    a digital plane; n reduced by the common divisor
///
/// These functions also decide for a cell of s³ voxels: their least and greatest values over the
/// cell's voxels tell whether none, some or all of the voxels pass.
#include <cstdint>
#include <numeric>

#include "voxdag/builders/voxelize/grid_mapping.hpp"
#include "voxdag/core/host_device.hpp"
#include "voxdag/core/int128.hpp"
#include "voxdag/core/vec.hpp"

namespace voxdag {

/// The coordinates of the projection along axis p are kProjectionU[p] and kProjectionV[p].
inline constexpr int kProjectionU[3] = {1, 0, 0};
inline constexpr int kProjectionV[3] = {2, 2, 1};

/// Bits of a set of conditions. Edge e of projection p is bit 3p + e; plane and box follow.
enum Condition : std::uint32_t {
  kAllEdges = 0x1FF,
  kPlane = 1u << 9,
  kBox = 1u << 10,
};

/// The voxels v that a plane meets: those with lo <= dot(n, v) <= lo + width.
struct PlaneSlab {
  Vec3l normal;        ///< Components without a common divisor; the first nonzero one is positive.
  std::int64_t width;  ///< |n|1 - 1, or one less if the plane meets voxels in corners only.
};

/// The conditions of one triangle. Coordinates are voxels, relative to the origin of
/// make_triangle_setup().
struct alignas(64) TriangleSetup {
  std::int32_t a[9], b[9];
  std::int64_t c[9];
  PlaneSlab plane;
  /// The slab's least dot(n, v), modulo 2^64. It is exact if `approximate_lo` is small, which is
  /// true in every cell near the plane.
  std::uint64_t lo;
  double approximate_lo;
  double normal_length1;         ///< |n|1
  Vec3i box_lo, box_hi;          ///< First and last voxel of the bounding box.
  std::uint32_t conditions;      ///< The conditions that can fail.
  std::uint32_t dominant_edges;  ///< Edge bits of the projection along the normal's longest axis.
};

namespace detail {

VOXDAG_HD constexpr std::int64_t floor_div(std::int64_t value, int shift) { return value >> shift; }

VOXDAG_HD constexpr std::int64_t positive(std::int64_t v) { return v > 0 ? v : 0; }
VOXDAG_HD constexpr std::int64_t negative(std::int64_t v) { return v < 0 ? v : 0; }
VOXDAG_HD constexpr std::int64_t absolute(std::int64_t v) { return v < 0 ? -v : v; }

/// Stores the condition that a voxel's square meets the half-plane left of the directed line p->q
/// (right of it if `flip` is set). Coordinates are relative to the origin.
VOXDAG_HD inline void set_edge(TriangleSetup& s, int slot, std::int64_t pu, std::int64_t pv,
                               std::int64_t qu, std::int64_t qv, bool flip) {
  std::int64_t a = pv - qv, b = qu - pu;
  if (flip) a = -a, b = -b;
  const std::int64_t c = -(a * pu + b * pv);
  // The greatest value over the half-open square is at its far corner. If that corner is not part
  // of the square, the value there must be greater than 0.
  const std::int64_t strict = a > 0 || b > 0 ? 1 : 0;
  s.a[slot] = static_cast<std::int32_t>(a);
  s.b[slot] = static_cast<std::int32_t>(b);
  s.c[slot] = floor_div(c - strict, 8) + positive(a) + positive(b);
  if (a != 0 || b != 0) s.conditions |= 1u << slot;
}

}  // namespace detail

/// Returns the conditions of a triangle relative to `origin`, which is in voxels. Exact for
/// coordinates within ±kMaxUnits and 0 <= origin < 2^kMaxLevels.
inline TriangleSetup make_triangle_setup(const QuantizedTriangle& triangle, Vec3i origin) {
  static_assert(kSubvoxels == 1 << 8);
  using namespace detail;
  TriangleSetup s{};
  Vec3l p[3];
  for (int i = 0; i < 3; ++i)
    p[i] = static_cast<Vec3l>(triangle[i]) - static_cast<Vec3l>(origin) * std::int64_t{kSubvoxels};
  const Vec3l lo = min(p[0], min(p[1], p[2])), hi = max(p[0], max(p[1], p[2]));
  int long_axes = 0;
  for (int axis = 0; axis < 3; ++axis) {
    s.box_lo[axis] = static_cast<std::int32_t>(floor_div(lo[axis], 8));
    s.box_hi[axis] = static_cast<std::int32_t>(floor_div(hi[axis], 8));
    long_axes += s.box_lo[axis] != s.box_hi[axis] ? 1 : 0;
  }
  s.conditions = kBox;
  // A triangle is connected. So if its box is one row of voxels, it meets each of them.
  if (long_axes <= 1) return s;

  Vec3l normal = cross(p[1] - p[0], p[2] - p[0]);
  for (int projection = 0; projection < 3; ++projection) {
    const int u = kProjectionU[projection], v = kProjectionV[projection];
    // Twice the signed area of the projection. The projection (x,z) is mirrored.
    const std::int64_t area = projection == 1 ? -normal.y : normal[projection];
    if (area != 0) {
      for (int e = 0; e < 3; ++e) {
        const Vec3l &from = p[e], &to = p[(e + 1) % 3];
        set_edge(s, 3 * projection + e, from[u], from[v], to[u], to[v], area < 0);
      }
    } else {
      // The projection is a segment: test both sides of its line.
      for (int e = 0; e < 3; ++e) {
        const Vec3l &from = p[e], &to = p[(e + 1) % 3];
        if (from[u] == to[u] && from[v] == to[v]) continue;
        set_edge(s, 3 * projection, from[u], from[v], to[u], to[v], false);
        set_edge(s, 3 * projection + 1, from[u], from[v], to[u], to[v], true);
        break;
      }
    }
  }

  const std::int64_t divisor =
      std::gcd(std::gcd(absolute(normal.x), absolute(normal.y)), absolute(normal.z));
  if (divisor == 0) return s;
  Vec3l n{normal.x / divisor, normal.y / divisor, normal.z / divisor};
  if (n.x < 0 || (n.x == 0 && (n.y < 0 || (n.y == 0 && n.z < 0)))) n = -n;
  // A voxel meets the plane dot(n, x) = d if d lies between the values at the corners with the
  // least and greatest values. Corners on upper sides are not part of the voxel, so equality does
  // not count there.
  const Int128 d = static_cast<Int128>(n.x) * p[0].x + static_cast<Int128>(n.y) * p[0].y +
                   static_cast<Int128>(n.z) * p[0].z;
  const int far_max = n.x > 0 || n.y > 0 || n.z > 0, far_min = n.x < 0 || n.y < 0 || n.z < 0;
  const std::int64_t above = positive(n.x) + positive(n.y) + positive(n.z);
  const std::int64_t below = negative(n.x) + negative(n.y) + negative(n.z);
  const Int128 slab_lo = ((d + far_max + 255) >> 8) - above;
  const Int128 slab_hi = ((d - far_min) >> 8) - below;
  s.plane = {n, static_cast<std::int64_t>(slab_hi - slab_lo)};
  s.lo = static_cast<std::uint64_t>(slab_lo);
  s.approximate_lo = static_cast<double>(slab_lo);
  s.normal_length1 = static_cast<double>(above - below);
  s.conditions |= kPlane;
  const Vec3l size{absolute(n.x), absolute(n.y), absolute(n.z)};
  const int dominant = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  s.dominant_edges = 7u << (3 * dominant);
  return s;
}

/// Returns the subset of `conditions` that some voxel of the cell of size³ voxels at v may fail.
/// Dominant edges stay until the cell's whole column is inside the triangle; then only the plane
/// can fail.
VOXDAG_HD VOXDAG_FORCE_INLINE std::uint32_t open_conditions(const TriangleSetup& s,
                                                            std::uint32_t conditions, Vec3i v,
                                                            std::int32_t size) {
  using namespace detail;
  for (int edge = 0; edge < 9; ++edge) {
    if (((conditions >> edge) & 1) == 0) continue;
    const std::int64_t a = s.a[edge], b = s.b[edge];
    const std::int64_t least = s.c[edge] + a * v[kProjectionU[edge / 3]] +
                               b * v[kProjectionV[edge / 3]] +
                               (size - 1) * (negative(a) + negative(b));
    const bool dominant = (s.dominant_edges >> edge) & 1;
    if (least >= (dominant ? absolute(a) + absolute(b) : 0)) conditions &= ~(1u << edge);
  }
  if ((conditions & kPlane) && (conditions & s.dominant_edges) == 0) return kPlane;
  return conditions;
}

/// Returns the slab's least value relative to the cell at v. Exact if the plane is near the cell.
VOXDAG_HD VOXDAG_FORCE_INLINE std::int64_t slab_lo_at(const TriangleSetup& s, Vec3i v) {
  const Vec3l& n = s.plane.normal;
  return static_cast<std::int64_t>(
      s.lo - static_cast<std::uint64_t>(n.x) * static_cast<std::uint64_t>(std::int64_t{v.x}) -
      static_cast<std::uint64_t>(n.y) * static_cast<std::uint64_t>(std::int64_t{v.y}) -
      static_cast<std::uint64_t>(n.z) * static_cast<std::uint64_t>(std::int64_t{v.z}));
}

/// Returns whether 64-bit arithmetic is exact in the cell of `size` voxels at v. 0: the plane is
/// far from the cell; 1: slab_lo_at() is exact and sums over the cell do not overflow; 2: the cell
/// is too large.
VOXDAG_HD VOXDAG_FORCE_INLINE int slab_range(const TriangleSetup& s, Vec3i v, std::int32_t size) {
  const double reach = s.normal_length1 * size;
  if (reach > 0x1p60) return 2;
  const Vec3l& n = s.plane.normal;
  const double lo = s.approximate_lo - static_cast<double>(n.x) * v.x -
                    static_cast<double>(n.y) * v.y - static_cast<double>(n.z) * v.z;
  // The rounding error is less than 2^-49 of the largest term, |n|1 * 2^21: much less than |n|1.
  return lo > 2 * reach + 1 || lo < -3 * reach - 1 ? 0 : 1;
}

}  // namespace voxdag

#pragma once
/// A mesh's surface displaced by height textures. It is tessellated on demand, one box at a time:
/// the whole tessellated mesh is never in memory.
///
/// Triangles are split at the midpoints of edges longer than a limit. A point inside a triangle
/// moves along the triangle's interpolated normal, by the height at the point's texture
/// coordinates. Triangles that share an edge or corner may disagree on normal, texture or
/// coordinates. A point there moves by the mean of their displacements. It stays if one of the
/// triangles is not displaced, or if more than 64 displacements meet. So there are no cracks.
#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "voxdag/core/box.hpp"
#include "voxdag/core/parallel/work.hpp"
#include "voxdag/core/vec2.hpp"
#include "voxdag/mesh/displace/displaced_mesh.hpp"
#include "voxdag/mesh/displace/displaced_piece.hpp"
#include "voxdag/mesh/displace/displacement_seams.hpp"

namespace voxdag {

/// A small part of a displaced triangle.
struct MicroTriangle {
  std::array<Vec3d, 3> positions;     ///< World units, in the order of the base triangle's corners.
  std::array<Vec2f, 3> barycentrics;  ///< Before displacement, as in SurfaceShading.
};

/// Refers to mesh and appearance, which must outlive it. Immutable and thread-safe. Results depend
/// on the mesh alone.
class DisplacedTriangles {
 public:
  /// `displacements` has one element for each material. Counts the tables in `work` as long as they
  /// live. Throws Cancelled and OverMemory.
  DisplacedTriangles(const Mesh& mesh, const Appearance& appearance,
                     std::vector<Displacement> displacements, Work work = {});

  /// Returns whether the inside of a triangle moves. If not, tessellate() emits the triangle
  /// unsplit.
  bool is_displaced(std::uint32_t triangle) const { return mesh_.is_displaced(triangle); }

  const Appearance& appearance() const { return mesh_.appearance; }

  /// Returns a box that contains all that tessellate() emits for the triangle, with any region and
  /// limit.
  const Box3d& displaced_bounds(std::uint32_t triangle) const { return bounds_[triangle]; }

  /// Returns a bit mask: bit i is 0 only if tessellate() with regions[i] and this limit would emit
  /// nothing. The test is conservative: pieces smaller than `small` world units are not split, so a
  /// bit may be 1 for a region that is not met.
  std::uint32_t regions_met(std::uint32_t triangle, std::span<const Box3d, 8> regions,
                            double edge_limit, double small) const;

  /// Calls body(const DisplacedPiece&) for pieces of a displaced triangle that together enclose the
  /// micro triangles that tessellate() emits in the region with this limit. Pieces are smaller than
  /// `small` world units where the tessellation allows it.
  template <class Body>
  void for_each_piece(std::uint32_t triangle, const Box3d& region, double edge_limit, double small,
                      Body&& body) const {
    Pass pass(*this, triangle, edge_limit);
    visit_pieces(pass, pass.corners[0], pass.corners[1], pass.corners[2], region, small, body);
  }

  /// Calls emit(const MicroTriangle&) for the micro triangles whose bounds meet `region` (closed).
  /// Before displacement their edges are at most `edge_limit` > 0 world units long, and heights are
  /// filtered to that size. The micro triangles depend on the limit, not on the region.
  template <class Emit>
  void tessellate(std::uint32_t triangle, const Box3d& region, double edge_limit,
                  Emit&& emit) const {
    Pass pass(*this, triangle, edge_limit);
    if (is_displaced(triangle)) {
      split(pass, pass.corners[0], pass.corners[1], pass.corners[2], Search{region, false}, emit);
      return;
    }
    MicroTriangle whole;
    for (std::size_t c = 0; c < 3; ++c) {
      whole.positions[c] = pass.corners[c].position;
      whole.barycentrics[c] = Vec2f{pass.corners[c].b1, pass.corners[c].b2};
    }
    if (meets(bounds_of(whole), region)) emit(whole);
  }

  /// Returns the micro triangle at a place of a displaced triangle, as tessellate() emits it with
  /// this limit. `place` has two barycentric coordinates: the weights of corners 1 and 2.
  MicroTriangle micro_at(std::uint32_t triangle, Vec2f place, double edge_limit) const;

 private:
  /// The constants of splitting one triangle.
  struct Pass {
    Pass(const DisplacedTriangles& triangles, std::uint32_t base, double edge_limit);

    std::uint32_t triangle;
    double limit;  ///< Longest edge, world units.
    float level;   ///< Mip level of the heights inside the triangle.
    /// Heights depend only on texels at most this far away, in texture coordinates. Heights on
    /// seams are the exception.
    Vec2f blur{};
    std::array<PieceCorner, 3> corners;
  };

  /// The region in which micro triangles are wanted.
  struct Search {
    const Box3d& region;
    bool is_inside;  ///< The current piece lies in the region.
  };

  const Vec3d& displace(const Pass& pass, PieceCorner& corner) const;
  bool is_seam(std::uint32_t triangle, std::uint8_t edges) const;
  DisplacedPiece enclose(const Pass& pass, const PieceCorner& a, const PieceCorner& b,
                         const PieceCorner& c) const;
  Interval heights_of(const Pass& pass, const DisplacedPiece& piece,
                      const std::array<const PieceCorner*, 3>& corners) const;
  Box3d find_bounds(std::uint32_t triangle) const;
  /// Returns which of the regions in the mask `set` a piece may meet.
  std::uint32_t piece_meets(const Pass& pass, PieceCorner& a, PieceCorner& b, PieceCorner& c,
                            std::span<const Box3d, 8> regions, std::uint32_t set,
                            double small) const;

  static Box3d bounds_of(const MicroTriangle& micro) {
    Box3d box = Box3d::empty();
    for (const Vec3d& p : micro.positions) box.extend(p);
    return box;
  }
  static bool meets(const Box3d& a, const Box3d& b) {
    return a.lo.x <= b.hi.x && a.lo.y <= b.hi.y && a.lo.z <= b.hi.z && b.lo.x <= a.hi.x &&
           b.lo.y <= a.hi.y && b.lo.z <= a.hi.z;
  }

  /// Returns whether a piece that is not small may meet the region. Sets search.is_inside.
  bool may_meet(const Pass& pass, const PieceCorner& a, const PieceCorner& b, const PieceCorner& c,
                Search& search) const {
    Box3d box = Box3d::empty();
    for (const PieceCorner* corner : {&a, &b, &c}) box.extend(corner->position);
    const Vec3d size = box.hi - box.lo;
    const double longest = std::max({size.x, size.y, size.z});
    // A tight box saves time only for pieces of medium size. Large pieces are wider than the
    // heights; small ones are split into their few micro triangles just as fast.
    if (longest < radius_ && longest > 4 * pass.limit) {
      box = enclose(pass, a, b, c).box();
    } else {
      const Vec3d reach{radius_, radius_, radius_};
      box = {box.lo - reach, box.hi + reach};
    }
    search.is_inside =
        box.lo == max(box.lo, search.region.lo) && box.hi == min(box.hi, search.region.hi);
    return meets(box, search.region);
  }

  template <class Emit>
  void split(const Pass& pass, PieceCorner& a, PieceCorner& b, PieceCorner& c, Search search,
             Emit&& emit) const {
    if (is_small(a, b, c, pass.limit)) {
      const MicroTriangle micro{{displace(pass, a), displace(pass, b), displace(pass, c)},
                                {Vec2f{a.b1, a.b2}, Vec2f{b.b1, b.b2}, Vec2f{c.b1, c.b2}}};
      if (search.is_inside || meets(bounds_of(micro), search.region)) emit(micro);
      return;
    }
    if (!search.is_inside && !may_meet(pass, a, b, c, search)) return;
    for_each_part(a, b, c, pass.limit, [&](PieceCorner& p, PieceCorner& q, PieceCorner& r) {
      split(pass, p, q, r, search, emit);
    });
  }

  template <class Body>
  void visit_pieces(const Pass& pass, PieceCorner& a, PieceCorner& b, PieceCorner& c,
                    const Box3d& region, double small, Body&& body) const {
    const DisplacedPiece piece = enclose(pass, a, b, c);
    const Box3d box = piece.box();
    if (!meets(box, region)) return;
    const Vec3d size = box.hi - box.lo;
    if (std::max({size.x, size.y, size.z}) < small || is_small(a, b, c, pass.limit)) {
      body(piece);
      return;
    }
    for_each_part(a, b, c, pass.limit, [&](PieceCorner& p, PieceCorner& q, PieceCorner& r) {
      visit_pieces(pass, p, q, r, region, small, body);
    });
  }

  const DisplacedMesh mesh_;
  DisplacementSeams seams_;      ///< Empty if nothing moves.
  double radius_ = 0;            ///< No point moves farther than this, in world units.
  CountedVector<Box3d> bounds_;  ///< displaced_bounds() of each triangle.
};

}  // namespace voxdag

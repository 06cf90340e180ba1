#pragma once
/// A mesh's surface displaced by height textures, tessellated on demand, a box at a time: the
/// tessellated mesh never exists as a whole.
///
/// Triangles are split at the midpoints of edges longer than a limit, which both neighbours of an
/// edge decide alike. Inside a triangle a point moves along the triangle's own (interpolated)
/// normal by the height at its own texture coordinates. On an edge or corner whose triangles
/// disagree on any of that, it moves by the mean of what they say; where one of them is not
/// displaced at all, it stays. So there are no cracks.
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "voxdag/core/box.hpp"
#include "voxdag/core/vec2.hpp"
#include "voxdag/displace/displaced_piece.hpp"
#include "voxdag/displace/displacement.hpp"
#include "voxdag/mesh/appearance.hpp"
#include "voxdag/mesh/mesh.hpp"

namespace voxdag {

/// A small part of a displaced triangle.
struct MicroTriangle {
  std::array<Vec3d, 3> positions;     ///< World units, in the order of the base triangle's corners.
  std::array<Vec2f, 3> barycentrics;  ///< Of the undisplaced corners, as in SurfaceShading.
};

/// Refers to mesh and appearance, which must outlive it. Immutable and thread-safe. Results depend
/// on the mesh alone.
class DisplacedTriangles {
 public:
  /// One displacement for each material.
  DisplacedTriangles(const Mesh& mesh, const Appearance& appearance,
                     std::vector<Displacement> displacements);

  /// Whether the inside of a triangle moves. If not, tessellate() emits it whole.
  bool is_displaced(std::uint32_t triangle) const { return displacement(triangle).moves(); }

  /// Holds all that tessellate() emits for the triangle, whatever the region and limit.
  const Box3d& displaced_bounds(std::uint32_t triangle) const { return bounds_[triangle]; }

  /// Bit i is 0 only if tessellate() with regions[i] and this limit would emit nothing. It may be 1
  /// all the same: pieces smaller than `small` world units are not looked into.
  std::uint32_t regions_met(std::uint32_t triangle, std::span<const Box3d, 8> regions,
                            double edge_limit, double small) const;

  /// Calls body(const DisplacedPiece&) for pieces of a displaced triangle that together enclose
  /// what tessellate() with the limit emits in the region; they are smaller than `small` world
  /// units where tessellation allows it.
  template <class Body>
  void for_each_piece(std::uint32_t triangle, const Box3d& region, double edge_limit, double small,
                      Body&& body) const {
    Pass pass(*this, triangle, edge_limit);
    visit_pieces(pass, pass.corners[0], pass.corners[1], pass.corners[2], region, small, body);
  }

  /// Calls emit(const MicroTriangle&) for those micro triangles whose bounds meet `region`
  /// (closed). Their edges were `edge_limit` world units at most before displacement, which must be
  /// positive; a limit gives the same micro triangles for all regions. Heights are filtered to the
  /// limit.
  template <class Emit>
  void tessellate(std::uint32_t triangle, const Box3d& region, double edge_limit,
                  Emit&& emit) const {
    Pass pass(*this, triangle, edge_limit);
    if (!is_displaced(triangle)) {
      MicroTriangle whole;
      for (std::size_t c = 0; c < 3; ++c) {
        whole.positions[c] = pass.corners[c].position;
        whole.barycentrics[c] = Vec2f{pass.corners[c].b1, pass.corners[c].b2};
      }
      if (meets(bounds_of(whole), region)) emit(whole);
      return;
    }
    split(pass, pass.corners[0], pass.corners[1], pass.corners[2], Search{region, false}, emit);
  }

  /// The micro triangle that has the place with these barycentric coordinates (of corners 1 and 2)
  /// of a displaced triangle, one of those that tessellate() emits with the limit.
  MicroTriangle micro_at(std::uint32_t triangle, Vec2f place, double edge_limit) const;

 private:
  /// A corner of a piece. The barycentric coordinates are exact: halves of halves.
  struct Vertex {
    Vec3d position;  ///< Before displacement.
    Vec3f normal;    ///< Interpolated, not normalised.
    float b1 = 0, b2 = 0;
    std::uint8_t edges =
        0;  ///< The base triangle's edges that it lies on, as bits; two at corners.
    bool is_displaced = false;
    Vec3d displaced;  ///< Known once is_displaced.
  };

  /// What is constant while one triangle is split.
  struct Pass {
    Pass(const DisplacedTriangles& triangles, std::uint32_t base, double edge_limit);

    std::uint32_t triangle;
    double limit;
    float level;  ///< Of the heights inside the triangle.
    /// No height but on seams depends on texels farther away than this, in texture coordinates.
    Vec2f blur{};
    std::array<Vertex, 3> corners;
  };

  /// Where to look for micro triangles, and whether the piece at hand lies in there.
  struct Search {
    const Box3d& region;
    bool is_inside;
  };

  /// A corner of the mesh, 3 * triangle + corner, or the edge that starts there.
  using CornerIndex = std::uint32_t;
  static constexpr CornerIndex next_corner(CornerIndex corner) {
    return corner % 3 == 2 ? corner - 2 : corner + 1;
  }

  /// Corners at one place, or edges between the same places: those that differ in what moves them.
  struct Group {
    std::uint32_t first = 0, count = 0;  ///< Of `members_`.
    bool is_pinned = false;              ///< A triangle that is not displaced is among them.
  };

  const Displacement& displacement(std::uint32_t triangle) const {
    return displacements_[Appearance::material_index(mesh_, triangle)];
  }
  std::array<Vec3f, 3> normals(std::uint32_t triangle) const;
  Vec2f uv(CornerIndex corner) const {
    return appearance_.uvs.empty() ? Vec2f{} : appearance_.uvs[corner];
  }
  const Vec3f& position(CornerIndex corner) const {
    return mesh_.vertices[mesh_.triangles[corner / 3][corner % 3]];
  }

  void group();
  void group_corners(std::size_t place_count);
  void group_edges();
  /// Makes a group of what `agree` tells apart.
  template <class Agree>
  void add_group(std::span<const CornerIndex> all, const Agree& agree) {
    Group group{static_cast<std::uint32_t>(members_.size()), 0, false};
    for (const CornerIndex corner : all) {
      group.is_pinned |= !is_displaced(corner / 3);
      bool is_known = false;
      for (std::uint32_t i = 0; i < group.count && !is_known; ++i)
        is_known = agree(members_[group.first + i], corner);
      if (is_known) continue;
      members_.push_back(corner);
      ++group.count;
    }
    groups_.push_back(group);
  }
  bool corners_agree(CornerIndex a, CornerIndex b) const;
  bool edges_agree(CornerIndex a, CornerIndex b) const;

  /// Texels of the heights per world unit.
  double density(std::uint32_t triangle) const;
  double edge_density(CornerIndex edge) const;
  static float level_of(double density, double edge_limit);

  float height(const Displacement& displacement, Vec3d position, Vec3f unit_normal, Vec2f uv,
               float level) const;
  /// Where one triangle moves a point by itself.
  Vec3d offset(std::uint32_t triangle, Vec3d position, Vec3f normal, Vec2f uv, float level) const;
  Vec3d corner_offset(const Group& group, Vec3d position, double limit) const;
  Vec3d edge_offset(const Group& group, Vec3d position, float along, double limit) const;
  const Vec3d& displace(const Pass& pass, Vertex& vertex) const;

  bool is_seam(std::uint32_t triangle, std::uint8_t edges) const;
  DisplacedPiece enclose(const Pass& pass, const Vertex& a, const Vertex& b, const Vertex& c) const;

  static Vertex between(const Vertex& a, const Vertex& b) {
    return {(a.position + b.position) * 0.5,
            (a.normal + b.normal) * 0.5f,
            (a.b1 + b.b1) * 0.5f,
            (a.b2 + b.b2) * 0.5f,
            static_cast<std::uint8_t>(a.edges & b.edges),
            false,
            {}};
  }
  static double distance2(const Vertex& a, const Vertex& b) {
    const Vec3d d = a.position - b.position;
    return dot(d, d);
  }
  /// Whether a piece that is not small may meet the region. Sets whether it lies in there.
  bool may_meet(const Pass& pass, const Vertex& a, const Vertex& b, const Vertex& c,
                Search& search) const {
    Box3d box = Box3d::empty();
    for (const Vertex* v : {&a, &b, &c}) box.extend(v->position);
    const Vec3d size = box.hi - box.lo;
    const double longest = std::max({size.x, size.y, size.z});
    // Heights say little more of a piece that is larger than they are high, and to look at the few
    // triangles of a little one takes no longer than to enclose it.
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
  static Box3d bounds_of(const MicroTriangle& micro) {
    Box3d box = Box3d::empty();
    for (const Vec3d& p : micro.positions) box.extend(p);
    return box;
  }
  static bool meets(const Box3d& a, const Box3d& b) {
    return a.lo.x <= b.hi.x && a.lo.y <= b.hi.y && a.lo.z <= b.hi.z && b.lo.x <= a.hi.x &&
           b.lo.y <= a.hi.y && b.lo.z <= a.hi.z;
  }

  template <class Emit>
  void split(const Pass& pass, Vertex& a, Vertex& b, Vertex& c, Search search, Emit&& emit) const {
    if (is_small(pass, a, b, c)) {
      const MicroTriangle micro{{displace(pass, a), displace(pass, b), displace(pass, c)},
                                {Vec2f{a.b1, a.b2}, Vec2f{b.b1, b.b2}, Vec2f{c.b1, c.b2}}};
      if (search.is_inside || meets(bounds_of(micro), search.region)) emit(micro);
      return;
    }
    if (!search.is_inside && !may_meet(pass, a, b, c, search)) return;
    for_each_part(pass, a, b, c,
                  [&](Vertex& p, Vertex& q, Vertex& r) { split(pass, p, q, r, search, emit); });
  }

  template <class Body>
  void visit_pieces(const Pass& pass, Vertex& a, Vertex& b, Vertex& c, const Box3d& region,
                    double small, Body&& body) const {
    const DisplacedPiece piece = enclose(pass, a, b, c);
    const Box3d box = piece.box();
    if (!meets(box, region)) return;
    const Vec3d size = box.hi - box.lo;
    if (std::max({size.x, size.y, size.z}) < small || is_small(pass, a, b, c)) {
      body(piece);
      return;
    }
    for_each_part(pass, a, b, c, [&](Vertex& p, Vertex& q, Vertex& r) {
      visit_pieces(pass, p, q, r, region, small, body);
    });
  }

  static bool is_small(const Pass& pass, const Vertex& a, const Vertex& b, const Vertex& c) {
    const double limit2 = pass.limit * pass.limit;
    return distance2(a, b) <= limit2 && distance2(b, c) <= limit2 && distance2(c, a) <= limit2;
  }

  /// Calls body(a, b, c) for the two to four parts of a piece that is not small.
  template <class Body>
  static void for_each_part(const Pass& pass, Vertex& a, Vertex& b, Vertex& c, const Body& body) {
    const double limit2 = pass.limit * pass.limit;
    const bool ab = distance2(a, b) > limit2, bc = distance2(b, c) > limit2,
               ca = distance2(c, a) > limit2;
    const int count = ab + bc + ca;
    // Turned so that what is (one edge) or is not (two) split lies between the first two corners.
    if (count == 3) {
      Vertex d = between(a, b), e = between(b, c), f = between(c, a);
      body(a, d, f);
      body(d, b, e);
      body(f, e, c);
      body(d, e, f);
    } else if (count == 2) {
      if (!ab)
        split_two(a, b, c, body);
      else if (!bc)
        split_two(b, c, a, body);
      else
        split_two(c, a, b, body);
    } else {
      if (ab)
        split_one(a, b, c, body);
      else if (bc)
        split_one(b, c, a, body);
      else
        split_one(c, a, b, body);
    }
  }

  template <class Body>
  static void split_one(Vertex& a, Vertex& b, Vertex& c, const Body& body) {
    Vertex d = between(a, b);
    body(a, d, c);
    body(d, b, c);
  }

  template <class Body>
  static void split_two(Vertex& a, Vertex& b, Vertex& c, const Body& body) {
    Vertex e = between(b, c), f = between(c, a);
    body(f, e, c);
    if (distance2(a, e) <= distance2(b, f)) {
      body(a, b, e);
      body(a, e, f);
    } else {
      body(a, b, f);
      body(b, e, f);
    }
  }

  Box3d find_bounds(std::uint32_t triangle) const;
  /// Of the regions in a set.
  std::uint32_t piece_meets(const Pass& pass, Vertex& a, Vertex& b, Vertex& c,
                            std::span<const Box3d, 8> regions, std::uint32_t set,
                            double small) const;

  const Mesh& mesh_;
  const Appearance& appearance_;
  const std::vector<Displacement> displacements_;
  double radius_ = 0;                                       ///< No point moves further.
  std::vector<std::uint32_t> corner_groups_, edge_groups_;  ///< By CornerIndex.
  std::vector<std::uint32_t> places_;  ///< By CornerIndex: equal for equal positions.
  std::vector<Group> groups_;
  std::vector<CornerIndex> members_;
  std::vector<Box3d> bounds_;  ///< By triangle: displaced_bounds().
};

}  // namespace voxdag

#include "voxdag/mesh/displace/displaced_triangles.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "voxdag/core/parallel/polled_for.hpp"
#include "voxdag/mesh/displace/displaced_point.hpp"

namespace voxdag {
namespace {

/// Returns the corner at which two edges of a triangle meet; `edges` is the bit mask of the edges.
std::uint32_t corner_on(std::uint8_t edges) { return edges == 0b101 ? 0 : edges == 0b011 ? 1 : 2; }

/// The least and greatest of the added heights, 0 to 65535.
class HeightRange {
 public:
  /// Adds the heights in a box of texture coordinates.
  void add(const HeightTexture& heights, Vec2f lo, Vec2f hi) {
    const HeightTexture::Bounds bounds = heights.bounds(lo, hi);
    least_ = std::min(least_, bounds.lo[0]);
    most_ = std::max(most_, bounds.hi[0]);
  }
  /// Returns the range of offsets along a normal that these heights cause, in world units.
  Interval along(const Displacement& d) const {
    const double p = d.base + d.gain * least_ / 65535, q = d.base + d.gain * most_ / 65535;
    return {std::min(p, q), std::max(p, q)};
  }

 private:
  std::uint16_t least_ = 65535, most_ = 0;
};

}  // namespace

DisplacedTriangles::DisplacedTriangles(const Mesh& mesh, const Appearance& appearance,
                                       std::vector<Displacement> displacements, Work work)
    : mesh_{mesh, appearance, std::move(displacements)}, bounds_(work.memory) {
  for (const Displacement& d : mesh_.displacements)
    if (d.moves()) radius_ = std::max({radius_, std::abs(d.base), std::abs(d.base + d.gain)});
  if (radius_ > 0) seams_ = DisplacementSeams(mesh_, work);
  bounds_.resize(mesh.triangles.size());
  polled_for(bounds_.size(), 256, work, "displaced bounds",
             [&](std::size_t i) { bounds_[i] = find_bounds(static_cast<std::uint32_t>(i)); });
}

const Vec3d& DisplacedTriangles::displace(const Pass& pass, PieceCorner& v) const {
  if (v.is_displaced) return v.displaced;
  v.is_displaced = true;
  const CornerIndex first = 3 * pass.triangle;
  if (v.edges == 0) {
    const Vec2f uv = mesh_.uv(first) + (mesh_.uv(first + 1) - mesh_.uv(first)) * v.b1 +
                     (mesh_.uv(first + 2) - mesh_.uv(first)) * v.b2;
    v.displaced =
        v.position + triangle_offset(mesh_, pass.triangle, v.position, v.normal, uv, pass.level);
  } else if (std::has_single_bit(v.edges)) {
    const std::array<float, 3> b{1 - v.b1 - v.b2, v.b1, v.b2};
    const CornerIndex edge = first + static_cast<unsigned>(std::countr_zero(v.edges));
    const float along = b[seams_.ends(edge).last - first];
    v.displaced = v.position + edge_offset(mesh_, seams_, seams_.edge_group(edge), v.position,
                                           along, pass.limit);
  } else {
    v.displaced = v.position + corner_offset(mesh_, seams_.corner_group(first + corner_on(v.edges)),
                                             v.position, pass.limit);
  }
  return v.displaced;
}

DisplacedTriangles::Pass::Pass(const DisplacedTriangles& all, std::uint32_t base, double edge_limit)
    : triangle(base), limit(edge_limit) {
  const DisplacedMesh& mesh = all.mesh_;
  double densest = texel_density(mesh, base);
  level = height_level(densest, edge_limit);
  const std::array<Vec3f, 3> n = mesh.normals(base);
  constexpr std::uint8_t edges[3] = {0b101, 0b011, 0b110};
  for (std::uint32_t c = 0; c < 3; ++c) {
    const CornerIndex corner = 3 * base + c;
    corners[c].position = mesh.mesh.to_world(mesh.position(corner));
    corners[c].normal = n[c];
    corners[c].b1 = c == 1 ? 1.0f : 0.0f;
    corners[c].b2 = c == 2 ? 1.0f : 0.0f;
    corners[c].edges = edges[c];
    if (!all.is_displaced(base)) continue;
    // A corner that is not on a seam moves like the first member of its group.
    densest = std::max({densest, edge_texel_density(mesh, all.seams_.edge_group(corner).members[0]),
                        texel_density(mesh, all.seams_.corner_group(corner).members[0] / 3)});
  }
  if (!all.is_displaced(base)) return;
  const HeightTexture& heights = *mesh.displacement(base).heights;
  const float blurriest = height_level(densest, edge_limit);
  const float texel = blurriest > 0 ? 1.5f * std::exp2(std::floor(blurriest) + 1) : 0;
  blur = {texel / static_cast<float>(heights.width()),
          texel / static_cast<float>(heights.height())};
}

bool DisplacedTriangles::is_seam(std::uint32_t t, std::uint8_t edges) const {
  if (edges == 0) return false;
  for (std::uint32_t k = 0; k < 3; ++k)
    if ((edges >> k & 1) != 0 && seams_.edge_group(3 * t + k).is_seam()) return true;
  if (std::has_single_bit(edges)) return false;
  return seams_.corner_group(3 * t + corner_on(edges)).is_seam();
}

DisplacedPiece DisplacedTriangles::enclose(const Pass& pass, const PieceCorner& a,
                                           const PieceCorner& b, const PieceCorner& c) const {
  const std::array<const PieceCorner*, 3> corners{&a, &b, &c};
  DisplacedPiece piece;
  for (std::size_t i = 0; i < 3; ++i) {
    const PieceCorner& v = *corners[i];
    piece.corners[i] = v.position;
    piece.normals[i] =
        i > 0 && v.normal == a.normal ? piece.normals[0] : normalized_or(v.normal, {});
    if (is_seam(pass.triangle, v.edges)) piece.reach[i] = radius_;
  }
  const std::array<Vec3f, 3>& n = piece.normals;
  const Vec3f middle = normalized_or(n[0] + n[1] + n[2], {});
  const float shortest = std::min({dot(n[0], middle), dot(n[1], middle), dot(n[2], middle)});
  if (!(shortest > 0.3f)) {
    // If normals differ this much, interpolated normals may have any direction.
    piece.slack = radius_;
    return piece;
  }
  piece.shortest = shortest;
  piece.heights = heights_of(pass, piece, corners);
  // Allows for normals that differ slightly but count as equal.
  piece.slack = 2e-3 * radius_;
  return piece;
}

/// Returns the range of offsets along the normal for a piece's points, except for those on seams.
Interval DisplacedTriangles::heights_of(const Pass& pass, const DisplacedPiece& piece,
                                        const std::array<const PieceCorner*, 3>& corners) const {
  const Displacement& d = mesh_.displacement(pass.triangle);
  HeightRange range;
  if (d.box_size > 0) {
    Box3d flat = Box3d::empty();
    for (const Vec3d& corner : piece.corners) flat.extend(corner);
    for (int axis = 0; axis < 3; ++axis) {
      const std::array<Vec3f, 3>& n = piece.normals;
      const float most =
          std::max({std::abs(n[0][axis]), std::abs(n[1][axis]), std::abs(n[2][axis])});
      if (most / piece.shortest < 0.4f) continue;  // see projection_weights()
      const Vec2f lo = projected_uv(flat.lo, axis, d.box_size);
      const Vec3d extent = (flat.hi - flat.lo) * (1 / d.box_size);
      const Vec2f size{static_cast<float>(axis == 0 ? extent.z : extent.x),
                       static_cast<float>(axis == 1 ? extent.z : extent.y)};
      // The texture runs down along y.
      const Vec2f start = axis == 1 ? lo : Vec2f{lo.x, lo.y - size.y};
      range.add(*d.heights, start - pass.blur, start + size + pass.blur);
    }
  } else {
    const CornerIndex first = 3 * pass.triangle;
    Vec2f lo{}, hi{};
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec2f p =
          d.uv(mesh_.uv(first) + (mesh_.uv(first + 1) - mesh_.uv(first)) * corners[i]->b1 +
               (mesh_.uv(first + 2) - mesh_.uv(first)) * corners[i]->b2);
      lo = i == 0 ? p : Vec2f{std::min(lo.x, p.x), std::min(lo.y, p.y)};
      hi = i == 0 ? p : Vec2f{std::max(hi.x, p.x), std::max(hi.y, p.y)};
    }
    range.add(*d.heights, lo - pass.blur, hi + pass.blur);
  }
  return range.along(d);
}

Box3d DisplacedTriangles::find_bounds(std::uint32_t t) const {
  const Pass pass(*this, t, std::numeric_limits<double>::infinity());
  if (is_displaced(t))
    return enclose(pass, pass.corners[0], pass.corners[1], pass.corners[2]).box();
  Box3d box = Box3d::empty();
  for (const PieceCorner& corner : pass.corners) box.extend(corner.position);
  return box;
}

std::uint32_t DisplacedTriangles::regions_met(std::uint32_t t, std::span<const Box3d, 8> regions,
                                              double edge_limit, double small) const {
  std::uint32_t met = 0;
  for (std::size_t i = 0; i < 8; ++i)
    if (meets(bounds_[t], regions[i])) met |= 1u << i;
  const Vec3d size = bounds_[t].hi - bounds_[t].lo;
  if (met == 0 || !is_displaced(t) || std::max({size.x, size.y, size.z}) < small) return met;
  Pass pass(*this, t, edge_limit);
  return piece_meets(pass, pass.corners[0], pass.corners[1], pass.corners[2], regions, met, small);
}

std::uint32_t DisplacedTriangles::piece_meets(const Pass& pass, PieceCorner& a, PieceCorner& b,
                                              PieceCorner& c, std::span<const Box3d, 8> regions,
                                              std::uint32_t set, double small) const {
  const Box3d box = enclose(pass, a, b, c).box();
  std::uint32_t met = 0, surely = 0;
  for (std::uint32_t left = set; left != 0; left &= left - 1) {
    const Box3d& region = regions[std::countr_zero(left)];
    if (!meets(box, region)) continue;
    met |= left & -left;
    if (min(box.lo, region.lo) == region.lo && max(box.hi, region.hi) == region.hi)
      surely |= left & -left;
  }
  const Vec3d size = box.hi - box.lo;
  if (met == surely || std::max({size.x, size.y, size.z}) < small || is_small(a, b, c, pass.limit))
    return met;
  for_each_part(a, b, c, pass.limit, [&](PieceCorner& p, PieceCorner& q, PieceCorner& r) {
    if ((met & ~surely) != 0) surely |= piece_meets(pass, p, q, r, regions, met & ~surely, small);
  });
  return surely;
}

MicroTriangle DisplacedTriangles::micro_at(std::uint32_t triangle, Vec2f place,
                                           double edge_limit) const {
  Pass pass(*this, triangle, edge_limit);
  std::array<PieceCorner, 3> piece = pass.corners;
  // Returns the depth of the place inside a piece; negative outside.
  const auto depth_in = [&](const PieceCorner& a, const PieceCorner& b, const PieceCorner& c) {
    const auto side = [&](const PieceCorner& p, const PieceCorner& q) {
      const Vec2d from{static_cast<double>(p.b1), static_cast<double>(p.b2)};
      const Vec2d along = Vec2d{static_cast<double>(q.b1), static_cast<double>(q.b2)} - from;
      const Vec2d to = Vec2d{static_cast<double>(place.x), static_cast<double>(place.y)} - from;
      return cross(along, to);
    };
    return std::min({side(a, b), side(b, c), side(c, a)});
  };
  while (!is_small(piece[0], piece[1], piece[2], pass.limit)) {
    double deepest = -HUGE_VAL;
    std::array<PieceCorner, 3> part = piece;
    for_each_part(piece[0], piece[1], piece[2], pass.limit,
                  [&](PieceCorner& a, PieceCorner& b, PieceCorner& c) {
                    const double depth = depth_in(a, b, c);
                    if (!(depth > deepest)) return;
                    deepest = depth;
                    part = {a, b, c};
                  });
    piece = part;
  }
  MicroTriangle micro;
  for (std::size_t i = 0; i < 3; ++i) {
    micro.positions[i] = displace(pass, piece[i]);
    micro.barycentrics[i] = {piece[i].b1, piece[i].b2};
  }
  return micro;
}

}  // namespace voxdag

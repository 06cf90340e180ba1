#include "voxdag/displace/displaced_triangles.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "voxdag/parallel/parallel_for.hpp"
#include "voxdag/surface/tangent_frames.hpp"

namespace voxdag {
namespace {

Vec3f unit_or_zero(Vec3f v) {
  const float length2 = dot(v, v);
  return length2 > 0 ? v * (1 / std::sqrt(length2)) : Vec3f{};
}

/// How much a texture that is projected along each axis counts for a normal.
Vec3f projection_weights(Vec3f n) {
  const auto weight = [](float x) {
    const float w = std::max(std::abs(x) - 0.4f, 0.0f);
    return w * w;
  };
  const Vec3f w{weight(n.x), weight(n.y), weight(n.z)};
  return w * (1 / (w.x + w.y + w.z));  // One component is 0.57 at least.
}

/// A position seen along an axis, in units of `size`.
Vec2f projected(Vec3d p, int axis, double size) {
  const double u = (axis == 0 ? p.z : p.x) / size, v = (axis == 1 ? p.z : -p.y) / size;
  return {static_cast<float>(u - std::floor(u)), static_cast<float>(v - std::floor(v))};
}

}  // namespace

DisplacedTriangles::DisplacedTriangles(const Mesh& mesh, const Appearance& appearance,
                                       std::vector<Displacement> displacements)
    : mesh_(mesh), appearance_(appearance), displacements_(std::move(displacements)) {
  for (const Displacement& d : displacements_)
    if (d.moves()) radius_ = std::max({radius_, std::abs(d.base), std::abs(d.base + d.gain)});
  if (radius_ > 0) group();
  bounds_.resize(mesh.triangles.size());
  parallel_for(bounds_.size(), 256,
               [&](std::size_t i) { bounds_[i] = find_bounds(static_cast<std::uint32_t>(i)); });
}

std::array<Vec3f, 3> DisplacedTriangles::normals(std::uint32_t t) const {
  if (!appearance_.normals.empty()) {
    const Vec3f* const n = appearance_.normals.data() + 3 * std::size_t{t};
    if (n[0] != Vec3f{} && n[1] != Vec3f{} && n[2] != Vec3f{}) return {n[0], n[1], n[2]};
  }
  const Vec3f n = face_normal(mesh_, t);
  return {n, n, n};
}

double DisplacedTriangles::density(std::uint32_t t) const {
  const Displacement& d = displacement(t);
  if (!d.moves()) return 0;
  const double w = d.heights->width(), h = d.heights->height();
  if (d.box_size > 0) return std::max(w, h) / d.box_size;
  const CornerIndex c = 3 * t;
  const Vec2f p = d.uv.linear(uv(c + 1) - uv(c)), q = d.uv.linear(uv(c + 2) - uv(c));
  const double texels = std::abs(double{p.x} * q.y - double{p.y} * q.x) * w * h;
  const Vec3d a(position(c));
  const Vec3d area = cross(Vec3d(position(c + 1)) - a, Vec3d(position(c + 2)) - a);
  const double world = std::sqrt(dot(area, area));
  return world > 0 ? std::sqrt(texels / world) : 0;
}

double DisplacedTriangles::edge_density(CornerIndex edge) const {
  const Displacement& d = displacement(edge / 3);
  if (!d.moves()) return 0;
  const double w = d.heights->width(), h = d.heights->height();
  if (d.box_size > 0) return std::max(w, h) / d.box_size;
  const Vec2f along = d.uv.linear(uv(next_corner(edge)) - uv(edge));
  const Vec3d length = Vec3d(position(next_corner(edge))) - Vec3d(position(edge));
  const double texels = std::hypot(along.x * w, along.y * h);
  const double world = std::sqrt(dot(length, length));
  return world > 0 ? texels / world : 0;
}

float DisplacedTriangles::level_of(double density, double edge_limit) {
  // Edges end up between half the limit and the limit.
  return static_cast<float>(std::log2(density * edge_limit * 0.7));
}

float DisplacedTriangles::height(const Displacement& d, Vec3d position, Vec3f unit_normal, Vec2f uv,
                                 float level) const {
  if (!(d.box_size > 0)) return d.heights->sample_between(level, d.uv(uv))[0] * (1.0f / 65535);
  const Vec3f weights = projection_weights(unit_normal);
  float sum = 0;
  for (int axis = 0; axis < 3; ++axis)
    if (weights[axis] > 0)
      sum += weights[axis] *
             d.heights->sample_between(level, projected(position, axis, d.box_size))[0];
  return sum * (1.0f / 65535);
}

Vec3d DisplacedTriangles::offset(std::uint32_t t, Vec3d position, Vec3f normal, Vec2f uv,
                                 float level) const {
  const Displacement& d = displacement(t);
  const Vec3f n = unit_or_zero(normal);
  if (n == Vec3f{}) return {};
  return Vec3d(n) * (d.base + d.gain * static_cast<double>(height(d, position, n, uv, level)));
}

Vec3d DisplacedTriangles::corner_offset(const Group& group, Vec3d position, double limit) const {
  if (group.is_pinned) return {};
  Vec3d sum;
  for (std::uint32_t i = 0; i < group.count; ++i) {
    const CornerIndex c = members_[group.first + i];
    sum = sum +
          offset(c / 3, position, normals(c / 3)[c % 3], uv(c), level_of(density(c / 3), limit));
  }
  return sum * (1.0 / group.count);
}

Vec3d DisplacedTriangles::edge_offset(const Group& group, Vec3d position, float along,
                                      double limit) const {
  if (group.is_pinned) return {};
  double texels = 0;
  for (std::uint32_t i = 0; i < group.count; ++i)
    texels = std::max(texels, edge_density(members_[group.first + i]));
  const float level = level_of(texels, limit);
  Vec3d sum;
  for (std::uint32_t i = 0; i < group.count; ++i) {
    CornerIndex a = members_[group.first + i], b = next_corner(a);
    if (places_[b] < places_[a]) std::swap(a, b);
    const std::array<Vec3f, 3> n = normals(a / 3);
    sum = sum + offset(a / 3, position, n[a % 3] + (n[b % 3] - n[a % 3]) * along,
                       uv(a) + (uv(b) - uv(a)) * along, level);
  }
  return sum * (1.0 / group.count);
}

const Vec3d& DisplacedTriangles::displace(const Pass& pass, Vertex& v) const {
  if (v.is_displaced) return v.displaced;
  v.is_displaced = true;
  const CornerIndex first = 3 * pass.triangle;
  const std::array<float, 3> b{1 - v.b1 - v.b2, v.b1, v.b2};
  if (v.edges == 0) {
    const Vec2f at =
        uv(first) + (uv(first + 1) - uv(first)) * v.b1 + (uv(first + 2) - uv(first)) * v.b2;
    v.displaced = v.position + offset(pass.triangle, v.position, v.normal, at, pass.level);
  } else if (std::has_single_bit(v.edges)) {
    // What both neighbours know: how far from the end with the lesser place the point is.
    const CornerIndex edge = first + static_cast<unsigned>(std::countr_zero(v.edges));
    const CornerIndex end = next_corner(edge);
    const float along = b[(places_[end] < places_[edge] ? edge : end) - first];
    v.displaced =
        v.position + edge_offset(groups_[edge_groups_[edge]], v.position, along, pass.limit);
  } else {
    const auto corner = static_cast<std::uint32_t>(v.edges == 0b101 ? 0 : v.edges == 0b011 ? 1 : 2);
    v.displaced =
        v.position + corner_offset(groups_[corner_groups_[first + corner]], v.position, pass.limit);
  }
  return v.displaced;
}

DisplacedTriangles::Pass::Pass(const DisplacedTriangles& all, std::uint32_t base, double edge_limit)
    : triangle(base), limit(edge_limit) {
  double densest = all.density(base);
  level = level_of(densest, edge_limit);
  const std::array<Vec3f, 3> n = all.normals(base);
  constexpr std::uint8_t edges[3] = {0b101, 0b011, 0b110};
  for (std::uint32_t c = 0; c < 3; ++c) {
    corners[c].position = Vec3d(all.position(3 * base + c));
    corners[c].normal = n[c];
    corners[c].b1 = c == 1 ? 1.0f : 0.0f;
    corners[c].b2 = c == 2 ? 1.0f : 0.0f;
    corners[c].edges = edges[c];
    if (!all.is_displaced(base)) continue;
    const Group& edge = all.groups_[all.edge_groups_[3 * base + c]];
    const Group& corner = all.groups_[all.corner_groups_[3 * base + c]];
    densest = std::max({densest, all.edge_density(all.members_[edge.first]),
                        all.density(all.members_[corner.first] / 3)});
  }
  if (!all.is_displaced(base)) return;
  const HeightTexture& heights = *all.displacement(base).heights;
  const float blurriest = level_of(densest, edge_limit);
  const float texel = blurriest > 0 ? 1.5f * std::exp2(std::floor(blurriest) + 1) : 0;
  blur = {texel / static_cast<float>(heights.width()),
          texel / static_cast<float>(heights.height())};
}

bool DisplacedTriangles::is_seam(std::uint32_t t, std::uint8_t edges) const {
  if (edges == 0) return false;
  const auto differs = [](const Group& group) { return group.count > 1 || group.is_pinned; };
  for (std::uint32_t k = 0; k < 3; ++k)
    if ((edges >> k & 1) != 0 && differs(groups_[edge_groups_[3 * t + k]])) return true;
  if (std::has_single_bit(edges)) return false;
  const auto corner = static_cast<std::uint32_t>(edges == 0b101 ? 0 : edges == 0b011 ? 1 : 2);
  return differs(groups_[corner_groups_[3 * t + corner]]);
}

DisplacedPiece DisplacedTriangles::enclose(const Pass& pass, const Vertex& a, const Vertex& b,
                                           const Vertex& c) const {
  const Displacement& d = displacement(pass.triangle);
  const std::array<const Vertex*, 3> corners{&a, &b, &c};
  DisplacedPiece piece;
  Box3d flat = Box3d::empty();
  for (std::size_t i = 0; i < 3; ++i) {
    const Vertex& v = *corners[i];
    flat.extend(v.position);
    piece.corners[i] = v.position;
    piece.normals[i] = i > 0 && v.normal == a.normal ? piece.normals[0] : unit_or_zero(v.normal);
    if (is_seam(pass.triangle, v.edges)) piece.reach[i] = radius_;
  }
  const std::array<Vec3f, 3>& n = piece.normals;
  const Vec3f middle = unit_or_zero(n[0] + n[1] + n[2]);
  const float shortest = std::min({dot(n[0], middle), dot(n[1], middle), dot(n[2], middle)});
  if (!(shortest > 0.3f)) {
    piece.slack = radius_;
    return piece;
  }

  HeightTexture::Bounds range{{65535}, {0}};
  const auto include = [&](Vec2f lo, Vec2f hi) {
    const HeightTexture::Bounds bounds = d.heights->bounds(lo - pass.blur, hi + pass.blur);
    range.lo[0] = std::min(range.lo[0], bounds.lo[0]);
    range.hi[0] = std::max(range.hi[0], bounds.hi[0]);
  };
  if (d.box_size > 0) {
    for (int axis = 0; axis < 3; ++axis) {
      const float most =
          std::max({std::abs(n[0][axis]), std::abs(n[1][axis]), std::abs(n[2][axis])});
      if (most / shortest < 0.4f) continue;
      const Vec2f lo = projected(flat.lo, axis, d.box_size);
      const Vec3d extent = (flat.hi - flat.lo) * (1 / d.box_size);
      const Vec2f size{static_cast<float>(axis == 0 ? extent.z : extent.x),
                       static_cast<float>(axis == 1 ? extent.z : extent.y)};
      // Along y the texture runs down.
      const Vec2f start = axis == 1 ? lo : Vec2f{lo.x, lo.y - size.y};
      include(start, start + size);
    }
  } else {
    const CornerIndex first = 3 * pass.triangle;
    Vec2f lo{}, hi{};
    for (const Vertex* v : corners) {
      const Vec2f p = d.uv(uv(first) + (uv(first + 1) - uv(first)) * v->b1 +
                           (uv(first + 2) - uv(first)) * v->b2);
      lo = v == &a ? p : Vec2f{std::min(lo.x, p.x), std::min(lo.y, p.y)};
      hi = v == &a ? p : Vec2f{std::max(hi.x, p.x), std::max(hi.y, p.y)};
    }
    include(lo, hi);
  }
  const double p = d.base + d.gain * range.lo[0] / 65535, q = d.base + d.gain * range.hi[0] / 65535;
  piece.heights = {std::min(p, q), std::max(p, q)};
  piece.shortest = shortest;
  // Normals that are nearly equal count as equal.
  piece.slack = 2e-3 * radius_;
  return piece;
}

Box3d DisplacedTriangles::find_bounds(std::uint32_t t) const {
  const Pass pass(*this, t, std::numeric_limits<double>::infinity());
  if (is_displaced(t))
    return enclose(pass, pass.corners[0], pass.corners[1], pass.corners[2]).box();
  Box3d box = Box3d::empty();
  for (const Vertex& corner : pass.corners) box.extend(corner.position);
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

std::uint32_t DisplacedTriangles::piece_meets(const Pass& pass, Vertex& a, Vertex& b, Vertex& c,
                                              std::span<const Box3d, 8> regions, std::uint32_t set,
                                              double small) const {
  const Box3d box = enclose(pass, a, b, c).box();
  std::uint32_t met = 0, surely = 0;
  for (std::uint32_t left = set; left != 0; left &= left - 1) {
    const Box3d& region = regions[static_cast<std::size_t>(std::countr_zero(left))];
    if (!meets(box, region)) continue;
    met |= left & -left;
    if (min(box.lo, region.lo) == region.lo && max(box.hi, region.hi) == region.hi)
      surely |= left & -left;
  }
  const Vec3d size = box.hi - box.lo;
  if (met == surely || std::max({size.x, size.y, size.z}) < small || is_small(pass, a, b, c))
    return met;
  for_each_part(pass, a, b, c, [&](Vertex& p, Vertex& q, Vertex& r) {
    if ((met & ~surely) != 0) surely |= piece_meets(pass, p, q, r, regions, met & ~surely, small);
  });
  return surely;
}

MicroTriangle DisplacedTriangles::micro_at(std::uint32_t triangle, Vec2f place,
                                           double edge_limit) const {
  Pass pass(*this, triangle, edge_limit);
  std::array<Vertex, 3> piece = pass.corners;
  // How far inside of a piece the place lies: negative outside.
  const auto depth_in = [&](const Vertex& a, const Vertex& b, const Vertex& c) {
    const auto side = [&](const Vertex& p, const Vertex& q) {
      const Vec2d from{static_cast<double>(p.b1), static_cast<double>(p.b2)};
      const Vec2d along = Vec2d{static_cast<double>(q.b1), static_cast<double>(q.b2)} - from;
      const Vec2d to = Vec2d{static_cast<double>(place.x), static_cast<double>(place.y)} - from;
      return cross(along, to);
    };
    return std::min({side(a, b), side(b, c), side(c, a)});
  };
  while (!is_small(pass, piece[0], piece[1], piece[2])) {
    double deepest = -HUGE_VAL;
    std::array<Vertex, 3> part = piece;
    for_each_part(pass, piece[0], piece[1], piece[2], [&](Vertex& a, Vertex& b, Vertex& c) {
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
